#include "contender.hpp"

#include <cmath>
#include <memory>
#include <stdexcept>

#include "ours.hpp"
#include "peers.hpp"

namespace bench {

using namespace arm3r;

namespace {

const std::string our_build = "arm3r " ARM3R_VERSION ", " BENCH_BUILD;

peers::Body body_of(const Link<double>& link) {
    return {link.length, link.mass, link.com, {link.inertia[0], link.inertia[1], link.inertia[2]}};
}

[[maybe_unused]] peers::Numbers numbers_of(const Arm<double>& arm) {
    return {arm.base_height, arm.link1.inertia_axial, body_of(arm.link2), body_of(arm.link3),
            {arm.gravity[0], arm.gravity[1], arm.gravity[2]}};
}

// `answer(query, qdd)` for one state after another.
template <class Answer> Work over_queries(Answer answer) {
    return [answer, at = std::size_t(0), qdd = Joints{}](int times) mutable {
        for (int i = 0; i < times; ++i) answer(queries()[at++ % state_count], qdd);
    };
}

template <class Mover> Work over_steps(std::shared_ptr<Mover> mover, std::function<void(Mover&)> start) {
    return [mover, start, taken = 0](int times) mutable {
        for (int i = 0; i < times; ++i) {
            if (taken++ % steps_per_run == 0) start(*mover);
            mover->step();
        }
    };
}

template <std::size_t Size> Contender our_steps(std::string job, Setup (*setup)()) {
    return {std::move(job), "arm3r", our_build, [setup] {
                return over_steps<Stepper<Size>>(std::make_shared<Stepper<Size>>(setup()), &Stepper<Size>::start);
            }};
}

#ifdef BENCH_PINOCCHIO
Contender pinocchio() {
    return {"forward dynamics", "Pinocchio aba", peers::Pinocchio::build(), [] {
                auto arm = std::make_shared<peers::Pinocchio>(numbers_of(free_fall().plant.arm));
                return over_queries([arm](const Query& query, Joints& qdd) {
                    arm->forward_dynamics(query.q.data(), query.qd.data(), query.tau.data(), qdd.data());
                });
            }};
}
#else
Contender pinocchio() { return {"forward dynamics", "Pinocchio aba", "not found when this was built", {}}; }
#endif

#ifdef BENCH_MUJOCO
void start(peers::Mujoco& arm) {
    static const Setup setup = free_fall();
    arm.start(setup.q.data(), setup.qd.data());
}

Contender mujoco(std::string job) {
    return {std::move(job), "MuJoCo mj_step, free fall", peers::Mujoco::build(), [] {
                auto arm = std::make_shared<peers::Mujoco>(numbers_of(free_fall().plant.arm), step);
                return over_steps<peers::Mujoco>(arm, start);
            }};
}
#else
Contender mujoco(std::string job) { return {std::move(job), "MuJoCo mj_step", "not found when this was built", {}}; }
#endif

[[maybe_unused]] void compare(const std::string& what, const double* ours, const double* theirs) {
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(ours[i] - theirs[i]) <= 1e-9 * (1 + std::abs(ours[i]))))
            throw std::runtime_error(what + ": ours " + std::to_string(ours[i]) + ", theirs " + std::to_string(theirs[i]));
}

template <class Peer> [[maybe_unused]] void compare_accelerations(const std::string& who, Peer& peer) {
    const Arm<double> arm = free_fall().plant.arm;
    for (const Query& query : queries()) {
        Joints ours, theirs;
        forward_dynamics(arm, query, ours);
        peer.forward_dynamics(query.q.data(), query.qd.data(), query.tau.data(), theirs.data());
        compare("acceleration by " + who, ours.data(), theirs.data());
    }
}

}  // namespace

std::vector<Contender> contenders() {
    const std::string falls = "RK4 step, free fall", pushed = "RK4 step, compensation and two-way wall";
    return {
        {"forward dynamics", "arm3r", our_build,
         [] {
             return over_queries([arm = free_fall().plant.arm](const Query& query, Joints& qdd) { forward_dynamics(arm, query, qdd); });
         }},
        pinocchio(),
        our_steps<motion_size>(falls, free_fall),
        mujoco(falls),
        our_steps<state_size>(falls + ", with the books", free_fall),
        mujoco(falls + ", with the books"),
        our_steps<motion_size>(pushed, compensated_at_wall),
        mujoco(pushed),
        our_steps<state_size>(pushed + ", with the books", compensated_at_wall),
        mujoco(pushed + ", with the books"),
    };
}

void check_agreement() {
#ifdef BENCH_PINOCCHIO
    peers::Pinocchio pinocchio(numbers_of(free_fall().plant.arm));
    compare_accelerations("Pinocchio", pinocchio);
#endif
#ifdef BENCH_MUJOCO
    peers::Mujoco mujoco(numbers_of(free_fall().plant.arm), step);
    compare_accelerations("MuJoCo", mujoco);

    peers::Mujoco falling(numbers_of(free_fall().plant.arm), step);
    Stepper<motion_size> ours(free_fall());
    start(falling);
    for (int i = 0; i < steps_per_run; ++i) {
        ours.step();
        falling.step();
        compare("angles by MuJoCo", ours.state().data(), falling.q());
        compare("rates by MuJoCo", ours.state().data() + 3, falling.qd());
    }
#endif
}

}  // namespace bench

#include "contender.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "arm3r/numbers/widths.hpp"
#include "ours.hpp"
#include "peers.hpp"

namespace bench {

using namespace arm3r;

namespace {

const std::string our_build = "arm3r " ARM3R_VERSION ", " BENCH_BUILD;

peers::Body body_of(const Link<double>& link) {
    return {link.length, link.mass, {link.com, 0, 0}, {link.inertia[0], link.inertia[1], link.inertia[2]}, {0, 0, 0}};
}

peers::Body body_of(double length, const RigidBody<double>& body) {
    const Vec3<double>&c = body.com, &d = body.inertia, &o = body.products;
    return {length, body.mass, {c[0], c[1], c[2]}, {d[0], d[1], d[2]}, {o[0], o[1], o[2]}};
}

[[maybe_unused]] peers::Numbers numbers_of(const Arm<double>& arm) {
    const Vec3<double>& g = arm.gravity;
    if (!arm.is_elbow)
        return {arm.base_height,   0, 0, arm.link1.inertia_axial, body_of(arm.link2), body_of(arm.link3),
                {g[0], g[1], g[2]}};
    const RigidBody<double>& column = arm.elbow.links[0];
    return {arm.base_height,
            arm.elbow.shoulder_offset,
            arm.elbow.offset,
            column.inertia[2] + column.mass * (column.com[0] * column.com[0] + column.com[1] * column.com[1]),
            body_of(arm.link2.length, arm.elbow.links[1]),
            body_of(arm.link3.length, arm.elbow.links[2]),
            {g[0], g[1], g[2]}};
}

// `answer(query, qdd)` for one state after another.
template <class Answer>
Work over_queries(Answer answer) {
    return [answer, at = std::size_t(0), qdd = Joints{}](int times) mutable {
        for (int i = 0; i < times; ++i) answer(queries()[at++ % state_count], qdd);
    };
}

template <class Mover>
Work over_steps(std::shared_ptr<Mover> mover, std::function<void(Mover&)> start) {
    return [mover, start](int times) {
        for (int taken = 0; taken < times; taken += steps_per_run) {
            start(*mover);
            mover->advance(std::min(steps_per_run, times - taken));
        }
    };
}

template <std::size_t Size>
Contender our_steps(std::string job, std::vector<double> (*params)()) {
    return {std::move(job), "arm3r", our_build, [params] {
                return over_steps<Stepper<Size>>(std::make_shared<Stepper<Size>>(params()), &Stepper<Size>::start);
            }};
}

template <std::size_t Size>
Contender our_packs(std::string job, std::vector<double> (*params)()) {
    const int lanes = arm3r::max_lanes();
    if (lanes == 1) return {std::move(job), "arm3r in packs", "ARM3R_LANES=all has packs for this processor", {}};
    return {std::move(job), "arm3r in packs of " + std::to_string(lanes) + ", per arm", our_build, [params] {
                return over_steps<PackStepper<Size>>(std::make_shared<PackStepper<Size>>(params()),
                                                     &PackStepper<Size>::start);
            }};
}

Contender our_runs(std::string job, std::vector<double> (*params)()) {
    return {std::move(job), "arm3r simulate()", our_build,
            [params] { return [run = std::make_shared<WholeRun>(params())](int times) { run->advance(times); }; }};
}

Arm<double> arm() { return make_arm(free_fall()); }

Contender our_accelerations(std::string job, std::vector<double> (*params)()) {
    return {std::move(job), "arm3r", our_build, [params] {
                return over_queries(
                    [arm = make_arm(params())](const Query& query, Joints& qdd) { forward_dynamics(arm, query, qdd); });
            }};
}

#ifdef BENCH_PINOCCHIO
Contender pinocchio(std::string job, std::vector<double> (*params)()) {
    return {std::move(job), "Pinocchio aba", peers::Pinocchio::build(), [params] {
                auto peer = std::make_shared<peers::Pinocchio>(numbers_of(make_arm(params())));
                return over_queries([peer](const Query& query, Joints& qdd) {
                    peer->forward_dynamics(query.q.data(), query.qd.data(), query.tau.data(), qdd.data());
                });
            }};
}
#else
Contender pinocchio(std::string job, std::vector<double> (*)()) {
    return {std::move(job), "Pinocchio aba", "not found when this was built", {}};
}
#endif

template <class Peer>
[[maybe_unused]] void start(Peer& peer) {
    static const Setup setup = make_setup(free_fall());
    peer.start(setup.q.data(), setup.qd.data());
}

#ifdef BENCH_CASADI
Contender casadi() {
    return {"forward dynamics", "CasADi, generated C", peers::Casadi::build(), [] {
                auto peer = std::make_shared<peers::Casadi>(step, false);
                return over_queries([peer](const Query& query, Joints& qdd) {
                    peer->forward_dynamics(query.q.data(), query.qd.data(), query.tau.data(), qdd.data());
                });
            }};
}

Contender casadi(std::string job, bool pushed) {
    return {std::move(job), "CasADi, generated C", peers::Casadi::build(), [pushed] {
                return over_steps<peers::Casadi>(std::make_shared<peers::Casadi>(step, pushed), start<peers::Casadi>);
            }};
}
#else
Contender casadi(std::string job = "forward dynamics", bool = {}) {
    return {std::move(job), "CasADi, generated C", "not found when this was built", {}};
}
#endif

#ifdef BENCH_MUJOCO
Contender mujoco(std::string job) {
    return {std::move(job), "MuJoCo mj_step, free fall", peers::Mujoco::build(), [] {
                return over_steps<peers::Mujoco>(std::make_shared<peers::Mujoco>(numbers_of(arm()), step),
                                                 start<peers::Mujoco>);
            }};
}
#else
Contender mujoco(std::string job) { return {std::move(job), "MuJoCo mj_step", "not found when this was built", {}}; }
#endif

[[maybe_unused]] void compare(const std::string& what, const double* ours, const double* theirs) {
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(ours[i] - theirs[i]) <= 1e-9 * (1 + std::abs(ours[i]))))
            throw std::runtime_error(what + ": ours " + std::to_string(ours[i]) + ", theirs " +
                                     std::to_string(theirs[i]));
}

template <class Peer>
[[maybe_unused]] void compare_accelerations(const std::string& who, Peer& peer, const Arm<double>& ours_arm = arm()) {
    for (const Query& query : queries()) {
        Joints ours, theirs;
        forward_dynamics(ours_arm, query, ours);
        peer.forward_dynamics(query.q.data(), query.qd.data(), query.tau.data(), theirs.data());
        compare("acceleration by " + who, ours.data(), theirs.data());
    }
}

template <class Peer>
[[maybe_unused]] void compare_steps(const std::string& who, Peer& peer, const std::vector<double>& params) {
    Stepper<motion_size> ours(params);
    start(peer);
    for (int i = 0; i < steps_per_run; ++i) {
        ours.advance(1);
        peer.advance(1);
        compare("angles by " + who, ours.state().data(), peer.q());
        compare("rates by " + who, ours.state().data() + 3, peer.qd());
    }
}

}  // namespace

std::vector<Contender> contenders() {
    const std::string zero_crossing = "RK4 step, free fall", pushed = "RK4 step, compensation and two-way wall";
    const std::string quadratures = ", with the energy balance";
    return {
        our_accelerations("forward dynamics", free_fall),
        casadi(),
        pinocchio("forward dynamics", free_fall),
        our_accelerations("forward dynamics, UR5", elbow_free_fall),
        pinocchio("forward dynamics, UR5", elbow_free_fall),
        our_steps<motion_size>(zero_crossing, free_fall),
        our_packs<motion_size>(zero_crossing, free_fall),
        casadi(zero_crossing, false),
        mujoco(zero_crossing),
        our_steps<state_size>(zero_crossing + quadratures, free_fall),
        our_packs<state_size>(zero_crossing + quadratures, free_fall),
        our_runs(zero_crossing + quadratures, free_fall),
        our_steps<motion_size>(pushed, compensated_at_wall),
        our_packs<motion_size>(pushed, compensated_at_wall),
        casadi(pushed, true),
        mujoco(pushed),
        our_steps<state_size>(pushed + quadratures, compensated_at_wall),
        our_packs<state_size>(pushed + quadratures, compensated_at_wall),
        our_runs(pushed + quadratures, compensated_at_wall),
        our_steps<motion_size>(zero_crossing + ", UR5", elbow_free_fall),
        our_packs<motion_size>(zero_crossing + ", UR5", elbow_free_fall),
        our_steps<state_size>(pushed + quadratures + ", UR5", elbow_compensated_at_wall),
        our_packs<state_size>(pushed + quadratures + ", UR5", elbow_compensated_at_wall),
    };
}

void check_agreement() {
#ifdef BENCH_CASADI
    peers::Casadi falling_by_casadi(step, false), pushed_by_casadi(step, true);
    compare_accelerations("CasADi", falling_by_casadi);
    compare_steps("CasADi", falling_by_casadi, free_fall());
    compare_steps("CasADi", pushed_by_casadi, compensated_at_wall());
#endif
#ifdef BENCH_PINOCCHIO
    peers::Pinocchio pinocchio(numbers_of(arm())), of_ur5(numbers_of(make_arm(elbow_free_fall())));
    compare_accelerations("Pinocchio", pinocchio);
    compare_accelerations("Pinocchio", of_ur5, make_arm(elbow_free_fall()));
#endif
#ifdef BENCH_MUJOCO
    peers::Mujoco accelerating(numbers_of(arm()), step), falling(numbers_of(arm()), step);
    compare_accelerations("MuJoCo", accelerating);
    compare_steps("MuJoCo", falling, free_fall());
#endif
}

}  // namespace bench

#include "ours.hpp"

#include <random>

#include "arm3r/lanes.hpp"
#include "arm3r/numbers/eigen_traits.hpp"
#include "arm3r/numbers/widths.hpp"
#include "batch/simulation.hpp"
#include "record/run_data.hpp"
#include "schema/schema.hpp"
#include "validate/validate.hpp"

namespace bench {

using namespace arm3r;

namespace {

std::vector<double> params_of(std::initializer_list<std::pair<const char*, double>> changes) {
    std::vector<double> params = param_defaults();
    for (const auto& [path, value] : changes) params[param_index(path)] = value;
    return params;
}

}  // namespace

const std::vector<Query>& queries() {
    static const std::vector<Query> made = [] {
        std::mt19937_64 random(1);
        std::uniform_real_distribution<double> angle(-3, 3), rate(-1, 1);
        const auto joints = [&](auto& distribution) {
            return Joints{distribution(random), distribution(random), distribution(random)};
        };
        std::vector<Query> all(state_count);
        for (Query& query : all) query = {joints(angle), joints(rate), joints(rate)};
        return all;
    }();
    return made;
}

std::vector<double> free_fall() { return params_of({}); }

std::vector<double> compensated_at_wall() {
    return params_of({{"wall", 1},
                      {"wall.point[0]", 1.735},  // 3 mm from the tip
                      {"wall.acts_on_arm", 1},
                      {"controller.type", double(ControllerType::gravity_compensation)}});
}

namespace {

std::vector<double> ur5(std::vector<double> params) {
    const auto set = [&](const std::string& key, std::initializer_list<double> values) {
        std::copy(values.begin(), values.end(), params.begin() + std::ptrdiff_t(known_key(key).offset));
    };
    set("arm.model", {1});
    set("arm.base.position", {0, 0, 0.089159});
    set("arm.link1.mass", {3.7}), set("arm.link1.com", {0, 0.00193, -0.02561});
    set("arm.link1.inertia", {0.014972358333333331, 0.014972358333333331, 0.01040625, 0, 0, 0});
    set("arm.link2.length", {0.425}), set("arm.link2.mass", {8.393}), set("arm.link2.com", {0.2125, 0, 0.11336});
    set("arm.link2.inertia", {0.0151074, 0.13388583541666665, 0.13388583541666665, 0, 0, 0});
    set("arm.link3.tip", {0.5165074991734051, 0, 0.10914999998058698}), set("arm.link3.mass", {4.9559});
    set("arm.link3.com", {0.3471961002238645, 0.005587822915859083, 0.06984963073764358});
    set("arm.link3.inertia", {0.018818002485488067, 0.09578477746963364, 0.08981638329460005, -0.007146286548695125,
                              -0.020121250570010275, -0.0028651337948400898});
    return params;
}

}  // namespace

std::vector<double> elbow_free_fall() { return ur5(free_fall()); }
std::vector<double> elbow_compensated_at_wall() {
    std::vector<double> params = ur5(compensated_at_wall());
    params[param_index("wall.point[0]")] = 0.82;  // 3 mm from the tip, about
    return params;
}

[[gnu::noinline]] void forward_dynamics(const Arm<double>& arm, const Query& query, Joints& qdd) {
    const Vec3<double> q(query.q[0], query.q[1], query.q[2]), qd(query.qd[0], query.qd[1], query.qd[2]);
    const Vec3<double> tau(query.tau[0], query.tau[1], query.tau[2]);
    const Vec3<double> a = joint_acceleration(arm, pose(q), qd, tau);
    qdd = {a[0], a[1], a[2]};
}

template <std::size_t Size>
Stepper<Size>::Stepper(const std::vector<double>& params) : setup_(make_setup(params)), rhs_(setup_.plant) {
    if (setup_.plant.acts_on_arm) rhs_.force_mode = ContactForceMode::each_stage;
    start();
}

template <std::size_t Size>
void Stepper<Size>::start() {
    y_ = {};
    for (int i = 0; i < 3; ++i) y_[i] = setup_.q[i];
    t_ = 0;
    rhs_.begin_step(y_);
    rhs_(t_, y_, f_);
}

// Steps of the kind that a run takes; f is the derivative at (t, y), with rhs.begin_step(y) done.
template <Terms terms, class T, std::size_t Size>
ARM3R_INLINE void march_by_terms(RightHandSide<T, T>& rhs, T& t, State<T, Size>& y, State<T, Size>& f, int steps) {
    constexpr std::size_t moving = terms == Terms::common ? std::min<std::size_t>(Size, common_moving) : Size;
    const auto derive = [&rhs](const T& at, const State<T, Size>& state, State<T, Size>& rates) ARM3R_INLINE_LAMBDA {
        Vec3<T> tau;
        rhs.template derivative_at<terms>(at, state, rates, tau);
    };
    for (int i = 0; i < steps; ++i) {
        y = rk4_step_of_first<moving>(derive, t, y, f, T(step));
        t += T(step);
        rhs.begin_step(y);
        derive(t, y, f);
    }
}

template <class T, std::size_t Size>
ARM3R_INLINE void march(const Plant<T>& plant, RightHandSide<T, T>& rhs, T& t, State<T, Size>& y, State<T, Size>& f,
                        int steps) {
    if (has_common_terms(plant)) march_by_terms<Terms::common>(rhs, t, y, f, steps);
    else march_by_terms<Terms::any>(rhs, t, y, f, steps);
}

template <std::size_t Size>
void Stepper<Size>::advance(int steps) {
    march(setup_.plant, rhs_, t_, y_, f_, steps);
}

template class Stepper<motion_size>;
template class Stepper<state_size>;

template <int N, std::size_t Size>
ARM3R_INLINE void march_packs(const Plant<Pack<N>>& plant, State<Pack<N>, Size>& y, int steps) {
    RightHandSide<Pack<N>, Pack<N>> rhs(plant);
    if (plant.acts_on_arm) rhs.force_mode = ContactForceMode::each_stage;
    State<Pack<N>, Size> f{};
    Pack<N> t(0.0);
    rhs.begin_step(y);
    rhs(t, y, f);
    march(plant, rhs, t, y, f, steps);
}

template <std::size_t Size>
void march_by(const Plant<Pack<2>>& plant, State<Pack<2>, Size>& y, int steps) {
    march_packs(plant, y, steps);
}
#if ARM3R_WIDE_PACKS
template <std::size_t Size>
ARM3R_FOR_FOUR void march_by(const Plant<Pack<4>>& plant, State<Pack<4>, Size>& y, int steps) {
    march_packs(plant, y, steps);
}
template <std::size_t Size>
ARM3R_FOR_EIGHT void march_by(const Plant<Pack<8>>& plant, State<Pack<8>, Size>& y, int steps) {
    march_packs(plant, y, steps);
}
#endif

template <std::size_t Size>
PackStepper<Size>::PackStepper(const std::vector<double>& params) : setup_(make_setup(params)) {
    const auto fill = [&](auto& plant) {
        copy_choices(setup_.plant, plant);
        each_number([](auto& all, const double& one) { all = one; }, plant, setup_.plant);
    };
    std::apply([&](auto&... plants) { (fill(plants), ...); }, plants_);
}

template <std::size_t Size>
template <int N>
void PackStepper<Size>::march(int steps) {
    State<Pack<N>, Size> y{};
    for (int i = 0; i < 3; ++i)
        for (int lane = 0; lane < N; ++lane) y[i].set(lane, setup_.q[i] + 0.01 * lane);
    march_by(std::get<Plant<Pack<N>>>(plants_), y, steps);
    sum_ += y[1][0] + y[2][N - 1];
}

template <std::size_t Size>
void PackStepper<Size>::advance(int steps) {
    const int lanes = max_lanes(), before = taken_ / lanes;
    taken_ += steps;
    const int each = taken_ / lanes - before;
#define MARCH(T) \
    if (Lanes<T>::count == lanes) return march<Lanes<T>::count>(each);
    ARM3R_LANE_PACKS(MARCH)
    throw std::runtime_error("this build has no packs that this processor has registers for: take ARM3R_LANES=all");
}

template class PackStepper<motion_size>;
template class PackStepper<state_size>;

void WholeRun::advance(int steps) {
    if (steps != steps_) prepare(steps);
    simulate(*setup_, {});
}

void WholeRun::prepare(int steps) {
    std::vector<double> run = params_;
    run[param_index("solver.method")] = double(SolverMethod::rk4);
    run[param_index("solver.step")] = step;
    run[param_index("time.stop")] = run[param_index("time.log_every")] = steps * step;
    setup_ = valid_setup(run);
    steps_ = steps;
}

}  // namespace bench

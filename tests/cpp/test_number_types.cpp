
#include "arm3r/plant.hpp"
#include "check.hpp"
#include "fixtures.hpp"

namespace arm3r {

// Every number type drops into the same formulas: Dual with right slopes, Pack and Expr with the bits of double.
TEST_SUITE(number_types)

using Numbers = std::vector<double>;

template <class T>
static Vec3<T> three(const T* x) {
    return {x[0], x[1], x[2]};
}
template <class T>
static void put(std::vector<T>& out, const Vec3<T>& v) {
    out.insert(out.end(), {v[0], v[1], v[2]});
}
template <class T>
static void put(std::vector<T>& out, const Mat3<T>& m) {
    out.insert(out.end(), m.data(), m.data() + 9);
}
template <class T, std::size_t N>
static void put(std::vector<T>& out, const State<T, N>& y) {
    out.insert(out.end(), y.begin(), y.end());
}

// The closed form at the state x = (q, qd, tau, f).
constexpr int state_numbers = 12;

template <class P, class T>
static std::vector<T> closed_form(const Arm<P>& arm, const T* x) {
    const Vec3<T> q = three(x), qd = three(x + 3), tau = three(x + 6), f = three(x + 9);
    const Pose<T> p = pose(q);
    std::vector<T> out;
    put(out, tip_position(arm, p));
    put(out, jacobian(arm, p));
    put(out, jacobian_dot(arm, p, qd));
    put(out, mass_matrix(arm, p));
    put(out, coriolis_matrix(arm, p, qd));
    put(out, gravity_torque(arm, p));
    put(out, joint_acceleration(arm, p, qd, tau));
    put(out, forward_dynamics(arm, p, qd, tau, f));
    put(out, inverse_dynamics(arm, p, qd, tau, f));
    put(out, tip_mobility(arm, p));
    put(out, operational_space_inertia(arm, p));
    put(out, inverse_kinematics(arm, tip_position(arm, p), true, false).q);
    out.push_back(kinetic_energy(arm, p, qd));
    out.push_back(potential_energy(arm, p));
    return out;
}

template <class P, class T>
static std::vector<T> by_recursion(const Arm<P>& arm, const T* x) {
    const Vec3<T> q = three(x), qd = three(x + 3), tau = three(x + 6), f = three(x + 9);
    std::vector<T> out;
    put(out, tip_sensor(arm, q, qd).position);
    put(out, tip_sensor(arm, q, qd).velocity);
    put(out, recursion_inverse_dynamics(arm, q, qd, tau, f));
    put(out, recursion_forward_dynamics(arm, q, qd, tau, f));
    return out;
}

// A right-hand side as a function of its own, so that the stages of a step do not each hold a copy of it.
template <class T, class F>
struct Outlined {
    const F& f;

    template <std::size_t N>
    [[gnu::noinline]] void operator()(const T& t, const State<T, N>& y, State<T, N>& dy) const {
        f(t, y, dy);
    }
};

// One step of each method, with the quadratures, from t = x[6], on a plant where each stage decides about contact.
template <class T>
static std::vector<T> stepped(const Plant<double>& plant, const T* x) {
    RightHandSide<double, T> f(plant);
    f.force_mode = ContactForceMode::each_stage;
    const State<T, state_size> y{x[0], x[1], x[2], x[3], x[4], x[5], T(0.0), T(0.0), T(0.0)};
    const T t = x[6], h(0.01);
    State<T, state_size> f0;
    f.begin_step(y);
    const Outlined<T, RightHandSide<double, T>> outlined{f};
    outlined(t, y, f0);
    Dopri5<T, state_size, motion_size> dopri5;
    dopri5.step(outlined, t, y, f0, h);
    std::vector<T> out;
    put(out, f0);
    put(out, rk4_step(outlined, t, y, f0, h));
    put(out, dopri5.y1);
    put(out, dopri5.interpolant(t, y, h)(T(0.3)));
    out.push_back(dopri5.error(y, h, 1e-9, 1e-12));
    out.push_back(step_factor(out.back()));
    return out;
}

static Numbers random_state(Random& random) {
    Numbers x;
    for (const auto& [part, size] : {std::pair(4.0, 3), {5.0, 3}, {20.0, 3}, {30.0, 3}})
        for (int i = 0; i < size; ++i) x.push_back(random.in(-part, part));
    return x;
}

// A wall that about half of all tips are behind.
static Plant<double> plant_with_wall(Random& random) {
    Params params =
        random_params(random).set("wall", 1).set("wall.acts_on_arm", 1).set("wall.point", random.vector(-0.5, 0.5));
    params.set("wall.normal", random.vector(-1, 1)).set("wall.size", {1.5, 1.5}).choose("wall.motion.type", "sinusoid");
    params.set("wall.motion.amplitude", 0.2).set("wall.motion.frequency", 3).set("wall.motion.phase", 0.4);
    params.choose("controller.type", "gravity_compensation")
        .set("controller.model.link3.mass", 0.9)
        .set("arm.torque_limit", {5, 20, 10});
    return make_setup(params).plant;
}

static bool same(const Numbers& a, const Numbers& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_bits);
}

// ---- Pack

template <int N>
static std::vector<Pack<N>> packed(const std::vector<Numbers>& lanes) {
    std::vector<Pack<N>> result(lanes[0].size());
    for (std::size_t i = 0; i < result.size(); ++i)
        for (int lane = 0; lane < N; ++lane) result[i].set(lane, lanes[std::size_t(lane)][i]);
    return result;
}

template <int N>
static Numbers lane_of(const std::vector<Pack<N>>& packs, int lane) {
    Numbers result;
    for (const Pack<N>& pack : packs) result.push_back(pack[lane]);
    return result;
}

// formula(x) of N states at once, and of each alone.
template <int N, class F>
static void check_lanes(Random& random, F formula) {
    std::vector<Numbers> lanes;
    for (int lane = 0; lane < N; ++lane) lanes.push_back(random_state(random));
    const std::vector<Pack<N>> together = formula(packed<N>(lanes).data());
    for (int lane = 0; lane < N; ++lane) CHECK(same(lane_of(together, lane), formula(lanes[std::size_t(lane)].data())));
}

template <class F>
static void check_all_widths(Random& random, F formula) {
    check_lanes<2>(random, formula);
    check_lanes<4>(random, formula);
    check_lanes<8>(random, formula);
}

TEST_CASE(each_lane_of_the_dynamics_equals_the_double) {
    Random random(41);
    for (int i = 0; i < 300; ++i) {
        const Arm<double> arm = random_params(random).arm();
        check_all_widths(random, [&]<class T>(const T* x) { return closed_form(arm, x); });
        check_all_widths(random, [&]<class T>(const T* x) { return by_recursion(arm, x); });
    }
}

TEST_CASE(each_lane_of_a_step_with_contact_equals_the_double) {
    Random random(42);
    int touching = 0;
    for (int i = 0; i < 300; ++i) {
        const Plant<double> plant = plant_with_wall(random);
        check_all_widths(random, [&]<class T>(const T* x) { return stepped(plant, x); });
        touching += stepped(plant, random_state(random).data())[7] != 0;
    }
    CHECK(touching > 30);
    CHECK(touching < 270);
}

// The arm's own numbers may be packs as well: as many arms as lanes.
template <int N>
static Arm<Pack<N>> packed_arm(const std::vector<Arm<double>>& arms) {
    Arm<Pack<N>> result;
    const auto pack = [&](auto number) {
        Pack<N> all;
        for (int lane = 0; lane < N; ++lane) all.set(lane, number(arms[std::size_t(lane)]));
        return all;
    };
    const auto pack3 = [&](auto vector) -> Vec3<Pack<N>> {
        return {pack([&](const auto& arm) { return vector(arm)[0]; }),
                pack([&](const auto& arm) { return vector(arm)[1]; }),
                pack([&](const auto& arm) { return vector(arm)[2]; })};
    };
    const auto link = [&](auto of) -> Link<Pack<N>> {
        return {pack([&](const auto& arm) { return of(arm).length; }),
                pack([&](const auto& arm) { return of(arm).mass; }), pack([&](const auto& arm) { return of(arm).com; }),
                pack3([&](const auto& arm) { return of(arm).inertia; })};
    };
    result.base_height = pack([](const auto& arm) { return arm.base_height; });
    result.link1 = {pack([](const auto& arm) { return arm.link1.mass; }),
                    pack([](const auto& arm) { return arm.link1.com; }),
                    pack([](const auto& arm) { return arm.link1.inertia_axial; })};
    result.link2 = link([](const auto& arm) { return arm.link2; });
    result.link3 = link([](const auto& arm) { return arm.link3; });
    result.payload = pack([](const auto& arm) { return arm.payload; });
    result.gravity = pack3([](const auto& arm) { return arm.gravity; });
    result.armature = pack3([](const auto& arm) { return arm.armature; });
    result.damping = pack3([](const auto& arm) { return arm.damping; });
    result.friction = pack3([](const auto& arm) { return arm.friction; });
    result.friction_velocity = pack([](const auto& arm) { return arm.friction_velocity; });
    result.lumped = lump_planar(result);
    result.has_damping = result.has_dry_friction = true;
    return result;
}

TEST_CASE(each_lane_may_have_its_own_arm) {
    constexpr int N = 4;
    Random random(43);
    for (int i = 0; i < 300; ++i) {
        std::vector<Arm<double>> arms;
        std::vector<Numbers> lanes;
        for (int lane = 0; lane < N; ++lane) {
            arms.push_back(random_params(random).arm());
            lanes.push_back(random_state(random));
        }
        const Arm<Pack<N>> together = packed_arm<N>(arms);
        const std::vector<Pack<N>> x = packed<N>(lanes), closed = closed_form(together, x.data()),
                                   recursion = by_recursion(together, x.data());
        for (std::size_t lane = 0; lane < N; ++lane) {
            CHECK(same(lane_of(closed, int(lane)), closed_form(arms[lane], lanes[lane].data())));
            CHECK(same(lane_of(recursion, int(lane)), by_recursion(arms[lane], lanes[lane].data())));
        }
    }
}

// ---- Dual

template <class F>
static void check_slopes(const Numbers& x, F formula, double tolerance) {
    using Slopes = Dual<state_numbers>;
    std::vector<Slopes> variables;
    for (int i = 0; i < state_numbers; ++i) variables.push_back(Slopes::variable(x[std::size_t(i)], i));
    const std::vector<Slopes> result = formula(variables.data());
    const Numbers plain = formula(x.data());
    constexpr double h = 1e-5;
    for (std::size_t i = 0; i < state_numbers; ++i) {
        Numbers ahead = x, behind = x;
        ahead[i] += h;
        behind[i] -= h;
        const Numbers high = formula(ahead.data()), low = formula(behind.data());
        for (std::size_t k = 0; k < plain.size(); ++k) {
            const double difference = (high[k] - low[k]) / (2 * h);
            CHECK(same_bits(result[k].number, plain[k]));
            CHECK(std::abs(result[k].slope[i] - difference) <= tolerance * (1 + std::abs(difference)),
                  "result " << k << " by input " << i);
        }
    }
}

TEST_CASE(slopes_of_the_dynamics_are_the_differences) {
    Random random(44);
    for (int i = 0; i < 10; ++i) {
        const Arm<double> arm = random_params(random).arm();
        Numbers x = random_state(random);
        x[2] = random.in(0.5, 2.5);  // away from the singular poses, where differences fail
        check_slopes(x, [&]<class T>(const T* x) { return by_recursion(arm, x); }, 1e-4);
        if (manipulability(arm, pose(three(x.data()))) > 0.1)
            check_slopes(x, [&]<class T>(const T* x) { return closed_form(arm, x); }, 1e-4);
    }
}

// Derivatives by position, velocity and time, which a gradient through a moving wall needs.
TEST_CASE(slopes_of_a_right_hand_side_with_contact_are_the_differences) {
    Random random(45);
    for (int i = 0; i < 30; ++i) {
        const Plant<double> plant = plant_with_wall(random);
        const auto formula = [&]<class T>(const T* x) {
            RightHandSide<double, T> f(plant);
            f.force_mode = ContactForceMode::pressed;
            const State<T, state_size> y{x[0], x[1], x[2], x[3], x[4], x[5], T(0.0), T(0.0), T(0.0)};
            State<T, state_size> dy;
            f.begin_step(y);
            f(x[6], y, dy);
            return std::vector<T>(dy.begin(), dy.end());
        };
        check_slopes(random_state(random), formula, 1e-4);
    }
}

// Slopes by a parameter of the arm.
TEST_CASE(slopes_by_a_mass_are_the_differences) {
    Random random(46);
    using Slope = Dual<1>;
    for (int i = 0; i < 30; ++i) {
        const Arm<double> arm = random_params(random).arm();
        const Numbers x = random_state(random);
        const auto acceleration = [&]<class P>(const P& mass) {
            Arm<P> heavier{};
            heavier.link1.inertia_axial = P(arm.link1.inertia_axial);
            heavier.link2 = {arm.link2.length, arm.link2.mass, arm.link2.com, broadcast<P>(arm.link2.inertia)};
            heavier.link3 = {arm.link3.length, mass, arm.link3.com, broadcast<P>(arm.link3.inertia)};
            heavier.payload = P(arm.payload);
            heavier.gravity = broadcast<P>(arm.gravity);
            heavier.armature = broadcast<P>(arm.armature);
            heavier.lumped = lump_planar(heavier);
            const Vec3<P> q = broadcast<P>(three(x.data())), qd = broadcast<P>(three(x.data() + 3)),
                          tau = broadcast<P>(three(x.data() + 6));
            return joint_acceleration(heavier, pose(q), qd, tau);
        };
        const double m = arm.link3.mass, h = 1e-6;
        const Vec3<Slope> exact = acceleration(Slope::variable(m, 0));
        const Vec3<double> high = acceleration(m + h), low = acceleration(m - h);
        for (int k = 0; k < 3; ++k) {
            const double difference = (high[k] - low[k]) / (2 * h);
            CHECK(std::abs(exact[k].slope[0] - difference) <= 1e-5 * (1 + std::abs(difference)));
        }
    }
}

// ---- Expr

TEST_CASE(recorded_dynamics_play_back_to_the_same_bits) {
    Random random(47);
    const Arm<double> arm = random_params(random).arm();
    const auto dynamics = [&]<class T>(const T* x) {
        std::vector<T> out;
        put(out, forward_dynamics(arm, pose(three(x)), three(x + 3), three(x + 6), three(x + 9)));
        return out;
    };
    Tape tape;
    std::vector<Expr> inputs;
    for (int i = 0; i < state_numbers; ++i) inputs.push_back(tape.input());
    for (const Expr& result : dynamics(inputs.data())) tape.output(result);
    CHECK(tape.count(Op::sine) == 3);
    CHECK(tape.count(Op::tanh) == 3);
    CHECK(tape.count(Op::select) == 0);
    for (int i = 0; i < 1000; ++i) {
        const Numbers x = random_state(random);
        Numbers played(3);
        tape.play<double>(x, played);
        CHECK(same(played, dynamics(x.data())));
    }
}

// A whole step with contact can be recorded: its decisions become choices.
TEST_CASE(a_recorded_step_with_contact_plays_back_to_the_same_bits_of_full_sines) {
    Random random(48);
    const Plant<double> plant = plant_with_wall(random);
    Tape tape;
    std::vector<Expr> inputs;
    for (int i = 0; i < state_numbers; ++i) inputs.push_back(tape.input());
    RightHandSide<double, Expr> f(plant);
    f.force_mode = ContactForceMode::each_stage;
    const State<Expr, motion_size> y{inputs[0], inputs[1], inputs[2], inputs[3], inputs[4], inputs[5]};
    const Outlined<Expr, RightHandSide<double, Expr>> outlined{f};
    State<Expr, motion_size> f0;
    outlined(inputs[6], y, f0);
    for (const Expr& result : rk4_step(outlined, inputs[6], y, f0, Expr(0.01))) tape.output(result);
    CHECK(tape.count(Op::select) > 0);
    for (int i = 0; i < 300; ++i) {
        const Numbers x = random_state(random);
        Numbers played(motion_size);
        tape.play<double>(x, played);
        const Numbers direct = stepped(plant, x.data());
        for (std::size_t k = 0; k < motion_size; ++k)
            CHECK(std::abs(played[k] - direct[state_size + k]) <= 1e-9 * (1 + std::abs(played[k])));
    }
}

TEST_SUITE_END()

}  // namespace arm3r

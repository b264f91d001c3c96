#include "integrate/taylor.hpp"

#include <complex>

#include "arm3r/lanes.hpp"
#include "arm3r/numbers/widths.hpp"
#include "check.hpp"
#include "fixtures.hpp"

namespace arm3r {

TEST_SUITE(taylor)

using Real80 = long double;
using Terms = std::vector<Real80>;
constexpr int order = 14;
constexpr double at = 0.3;  // s

// ---- arms ------------------------------------------------------------------------------------------------------------

static void put_wall(Params& params, const Recipe& recipe, Random& random) {
    const char* const motions[] = {"fixed", "constant", "sinusoid"};
    params.set("wall", 1).set("wall.point", random.vector(-1, 1)).set("wall.normal", random.vector(-1, 1));
    params.choose("wall.motion.type", motions[int(random.in(0, recipe.even_wall ? 2 : 3))])
        .set("wall.motion.velocity", random.vector(-1, 1))
        .set("wall.motion.amplitude", 0.2)
        .set("wall.motion.frequency", random.in(0.2, 2))
        .set("wall.motion.phase", random.in(-3, 3));
    params.set("wall.face_offset", random.in(0, 0.1)).set("wall.contact.stiffness", random.vector(10, 500));
    params.set("wall.acts_on_arm", recipe.force);
}

// With all that the recipe tells of, and no more.
static Plant<double> random_plant(const Recipe& recipe, Random& random) {
    Params params = recipe.elbow ? random_elbow_params(random) : random_params(random);
    if (recipe.elbow) {  // gravity may be along axis 1; the rotors spin along their joints
        params.set("arm.base.rotation", {0, 0, random.in(-3, 3)});
        params.set("arm.rotor2.axis", {0, -1, 0}).set("arm.rotor3.axis", {0, 0, 1});
    }
    if (!recipe.damping) params.set("arm.damping", {0, 0, 0});
    if (!recipe.friction) params.set("arm.friction", {0, 0, 0});
    params.set("arm.friction_velocity", 1);  // at the speeds tried, tanh is far enough from 1 to be compared
    if (!recipe.oblique) params.set("arm.gravity", {0, 0, random.in(-10, 10)});
    if (recipe.signals) put_wall(params, recipe, random);
    const char* const types[] = {"none", "constant", "gravity_compensation"};
    params.choose("controller.type", types[int(recipe.torque)]).set("controller.torque", random.vector(-3, 3));
    params.set("controller.model.link3.mass", random.in(0.3, 3));
    return make_setup(params).plant;
}

static State<double, state_size> random_state(Random& random) {
    State<double, state_size> y{};
    for (std::size_t i = 0; i < state_size; ++i) y[i] = random.in(-1.5, 1.5);
    return y;
}

static Pose<double> pose_of(const State<double, state_size>& y) { return pose(Vec3<double>(y[0], y[1], y[2])); }

static Expansion<double> expanded(Kernel kernel, const Plant<double>& plant, const State<double, state_size>& y) {
    Expansion<double> e;
    expand(kernel, plant, at, y, pose_of(y), order, e);
    return e;
}

// ---- by definition ---------------------------------------------------------------------------------------------------

// Coefficient k of one node of a tape, from the coefficients of its operands; x: those known of the node itself.
static Real80 by_definition(const TapeNode& n, const std::vector<Terms>& all, const Terms& x, std::size_t k) {
    const auto a = [&](std::size_t i) { return all[n.a][i]; };
    const auto b = [&](std::size_t i) { return all[n.b][i]; };
    Real80 sum = 0;
    switch (n.op) {
        case Op::constant: return k == 0 ? n.number : 0;
        case Op::add: return a(k) + b(k);
        case Op::subtract: return a(k) - b(k);
        case Op::negate: return -a(k);
        case Op::multiply:
            for (std::size_t i = 0; i <= k; ++i) sum += a(i) * b(k - i);
            return sum;
        case Op::divide:
            for (std::size_t i = 1; i <= k; ++i) sum += b(i) * x[k - i];
            return (a(k) - sum) / b(0);
        case Op::tanh: {  // k x_k = sum of i a_i (1 - x^2)_(k-i)
            if (k == 0) return std::tanh(a(0));
            for (std::size_t i = 1; i <= k; ++i) {
                Real80 rest = i == k ? 1 : 0;
                for (std::size_t j = 0; j <= k - i; ++j) rest -= x[j] * x[k - i - j];
                sum += Real80(i) * a(i) * rest;
            }
            return sum / Real80(k);
        }
        default: throw std::logic_error("not in a motion");
    }
}

// The series of sine and cosine belong together: that of exp(i a).
static Terms turned(Op op, const Terms& a) {
    std::vector<std::complex<Real80>> e{std::polar<Real80>(1, a[0])};
    for (std::size_t k = 1; k < a.size(); ++k) {
        std::complex<Real80> sum = 0;
        for (std::size_t i = 1; i <= k; ++i) sum += Real80(i) * a[i] * e[k - i];
        e.push_back(sum * std::complex<Real80>(0, 1) / Real80(k));
    }
    Terms x;
    for (const auto& z : e) x.push_back(op == Op::sine ? z.imag() : z.real());
    return x;
}

static std::vector<Terms> played(const Tape& tape, const std::vector<Terms>& inputs) {
    std::vector<Terms> all;
    for (const TapeNode& n : tape.nodes()) {
        Terms x;
        if (n.op == Op::input) x = inputs[std::size_t(n.number)];
        else if (n.op == Op::sine || n.op == Op::cosine) x = turned(n.op, all[n.a]);
        else
            while (x.size() < inputs[0].size()) x.push_back(by_definition(n, all, x, x.size()));
        all.push_back(x);
    }
    std::vector<Terms> outputs;
    for (const int i : tape.outputs()) outputs.push_back(all[i]);
    return outputs;
}

// Position and velocity of the wall's frame about `at`.
static std::vector<Terms> wall_terms(const Wall<double>& wall) {
    std::vector<Terms> x(6, Terms(order + 1, 0.0));
    const Real80 w = 2 * std::acos(Real80(-1)) * wall.sinusoid.frequency, A = wall.sinusoid.amplitude;
    for (int i = 0; i < 3; ++i) {
        Terms& p = x[i];
        p[0] = wall.point[i];
        if (wall.motion == Motion::constant) p[0] += wall.velocity[i] * Real80(at), p[1] = wall.velocity[i];
        if (wall.motion == Motion::sinusoid) {
            Real80 factor = A * wall.direction[i];
            p[0] -= factor * std::sin(Real80(wall.sinusoid.phase));
            for (int k = 0; k <= order; factor *= w / Real80(++k))
                p[k] += factor * std::sin(w * Real80(at) + wall.sinusoid.phase + k * std::acos(Real80(0)));
        }
        for (int k = 0; k < order; ++k) x[3 + i][k] = Real80(k + 1) * p[k + 1];
        x[3 + i][order] = 0;  // enters nothing that is compared
    }
    return x;
}

// The motion as the plant's own formula has it, order by order.
static std::vector<Terms> series_by_definition(const Plant<double>& plant, bool pressed,
                                               const State<double, state_size>& start) {
    Tape tape;
    State<Expr, state_size> y, dy;
    for (Expr& x : y) x = tape.input();
    WallState<Expr> wall;
    for (Expr& x : wall.position) x = tape.input();
    for (Expr& x : wall.velocity) x = tape.input();
    RightHandSide<double, Expr> rhs(plant);
    rhs.force_mode = pressed ? ContactForceMode::pressed : ContactForceMode::none;
    const Pose<Expr> start_pose = rhs.pose_near(y);
    Vec3<Expr> tau;
    rhs.derivative(Expr(0.0), wall, start_pose, tip_indentation(plant, wall, start_pose, Vec3<Expr>(y[3], y[4], y[5])),
                   y, dy, tau);
    for (const Expr& x : dy) tape.output(x);
    const auto [q1, q2, q3] = std::array{y[0], y[1], Expr(y[1] + y[2])};
    const SinCos<Expr> s1 = sincos(q1), s2 = sincos(q2), s3 = sincos(q3);
    const Pose<Expr> p{s1.sin, s1.cos, s2.sin, s2.cos, s3.sin, s3.cos};
    const Indentation<Expr> in = indentation(plant.wall, wall, tip_position(plant.arm, p), Vec3<Expr>(0.0, 0.0, 0.0));
    for (const Expr& x : {in.depth, in.across1, in.across2}) tape.output(x);

    std::vector<Terms> known;
    for (const double x : start) known.push_back({x});
    for (int k = 0; k <= order; ++k) {
        std::vector<Terms> inputs = known;
        for (Terms terms : wall_terms(plant.wall)) inputs.push_back((terms.resize(k + 1), terms));
        const std::vector<Terms> rates = played(tape, inputs);
        if (k == order) known.insert(known.end(), rates.begin() + state_size, rates.end());
        else
            for (std::size_t j = 0; j < state_size; ++j) known[j].push_back(rates[j][k] / Real80(k + 1));
    }
    return known;
}

static double distance(const Expansion<double>& e, const std::vector<Terms>& truth, std::size_t quantities_compared) {
    double worst = 0;
    for (int k = 0; k <= order; ++k) {
        Real80 size = 1e-300L;
        for (std::size_t j = 0; j < quantities_compared; ++j) size = std::max(size, std::abs(truth[j][k]));
        for (std::size_t j = 0; j < quantities_compared; ++j)
            worst = std::max(worst, double(std::abs(e.c[k][j] - truth[j][k]) / size));
    }
    return worst;
}

TEST_CASE(every_kernel_gives_the_series_by_definition) {
    Random random(1);
    for (std::size_t i = 0; i < recipes.size(); ++i)
        for (int n = 0; n < 30; ++n) {
            const Plant<double> plant = random_plant(recipes[i], random);
            const State<double, state_size> y = random_state(random);
            const std::vector<Terms> truth = series_by_definition(plant, recipes[i].force, y);
            const std::size_t compared = recipes[i].signals ? std::size_t(works_at) : std::size_t(state_size);
            const Expansion<double> e = expanded(Kernel(i), plant, y);
            CHECK(distance(e, truth, compared) < 1e-12, "recipe " << i);
            for (int k = 1; k <= order; ++k) {
                const double* work = e.c[k] + works_at;
                const double size = std::abs(work[0]) + std::abs(work[1]) + std::abs(work[2]);
                CHECK(std::abs(work[0] + work[1] + work[2] - e.c[k][6]) <= 1e-12 * size, "works of recipe " << i);
            }
        }
}

TEST_CASE(the_series_is_the_motion) {
    Random random(2);
    for (std::size_t i = 0; i < recipes.size(); ++i) {
        const Plant<double> plant = random_plant(recipes[i], random);
        State<double, state_size> y = random_state(random), f0;
        const Expansion<double> e = expanded(Kernel(i), plant, y);
        const double span = std::min(0.02, step_of(e, 1e-14)), h = span / 100;
        RightHandSide<double, double> f(plant);
        f.force_mode = recipes[i].force ? ContactForceMode::pressed : ContactForceMode::none;
        for (int n = 0; n < 100; ++n) {
            const double t = at + n * h;
            f.begin_step(y);
            f(t, y, f0);
            Dopri5<double, state_size, motion_size> dopri5;
            dopri5.step(f, t, y, f0, h);
            y = dopri5.y1;
        }
        for (std::size_t j = 0; j < state_size; ++j)
            CHECK(std::abs(value(e, j, span) - y[j]) < 1e-12 * std::max(1.0, std::abs(y[j])), i << ", " << j);
        if (!recipes[i].signals) continue;
        const Pose<double> p = pose(Vec3<double>(y[0], y[1], y[2]));
        const Indentation<double> in = tip_indentation(plant, wall_at(plant.wall, at + span), p, {0, 0, 0});
        const double seen[] = {in.depth, in.across1, in.across2};
        for (std::size_t j = 0; j < signals_size; ++j)
            CHECK(std::abs(value(e, state_size + j, span) - seen[j]) < 1e-12, i << ", signal " << j);
    }
}

// Each lane with a plant, a state and an instant of its own, at every order.
template <int N>
static void check_lanes() {
    Random random(3);
    for (std::size_t i = 0; i < recipes.size(); ++i) {
        Plant<double> plants[N];
        State<double, state_size> y[N];
        Plant<Pack<N>> pack_plant;
        State<Pack<N>, state_size> pack_y;
        Pack<N> t, tol(1e-9);
        for (int lane = 0; lane < N; ++lane) {
            plants[lane] = random_plant(recipes[i], random);
            plants[lane].wall.motion = plants[0].wall.motion;
            y[lane] = random_state(random);
            copy_choices(plants[lane], pack_plant);
            each_number([lane](Pack<N>& all, const double& one) { all.set(lane, one); }, pack_plant, plants[lane]);
            for (std::size_t j = 0; j < state_size; ++j) pack_y[j].set(lane, y[lane][j]);
            t.set(lane, lane * 0.1);
        }
        const Pose<Pack<N>> pack_pose = pose(Vec3<Pack<N>>(pack_y[0], pack_y[1], pack_y[2]));
        for (int n = 1; n <= max_degree; ++n) {
            Expansion<Pack<N>> packed;
            expand(Kernel(i), pack_plant, t, pack_y, pack_pose, n, packed);
            const Pack<N> h = step_of(packed, tol);
            for (int lane = 0; lane < N; ++lane) {
                Expansion<double> one;
                expand(Kernel(i), plants[lane], t[lane], y[lane], pose_of(y[lane]), n, one);
                REQUIRE(same_bits(step_of(one, tol[lane]), h[lane]));
                for (std::size_t j = 0; j < quantities; ++j) {
                    REQUIRE(same_bits(value(one, j, 0.01), value(packed, j, Pack<N>(0.01))[lane]));
                    for (int k = 0; k <= n; ++k) REQUIRE(same_bits(one.c[k][j], packed.c[k][j][lane]));
                }
            }
        }
    }
}

TEST_CASE(lanes_have_the_bits_of_double) {
    CHECK(max_lanes() >= 1);
#define CHECK_LANES(T) \
    if (has_registers_for(Lanes<T>::count)) check_lanes<Lanes<T>::count>();
    ARM3R_LANE_PACKS(CHECK_LANES)
}

TEST_CASE(a_lower_order_is_the_beginning_of_a_higher_one) {
    Random random(4);
    for (std::size_t i = 0; i < recipes.size(); ++i) {
        const Plant<double> plant = random_plant(recipes[i], random);
        const State<double, state_size> y = random_state(random);
        const Expansion<double> long_one = expanded(Kernel(i), plant, y);
        for (int n = 1; n < order; ++n) {
            Expansion<double> e;
            expand(Kernel(i), plant, at, y, pose_of(y), n, e);
            for (int k = 0; k <= n; ++k)
                for (std::size_t j = 0; j < quantities; ++j) REQUIRE(same_bits(e.c[k][j], long_one.c[k][j]));
        }
    }
}

TEST_CASE(a_wall_of_no_stiffness_changes_no_bit) {
    Random random(5);
    for (std::size_t i = 0; i < recipes.size(); ++i) {
        if (!recipes[i].force || recipes[i].oblique || recipes[i].elbow) continue;  // of one kernel with and without
        for (int n = 0; n < 100; ++n) {
            Plant<double> plant = random_plant(recipes[i], random);
            plant.contact.stiffness[0] = 0;
            const State<double, state_size> y = random_state(random);
            const Expansion<double> pressed = expanded(kernel_of(plant, true), plant, y);
            const Expansion<double> watched = expanded(kernel_of(plant, false), plant, y);
            CHECK(bool(kernel_of(plant, true) == Kernel(i)));
            CHECK(bool(kernel_of(plant, false) != Kernel(i)));
            for (int k = 0; k <= order; ++k)
                for (std::size_t j = 0; j < quantities; ++j) REQUIRE(pressed.c[k][j] == watched.c[k][j]);
        }
    }
}

TEST_CASE(the_cheapest_kernel_that_suffices_is_taken) {
    Random random(6);
    for (std::size_t i = 0; i < recipes.size(); ++i) {
        const Plant<double> plant = random_plant(recipes[i], random);
        CHECK(bool(kernel_of(plant, recipes[i].force) == Kernel(i)), "recipe " << i);
    }
    Plant<double> free_of_control = random_plant(recipes.back(), random);
    free_of_control.controller.type = ControllerType::none;
    CHECK(recipes[std::size_t(kernel_of(free_of_control, true))].friction);
}

TEST_CASE(the_order_follows_the_tolerance) {
    const auto formula = [](double tol) { return std::clamp(int(std::ceil(-std::log(tol) / 2)) + 1, 2, max_degree); };
    for (const double tol : {1.0, 0.5, 1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-16, 1e-300})
        CHECK(order_of(tol) == formula(tol), tol);
    CHECK(order_of(0.0) == max_degree);
}

TEST_CASE(a_rough_root_is_good_to_a_thousandth) {
    Random random(7);
    for (int k = 1; k <= max_degree; ++k)
        for (int n = 0; n < 2000; ++n) {
            const double x = std::exp(random.in(-700, 700));
            const double truth = std::pow(x, 1.0 / k);
            REQUIRE(std::abs(approximate_root(x, k) - truth) < 1e-3 * truth);
        }
}

TEST_CASE(a_step_keeps_its_tolerance) {
    Expansion<double> e{.order = 10, .c = {}};
    CHECK(step_of(e, 1e-9) == HUGE_VAL);
    e.c[0][1] = 100;
    e.c[10][1] = 3;  // relative, to the power of two below: 3/64
    CHECK_CLOSE(step_of(e, 1e-9), std::pow(1e-9 / (3.0 / 64), 0.1), 1e-3);
    e.c[0][state_size] = 100;
    e.c[9][state_size] = 5;  // a signal: absolute
    CHECK_CLOSE(step_of(e, 1e-9), std::pow(1e-9 / 5, 1.0 / 9), 1e-3);

    Random random(8);
    for (int n = 0; n < 100; ++n) {
        const Recipe recipe = recipes[std::size_t(random.in(0, recipes.size() - 2))];
        const Plant<double> plant = random_plant(recipe, random);
        const State<double, state_size> y = random_state(random);
        const Kernel kernel = kernel_of(plant, recipe.force);
        Expansion<double> e, better;
        expand(kernel, plant, at, y, pose_of(y), order_of(1e-9), e);
        expand(kernel, plant, at, y, pose_of(y), max_degree, better);
        const double h = step_of(e, 1e-9);
        for (std::size_t j = 0; j < quantities; ++j)
            CHECK(std::abs(value(e, j, h) - value(better, j, h)) < 3e-9 * std::max(1.0, std::abs(y[j % state_size])));
    }
}

TEST_SUITE_END()

}  // namespace arm3r

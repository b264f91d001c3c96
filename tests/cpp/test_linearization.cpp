
#include "arm3r/lanes.hpp"
#include "arm3r/ode/linearization.hpp"
#include "arm3r/plant.hpp"
#include "check.hpp"
#include "fixtures.hpp"
#include "integrate/motion_jacobian.hpp"

namespace arm3r {

TEST_SUITE(linearization)

using Full = State<double, state_size>;
using Slopes = Linearization<state_size>;

// A plant with all features of the right-hand side: an oblique gravity, friction of both kinds, a controller with the
// model of another arm, at times at its limit, an oscillating wall.
static Plant<double> random_plant(Random& random, double friction_velocity) {
    Params params =
        random_params(random).set("wall", 1).set("wall.acts_on_arm", 1).set("wall.point", random.vector(-0.5, 0.5));
    params.set("wall.normal", random.vector(-1, 1)).choose("wall.motion.type", "sinusoid");
    params.set("wall.motion.amplitude", 0.2).set("wall.motion.frequency", 3).set("wall.motion.phase", 0.4);
    params.set("wall.contact.stiffness", 700).set("arm.friction_velocity", friction_velocity);
    params.choose("controller.type", "gravity_compensation")
        .choose("controller.algorithm", random.in(0, 1) < 0.5 ? "recursion" : "closed_form")
        .set("controller.model.link3.mass", 0.9)
        .set("arm.torque_limit", {5, 20, 10});
    return make_setup(params).plant;
}

static Full random_state(Random& random) {
    Full y;
    for (std::size_t i = 0; i < state_size; ++i) y[i] = random.in(-1.5, 1.5);
    return y;
}

template <class T>
static RightHandSide<double, T> right_hand_side(const Plant<double>& plant, ContactForceMode force_mode) {
    RightHandSide<double, T> f(plant);
    f.force_mode = force_mode;
    return f;
}

template <int K>
static Slopes slopes_of(const Plant<double>& plant, ContactForceMode force_mode, double t, const Full& y, Full& f0) {
    Slopes linearization{};
    auto f = right_hand_side<Dual<K>>(plant, force_mode);
    linearize<motion_size, quadrature_count, K>(f, t, y, 0, f0, linearization);
    return linearization;
}

// d f/d x of component i along one input, by the central difference of order 6.
template <class F>
static Full difference(F f, double h) {
    Full slope{};
    const double weights[] = {0.75, -0.15, 1.0 / 60};
    for (int k = 1; k <= 3; ++k) {
        const Full ahead = f(k * h), behind = f(-k * h);
        for (std::size_t i = 0; i < state_size; ++i) slope[i] += weights[k - 1] * (ahead[i] - behind[i]) / h;
    }
    return slope;
}

static void check(const Full& slope, const Full& expected, double tolerance, const char* input, std::size_t j) {
    for (std::size_t i = 0; i < state_size; ++i)
        CHECK(std::abs(slope[i] - expected[i]) <= tolerance * (1 + std::abs(expected[i])),
              "f" << i << " by " << input << j << ": " << slope[i] << ", not " << expected[i]);
}

static Full column(const Slopes& linearization, std::size_t j) {
    Full of_all;
    for (std::size_t i = 0; i < state_size; ++i) of_all[i] = linearization.df_dy[i][j];
    return of_all;
}

static bool is_near_a_limit(const Plant<double>& plant, const Full& y) {
    const Vec3<double> q(y[0], y[1], y[2]), tau = feedforward_torque(plant.controller, q, pose(q));
    for (int i = 0; i < 3; ++i)
        if (std::abs(std::abs(tau[i]) - plant.arm.torque_limit[i]) < 0.5) return true;
    return false;
}

// The differences turn their poses from the same anchor as the slopes do, or, `far`, from none that is near.
static void check_plant(const Plant<double>& plant, ContactForceMode force_mode, double t, const Full& y, bool far,
                        double h, double tolerance) {
    auto f = right_hand_side<double>(plant, force_mode);
    Full anchor = y;
    if (far)
        for (std::size_t i = 0; i < 3; ++i) anchor[i] += 1;
    f.begin_step(anchor);
    const auto at = [&](double t, const Full& y) {
        Full dy;
        f(t, y, dy);
        return dy;
    };
    Full f0{};
    const Slopes linearization = slopes_of<7>(plant, force_mode, t, y, f0);
    for (std::size_t j = 0; j < motion_size; ++j) {
        const auto moved = [&](double by) {
            Full shifted = y;
            shifted[j] += by;
            return at(t, shifted);
        };
        check(column(linearization, j), difference(moved, h), tolerance, "y", j);
    }
    check(linearization.df_dt, difference([&](double by) { return at(t + by, y); }, h), tolerance, "t", 0);
}

TEST_CASE(slopes_of_the_plant_are_the_differences) {
    Random random(61);
    int limited = 0;
    for (int i = 0; i < 200; ++i) {
        const Plant<double> plant = random_plant(random, 0.3);
        Full y = random_state(random);
        y[2] = random.in(0.5, 2.5);  // away from the singular poses, where differences fail
        if (is_near_a_limit(plant, y)) continue;
        for (const ContactForceMode force_mode : {ContactForceMode::none, ContactForceMode::pressed})
            check_plant(plant, force_mode, random.in(0, 3), y, i % 2 == 0, 1e-3, 1e-7);
        const Vec3<double> q(y[0], y[1], y[2]), tau = feedforward_torque(plant.controller, q, pose(q));
        limited += std::abs(tau[1]) > plant.arm.torque_limit[1] || std::abs(tau[2]) > plant.arm.torque_limit[2];
    }
    CHECK(limited > 10);
    CHECK(limited < 150);
}

// On a point of the grid of angles the pose is not turned at all; it must still turn with the angle.
TEST_CASE(slopes_on_the_grid_of_angles) {
    Random random(62);
    for (int i = 0; i < 20; ++i) {
        const Plant<double> plant = random_plant(random, 0.3);
        Full y = random_state(random);
        y[0] = 13.0 / 32;
        y[1] = -21.0 / 32;
        y[2] = 50.0 / 32;
        if (!is_near_a_limit(plant, y)) check_plant(plant, ContactForceMode::pressed, 0.3, y, false, 1e-3, 1e-7);
    }
}

// The steepest of friction: what makes a motion stiff. From rest, where it is known: d tau_f/d qd = damping + friction/v.
TEST_CASE(slopes_of_sharp_friction) {
    Random random(63);
    for (const double velocity : {1e-3, 1e-6}) {
        const Plant<double> plant = random_plant(random, velocity);
        Full y = random_state(random), f0{};
        y[2] = 1.1;
        y[3] = y[4] = y[5] = 0;
        const Slopes linearization = slopes_of<7>(plant, ContactForceMode::none, 0.0, y, f0);
        const Mat3<double> M = mass_matrix(plant.arm, pose(Vec3<double>(y[0], y[1], y[2])));
        Eigen::Matrix3d by_rate;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                by_rate(Eigen::Index(i), Eigen::Index(j)) = linearization.df_dy[3 + i][3 + j];
        const Eigen::Matrix3d steepness = -Eigen::Matrix3d(M) * by_rate;
        for (int i = 0; i < 3; ++i) {
            const double expected = plant.arm.damping[i] + plant.arm.friction[i] / velocity;
            CHECK(std::abs(steepness(i, i) / expected - 1) <= 1e-9);
            for (int j = 0; j < 3; ++j)
                if (i != j) CHECK(std::abs(steepness(i, j)) <= 1e-9 * expected);
        }
    }
}

// A few slopes at a time or all at once; and the derivative itself, as by doubles.
TEST_CASE(every_width_gives_the_same_bits_and_those_of_doubles) {
    Random random(64);
    for (int i = 0; i < 100; ++i) {
        const Plant<double> plant = random_plant(random, 0.1);
        const Full y = random_state(random);
        const double t = random.in(0, 3);
        auto f = right_hand_side<double>(plant, ContactForceMode::pressed);
        Full plain;
        f.begin_step(y);
        f(t, y, plain);
        Full f7, f3, f1;
        const Slopes at_once = slopes_of<7>(plant, ContactForceMode::pressed, t, y, f7),
                     by_threes = slopes_of<3>(plant, ContactForceMode::pressed, t, y, f3),
                     singly = slopes_of<1>(plant, ContactForceMode::pressed, t, y, f1);
        for (std::size_t k = 0; k < state_size; ++k) {
            for (const Full& f0 : {f7, f3, f1}) CHECK(same_bits(f0[k], plain[k]));
            for (const Slopes& other : {by_threes, singly}) {
                CHECK(same_bits(other.df_dt[k], at_once.df_dt[k]));
                for (std::size_t j = 0; j < motion_size; ++j) CHECK(same_bits(other.df_dy[k][j], at_once.df_dy[k][j]));
            }
        }
    }
}

// Any arm at any wall that moves or turns, under any contact law, pushed by a force from outside.
static Plant<double> random_plant_at_wall(Random& random, const std::string& law, const std::string& motion) {
    const bool is_elbow = random.in(0, 1) < 0.5;
    Params params = is_elbow ? random_elbow_params(random) : random_params(random);
    params.set("wall", 1).set("wall.acts_on_arm", 1).set("wall.point", random.vector(-0.5, 0.5));
    params.set("wall.normal", random.vector(-1, 1)).choose("wall.motion.type", motion);
    if (motion == "constant") params.set("wall.motion.velocity", random.vector(-1, 1));
    if (motion == "sinusoid")
        params.set("wall.motion.amplitude", 0.2).set("wall.motion.frequency", 3).set("wall.motion.phase", 0.4);
    if (motion == "ramp") params.set("wall.motion.distance", 0.3).set("wall.motion.duration", 2);
    if (random.in(0, 1) < 0.5)
        params.choose("wall.rotation.type", "sinusoid")
            .set("wall.rotation.axis", random.vector(-1, 1))
            .set("wall.rotation.amplitude", 0.3)
            .set("wall.rotation.frequency", 2);
    params.choose("wall.contact.law", law).set("wall.contact.stiffness", 700);
    if (law == "kelvin_voigt") params.set("wall.contact.damping", 3);
    if (law == "hunt_crossley") params.set("wall.contact.exponent", 1.4).set("wall.contact.dissipation", 0.4);
    if (law == "diagonal") params.set("wall.contact.stiffness", {700, 300, 200});
    if (law != "spring") params.set("wall.contact.friction.coefficient", 0.3);
    params.choose("controller.type", random.in(0, 1) < 0.5 ? "gravity_compensation" : "none");
    if (random.in(0, 1) < 0.5) params.set("arm.torque_limit", {5, 20, 10});
    params.set("push", 1).set("push.force", random.vector(-5, 5)).set("push.start", 0.5).set("push.rise", 0.7);
    return make_setup(params).plant;
}

// Recorded once for all plants of the same choices, and differentiated by a sweep over all lanes.
template <class T>
static void check_recorded(Random& random, const std::string& law, const std::string& motion) {
    constexpr int lanes = Lanes<T>::count;
    const Random same_choices = random;
    MotionJacobian<T> jacobian;
    Plant<T> plant;
    std::array<std::optional<Plant<double>>, lanes> alone;
    for (int lane = 0; lane < lanes; ++lane) {
        Random again = same_choices;
        alone[lane] = random_plant_at_wall(again, law, motion);
        alone[lane]->contact.stiffness[0] += lane;
        alone[lane]->arm.damping[1] += 0.1 * lane;
        if (lane == 0) copy_choices(*alone[lane], plant);
        each_number([&](T& x, double one) { Lanes<T>::set(x, lane, one); }, plant, *alone[lane]);
        jacobian.load_lane(lane, *alone[lane]);
        random = again;
    }
    for (int k = 0; k < 4; ++k) {
        RightHandSide<T, T> rhs(plant);
        rhs.force_mode = k == 0 ? ContactForceMode::none : ContactForceMode::pressed;
        std::array<Full, lanes> y;
        T t, latest;
        State<T, state_size> states, f0{};
        typename Lanes<T>::Mask here = false;
        for (int lane = 0; lane < lanes; ++lane) {
            y[lane] = random_state(random);
            for (std::size_t i = 0; i < state_size; ++i) Lanes<T>::set(states[i], lane, y[lane][i]);
            Lanes<T>::set(t, lane, random.in(0, 3)), Lanes<T>::set(latest, lane, random.in(0, 3));
            Lanes<T>::mark(rhs.touching, lane, random.in(0, 1) < 0.7);
            Lanes<T>::mark(rhs.separated, lane, k == 2 && Lanes<T>::is(rhs.touching, lane) && random.in(0, 1) < 0.5);
            Lanes<T>::mark(here, lane, k < 3 || random.in(0, 1) < 0.7);
        }
        rhs.latest = latest;
        Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { rhs.begin_step(states); });
        std::array<Slopes, lanes> found{};
        jacobian.find(here, rhs, plant.held_torque, t, states, f0, found);
        for (int lane = 0; lane < lanes; ++lane) {
            if (!Lanes<T>::is(here, lane)) continue;
            auto f = right_hand_side<Dual<7>>(*alone[lane], rhs.force_mode);
            f.touching = Lanes<T>::is(rhs.touching, lane), f.separated = Lanes<T>::is(rhs.separated, lane);
            f.latest = Lanes<T>::get(latest, lane);
            Full values{};
            Slopes by_duals{};
            linearize<motion_size, quadrature_count, 7>(f, Lanes<T>::get(t, lane), y[lane], 0, values, by_duals);
            for (std::size_t i = 0; i < state_size; ++i) {
                CHECK(Lanes<T>::get(f0[i], lane) == values[i]);
                CHECK(found[lane].df_dt[i] == by_duals.df_dt[i]);
                for (std::size_t j = 0; j < motion_size; ++j)
                    CHECK(found[lane].df_dy[i][j] == by_duals.df_dy[i][j], law << motion << i << j);
            }
        }
    }
}

template <class... Packs>
static void check_recorded_in_lanes(TypeList<Packs...>, Random& random, const std::string& law,
                                    const std::string& motion) {
    const auto check = [&]<class T>() {
        if (has_registers_for(Lanes<T>::count)) check_recorded<T>(random, law, motion);
    };
    (check.template operator()<Packs>(), ...);
}

TEST_CASE(a_recorded_motion_has_the_slopes_of_duals) {
    Random random(65);
    for (const std::string law : {"spring", "diagonal", "kelvin_voigt", "hunt_crossley"})
        for (const std::string motion : {"fixed", "constant", "sinusoid", "ramp"})
            for (int i = 0; i < 8; ++i) {
                check_recorded<double>(random, law, motion);
                check_recorded_in_lanes(LanePacks{}, random, law, motion);
            }
}

// The quadratures are followed by the memory of a controller, of which some components are in use.
struct Remembering {
    template <class S>
    void begin_step(const S&) {}
    template <class T>
    void operator()(const T& t, const State<T, 5>& y, State<T, 5>& dy) const {
        dy[0] = y[0] * y[2] + t * y[3];
        dy[1] = y[2] * y[2] * t;
        dy[2] = y[3] - 2.0 * t * t;
        dy[3] = y[0] * y[0] * y[0] + y[2];
        dy[4] = y[4];
    }
};

TEST_CASE(memory_counts_as_far_as_it_is_in_use) {
    constexpr std::size_t N = 5;  // one motion, one quadrature, three of memory
    const State<double, N> y{0.7, 1e9, -0.3, 1.1, 5.0};
    const double t = 0.6;
    const State<double, N> untouched{-7, -7, -7, -7, -7};
    State<double, N> f0 = untouched;
    Linearization<N> linearization{{untouched, untouched, untouched, untouched, untouched}, untouched};
    Remembering f;
    linearize<1, 1, 2>(f, t, y, 2, f0, linearization);
    const State<double, N> df_dy[] = {{y[2], -7, y[0], t, -7},
                                      {0, -7, 2 * y[2] * t, 0, -7},
                                      {0, -7, 0, 1, -7},
                                      {3 * y[0] * y[0], -7, 1, 0, -7},
                                      untouched};
    const State<double, N> df_dt{y[3], y[2] * y[2], -4 * t, 0, -7};
    for (std::size_t i = 0; i < N; ++i) {
        CHECK(std::abs(linearization.df_dt[i] - df_dt[i]) <= 1e-15);
        for (std::size_t j = 0; j < N; ++j) CHECK(std::abs(linearization.df_dy[i][j] - df_dy[i][j]) <= 1e-15);
    }
    CHECK(f0[4] == -7);
    CHECK(f0[3] == y[0] * y[0] * y[0] + y[2]);
}

TEST_SUITE_END()

}  // namespace arm3r

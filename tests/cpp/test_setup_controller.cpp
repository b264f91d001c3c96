#include "arm3r/lanes.hpp"
#include "arm3r/model/dynamics.hpp"
#include "check.hpp"
#include "fixtures.hpp"
#include "linear_algebra.hpp"
#include "setup/make_controller.hpp"
#include "validate/stability_limits.hpp"
#include "validate/validate.hpp"

namespace arm3r {

TEST_SUITE(setup_controller)

static const std::vector<std::string> laws = {
    "joint_pd",   "computed_torque",    "resolved_acceleration", "stiffness",   "joint_stiffness",
    "impedance",  "shaped_impedance",   "operational_space",     "hybrid",      "parallel",
    "admittance", "adaptive_reference", "energy_tank",           "virtual_wall"};

static Params with_law(const std::string& type) {
    return unequal_params().choose("controller.type", type).set("wall", 1).set("wall.acts_on_arm", 1);
}

static Controller<double> controller_of(const Params& params) { return make_setup(params).controller(); }
static Reference<double> reference_of(const Params& params) { return controller_of(params).reference; }

static void check_close(const Vec3<double>& a, const Vec3<double>& b, double within) {
    CHECK(distance(a, b) <= within, a.transpose() << " and " << b.transpose());
}

// The tip by plane trigonometry, with the mathematical library's functions.
static Vec3<double> tip_by_hand(const Vec3<double>& q, double height, double a2, double a3) {
    const double r = a2 * std::cos(q[1]) + a3 * std::cos(q[1] + q[2]);
    return {r * std::cos(q[0]), r * std::sin(q[0]), height + a2 * std::sin(q[1]) + a3 * std::sin(q[1] + q[2])};
}

static Params along_a_table() {
    Params params = with_law("stiffness").choose("reference.type", "table");
    const double t[] = {0.5, 1.1, 1.4, 2.9, 3.3}, x[] = {0.2, -0.1, 0.4, 0.35, 1.3}, z[] = {1, 1.1, 1.05, 0.9, 1};
    for (std::size_t i = 0; i < 5; ++i) {
        const std::string place = "[" + std::to_string(i) + "]";
        params.set("reference.t" + place, t[i]).set("reference.x" + place, x[i]);
        params.set("reference.y" + place, -0.5).set("reference.z" + place, z[i]);
    }
    return params;
}

// ---- choices and gains

template <class Enum>
static void check_words(const char* path, const std::vector<std::pair<const char*, Enum>>& words,
                        Enum (*chosen)(const Params&), Params params) {
    CHECK(words.size() == find_key(path)->choices.size());
    for (const auto& [word, choice] : words) CHECK((chosen(params.choose(path, word)) == choice), path << ": " << word);
}

TEST_CASE(every_word_is_the_choice_of_its_name) {
    using C = ControllerType;
    const Params params = with_law("hybrid");
    check_words<C>(
        "controller.type",
        {{"none", C::none},
         {"constant", C::constant},
         {"gravity_compensation", C::gravity_compensation},
         {"joint_pd", C::joint_pd},
         {"computed_torque", C::computed_torque},
         {"resolved_acceleration", C::resolved_acceleration},
         {"stiffness", C::stiffness},
         {"joint_stiffness", C::joint_stiffness},
         {"impedance", C::impedance},
         {"shaped_impedance", C::shaped_impedance},
         {"operational_space", C::operational_space},
         {"hybrid", C::hybrid},
         {"parallel", C::parallel},
         {"admittance", C::admittance},
         {"adaptive_reference", C::adaptive_reference},
         {"energy_tank", C::energy_tank},
         {"virtual_wall", C::virtual_wall},
         {"user", C::user}},
        [](const Params& p) { return controller_of(p).type; }, Params(params).set("controller.torque", {1, 2, 3}));
    check_words<Variant>(
        "controller.variant",
        {{"dynamic", Variant::dynamic},
         {"jacobian_transpose", Variant::jacobian_transpose},
         {"projected", Variant::projected},
         {"raibert_craig", Variant::raibert_craig}},
        [](const Params& p) { return controller_of(p).variant; }, params);
    check_words<ForceTerm>(
        "controller.force_term", {{"cancelled", ForceTerm::cancelled}, {"feedforward", ForceTerm::feedforward}},
        [](const Params& p) { return controller_of(p).force_term; }, params);
    check_words<AntiWindup>(
        "controller.anti_windup",
        {{"none", AntiWindup::none},
         {"conditional", AntiWindup::conditional},
         {"back_calculation", AntiWindup::back_calculation}},
        [](const Params& p) { return controller_of(p).anti_windup; }, params);
    check_words<Switching>(
        "controller.switching",
        {{"in_contact", Switching::in_contact}, {"latched", Switching::latched}, {"always", Switching::always}},
        [](const Params& p) { return controller_of(p).switching; }, params);
    check_words<Inner>(
        "controller.inner", {{"exact", Inner::exact}, {"position", Inner::position}, {"joint_pd", Inner::joint_pd}},
        [](const Params& p) { return controller_of(p).inner; }, params);
    check_words<Adaptation>(
        "controller.adaptation", {{"integral", Adaptation::integral}, {"indirect", Adaptation::indirect}},
        [](const Params& p) { return controller_of(p).adaptation; }, params);
    check_words<Saturation>(
        "controller.saturation", {{"clamp", Saturation::clamp}, {"scale", Saturation::scale}},
        [](const Params& p) { return controller_of(p).saturation; }, params);
    check_words<Algorithm>(
        "controller.algorithm", {{"closed_form", Algorithm::closed_form}, {"recursion", Algorithm::recursion}},
        [](const Params& p) { return controller_of(p).algorithm; },
        Params(params).choose("controller.type", "gravity_compensation"));
    check_words<Path>(
        "reference.type",
        {{"hold", Path::hold},
         {"point", Path::point},
         {"line", Path::line},
         {"minimum_jerk", Path::minimum_jerk},
         {"circle", Path::circle},
         {"sinusoid", Path::sinusoid},
         {"table", Path::table}},
        [](const Params& p) { return reference_of(p).path; }, along_a_table());
    check_words<ForceProfile>(
        "reference.force.type",
        {{"constant", ForceProfile::constant},
         {"step", ForceProfile::step},
         {"ramp", ForceProfile::ramp},
         {"sinusoid", ForceProfile::sinusoid}},
        [](const Params& p) { return reference_of(p).force_profile; }, params);
    check_words<VelocityEstimate>(
        "sensors.velocity.estimate",
        {{"exact", VelocityEstimate::exact},
         {"difference", VelocityEstimate::difference},
         {"filtered", VelocityEstimate::filtered}},
        [](const Params& p) { return make_setup(p).digital.sensors.velocity; }, Params(params).set("sensors", 1));
    check_words<Reaction>(
        "observer.reaction",
        {{"ignore", Reaction::ignore},
         {"stop", Reaction::stop},
         {"float", Reaction::floating},
         {"reflex", Reaction::reflex},
         {"retreat", Reaction::retreat}},
        [](const Params& p) { return make_setup(p).digital.observer.reaction; }, Params(params).set("observer", 1));
}

// Each key of a gain beside where it goes.
struct Place {
    const char* key;
    Vec3<double> Gains<double>::* axes;
    double Gains<double>::* number;
    bool one_for_all;
};

static const std::vector<Place> places = {
    {"joint_stiffness", &Gains<double>::joint_stiffness, nullptr, false},
    {"joint_damping", &Gains<double>::joint_damping, nullptr, false},
    {"position_gain", &Gains<double>::position, nullptr, true},
    {"velocity_gain", &Gains<double>::velocity, nullptr, true},
    {"mass", &Gains<double>::mass, nullptr, true},
    {"stiffness", &Gains<double>::stiffness, nullptr, true},
    {"damping", &Gains<double>::damping, nullptr, true},
    {"plane_point", &Gains<double>::plane_point, nullptr, false},
    {"force_mass", nullptr, &Gains<double>::force_mass, false},
    {"force_damping", nullptr, &Gains<double>::force_damping, false},
    {"force_gain", nullptr, &Gains<double>::force, false},
    {"force_integral_gain", nullptr, &Gains<double>::force_integral, false},
    {"integral_limit", nullptr, &Gains<double>::integral_limit, false},
    {"tracking_time", nullptr, &Gains<double>::tracking_time, false},
    {"contact_on", nullptr, &Gains<double>::contact_on, false},
    {"contact_off", nullptr, &Gains<double>::contact_off, false},
    {"inner_bandwidth", nullptr, &Gains<double>::inner_bandwidth, false},
    {"inner_damping_ratio", nullptr, &Gains<double>::inner_damping_ratio, false},
    {"reference_gain", nullptr, &Gains<double>::reference_gain, false},
    {"assumed_stiffness", nullptr, &Gains<double>::assumed_stiffness, false},
    {"stiffness_amplitude", nullptr, &Gains<double>::stiffness_amplitude, false},
    {"stiffness_frequency", nullptr, &Gains<double>::stiffness_frequency, false},
    {"tank_energy", nullptr, &Gains<double>::tank_energy, false},
    {"tank_low", nullptr, &Gains<double>::tank_low, false},
    {"tank_high", nullptr, &Gains<double>::tank_high, false},
    {"tank_capacity", nullptr, &Gains<double>::tank_capacity, false},
};

TEST_CASE(every_gain_goes_to_its_place_for_every_law) {
    for (const std::string& law : laws) {
        Params one = with_law(law), three = one;
        double next = 1;
        for (const Place& place : places) {
            const std::string key = std::string("controller.") + place.key;
            const std::initializer_list<double> spread = {next, next + 0.25, next + 0.5};
            if (place.axes) one.set(key, spread), three.set(key, spread);
            if (!place.axes || place.one_for_all) one.set(key, next);
            if (place.one_for_all) one.set(key + "[1]", std::nan("")).set(key + "[2]", std::nan(""));
            if (!place.axes) three.set(key, next);
            next += 1;
        }
        const Gains<double> of_one = controller_of(one).gains, of_three = controller_of(three).gains;
        next = 1;
        for (const Place& place : places) {
            const Vec3<double> spread(next, next + 0.25, next + 0.5), same(next, next, next);
            if (place.number) CHECK((of_one.*place.number == next), law << ": " << place.key);
            if (place.axes) {
                CHECK((of_three.*place.axes == spread), law << ": " << place.key);
                CHECK((of_one.*place.axes == (place.one_for_all ? same : spread)), law << ": " << place.key);
            }
            next += 1;
        }
    }
}

TEST_CASE(a_plane_has_a_normal_of_length_one) {
    const Params params = with_law("virtual_wall").set("controller.plane_normal", {-3, 0, 4});
    check_close(controller_of(params).gains.plane_normal, {-0.6, 0, 0.8}, 1e-16);
}

TEST_CASE(flags_are_as_they_were_set) {
    const Params pd = with_law("joint_pd"), tank = with_law("energy_tank"), plane = with_law("virtual_wall");
    CHECK(controller_of(pd).compensates_gravity);
    CHECK(!controller_of(Params(pd).set("controller.compensate_gravity", 0)).compensates_gravity);
    CHECK(controller_of(Params(tank).set("controller.compensate_gravity", 0)).compensates_gravity);
    CHECK(controller_of(tank).has_tank);
    CHECK(!controller_of(Params(tank).set("controller.tank", 0)).has_tank);
    CHECK(!controller_of(plane).controls_passivity);
    CHECK(controller_of(Params(plane).set("controller.passivity_control", 1)).controls_passivity);
    for (const char* law : {"computed_torque", "resolved_acceleration"}) {
        CHECK(!controller_of(with_law(law).set("controller.cancel_force", 0)).cancels_force);
        CHECK(controller_of(with_law(law).set("controller.cancel_force", 1)).cancels_force);
    }
    CHECK(controller_of(with_law("hybrid")).cancels_force);
    CHECK(!controller_of(with_law("hybrid")).ideal_cancellation);
    CHECK(controller_of(with_law("hybrid").set("controller.ideal_cancellation", 1)).ideal_cancellation);
}

TEST_CASE(every_law_has_its_own_gravity) {
    for (const std::string& law : laws) {
        const Params params = with_law(law).set("controller.gravity", 5).set("controller.model.link3.length", 0.7);
        const Setup setup = make_setup(params);
        CHECK(setup.plant.controller.model.gravity == Vec3<double>(0, 0, -5));
        CHECK(setup.plant.controller.model.link3.length == 0.7);
        CHECK(setup.plant.arm.gravity[2] == -9.80665);
        const Params oblique = Params(params).set("controller.gravity", {1, -2, 3});
        CHECK(controller_of(oblique).model.gravity == Vec3<double>(1, -2, 3));
        CHECK(!controller_of(oblique).model.gravity_is_vertical);
    }
    for (const char* type : {"none", "constant", "user"})
        CHECK(controller_of(with_law(type).set("controller.torque", {1, 2, 3})).model.gravity[2] == -9.80665);
}

TEST_CASE(joint_vectors_are_in_the_arms_convention) {
    Params slide = with_law("joint_pd").choose("reference.type", "point").set("reference.q", {0.1, 0.2, -0.4});
    Params simscape = Params(slide).choose("arm.convention", "simscape").set("reference.q", {0.1, -0.2, 0.4});
    simscape.set("initial.q", {0.4, -0.7, 0.9});
    CHECK(reference_of(slide).to == Vec3<double>(0.1, 0.2, -0.4));
    CHECK(reference_of(simscape).to == Vec3<double>(0.1, 0.2, -0.4));
    CHECK(reference_of(simscape).from == Vec3<double>(0.4, 0.7, -0.9));
    for (Params* params : {&slide, &simscape}) {
        params->choose("reference.type", "sinusoid").set("reference.q_amplitude", {0.1, 0.2, 0.3});
        params->choose("controller.type", "computed_torque");
    }
    CHECK(reference_of(slide).amplitude == Vec3<double>(0.1, 0.2, 0.3));
    CHECK(reference_of(simscape).amplitude == Vec3<double>(0.1, -0.2, -0.3));
    simscape.choose("controller.type", "constant").set("controller.torque", {1, 2, 3});
    CHECK(controller_of(simscape).torque == Vec3<double>(1, -2, -3));
}

// ---- the reference

TEST_CASE(a_law_holds_what_it_works_in) {
    const std::vector<std::string> in_joints = {"joint_pd", "computed_torque", "joint_stiffness"};
    for (const std::string& law : laws) {
        const Params params = with_law(law).set("controller.model.link2.length", 0.9);
        const Reference<double> wanted = reference_of(params);
        const bool is_in_joints = std::find(in_joints.begin(), in_joints.end(), law) != in_joints.end();
        CHECK(wanted.in_joints == is_in_joints, law);
        const Vec3<double> q(0.4, 0.7, -0.9);
        check_close(desired_motion_at(wanted, 0.37).position, is_in_joints ? q : tip_by_hand(q, 0.3, 0.9, 0.6), 1e-15);
    }
}

TEST_CASE(a_target_may_be_given_as_joint_angles_of_the_model) {
    const Vec3<double> q(-0.3, 0.5, -1.1);
    const Params params = with_law("stiffness").set("controller.model.link3.length", 0.5).set("reference.q", q);
    for (const char* path : {"point", "line", "minimum_jerk"})
        check_close(reference_of(Params(params).choose("reference.type", path)).to, tip_by_hand(q, 0.3, 0.8, 0.5),
                    1e-15);
}

TEST_CASE(a_joint_law_finds_the_angles_of_a_tip_on_the_branch_it_starts_on) {
    const Vec3<double> tip(0.5, -0.6, 0.7);
    const std::array<Vec3<double>, 4> starts = {
        {{0.4, 0.7, -0.9}, {0.4, -0.4, 0.9}, {2.7, 2.2, 0.9}, {-2.6, 3.4, -0.8}}};  // elbow up, down; the same behind
    Params params = with_law("computed_torque").set("controller.model.link2.length", 0.9);
    params.choose("reference.type", "line").set("reference.tip", tip);
    std::vector<Vec3<double>> found;
    for (const Vec3<double>& start : starts) {
        const Vec3<double> q = reference_of(params.set("initial.q", start)).to;
        check_close(tip_by_hand(q, 0.3, 0.9, 0.6), tip, 1e-15);
        const auto side = [](const Vec3<double>& of) { return 0.9 * std::cos(of[1]) + 0.6 * std::cos(of[1] + of[2]); };
        CHECK((side(q) > 0) == (side(start) > 0));
        CHECK((std::sin(q[2]) > 0) == (std::sin(start[2]) > 0));
        for (int i = 0; i < 3; ++i) CHECK(std::abs(q[i] - start[i]) <= M_PI);
        for (const Vec3<double>& other : found) CHECK(distance(q, other) > 0.1);
        found.push_back(q);
        const Vec3<double> turns(2 * M_PI, -4 * M_PI, 6 * M_PI);
        check_close(reference_of(params.set("initial.q", Vec3<double>(start + turns))).to, q + turns, 1e-14);
    }
}

TEST_CASE(a_line_leads_from_the_start_to_the_target_in_its_time) {
    Params params = with_law("hybrid").choose("reference.type", "line").set("reference.tip", {0.6, 0.3, 0.8});
    params.set("reference.start", 0.5).set("reference.duration", 2);
    const Reference<double> wanted = reference_of(params);
    const Vec3<double> start = tip_by_hand({0.4, 0.7, -0.9}, 0.3, 0.8, 0.6), end(0.6, 0.3, 0.8);
    check_close(desired_motion_at(wanted, 0.4).position, start, 1e-15);
    check_close(desired_motion_at(wanted, 1.0).position, 0.75 * start + 0.25 * end, 1e-15);
    check_close(desired_motion_at(wanted, 2.6).position, end, 1e-15);
}

TEST_CASE(a_circle_lies_on_the_face_and_turns_about_the_pressing_direction) {
    Params params = with_law("resolved_acceleration").choose("reference.type", "circle");
    params.set("wall.normal", {-2, 1, 0.5}).set("wall.point", {3, 0, 0}).set("reference.radius", 0.07);
    params.set("reference.period", 3).set("reference.turns", 1.5).set("reference.start", 0.2);
    const Reference<double> wanted = reference_of(params);
    const Vec3<double> n = Vec3<double>(-2, 1, 0.5).normalized(), start = desired_motion_at(wanted, 0.0).position;
    check_close(start, tip_by_hand({0.4, 0.7, -0.9}, 0.3, 0.8, 0.6), 1e-15);
    const Vec3<double> centre = 0.5 * (start + desired_motion_at(wanted, 4.7).position);  // half a turn on
    CHECK(std::abs((start - centre).norm() - 0.07) < 1e-15);
    for (const double t : {0.5, 1.1, 2.3, 3.9}) {
        const DesiredMotion<double> at = desired_motion_at(wanted, t);
        const Vec3<double> out = at.position - centre;
        CHECK(std::abs(out.norm() - 0.07) < 1e-15);
        CHECK(std::abs(n.dot(out)) < 1e-15);
        CHECK(cross_product(out, at.velocity).dot(-n) > 0);
    }
    check_close(desired_motion_at(wanted, 0.2 + 2.25).position - centre, -(start - centre),
                0.15);  // half way: 3/4 of a turn
    CHECK(desired_motion_at(wanted, 4.71).velocity.norm() == 0);
}

TEST_CASE(without_a_wall_a_circle_lies_across_the_x_axis) {
    Params params =
        with_law("stiffness").set("wall", 0).choose("reference.type", "circle").set("wall.normal", {0, 1, 1});
    const Reference<double> wanted = reference_of(params.set("reference.radius", 0.05));
    const Vec3<double> start = wanted.from;
    for (const double t : {0.5, 1.0, 2.0}) CHECK(desired_motion_at(wanted, t).position[0] == start[0]);
    check_close(desired_motion_at(wanted, 2.0).position, start - Vec3<double>(0, 0.1, 0), 1e-15);
}

TEST_CASE(a_tip_swings_about_its_start) {
    Params params = with_law("impedance").choose("reference.type", "sinusoid").set("reference.frequency", 2);
    params.set("reference.tip_amplitude", {0.01, -0.02, 0.03}).set("reference.start", 1);
    const Reference<double> wanted = reference_of(params);
    check_close(desired_motion_at(wanted, 0.9).position, wanted.from, 0);
    check_close(desired_motion_at(wanted, 1.125).position, wanted.from + Vec3<double>(0.01, -0.02, 0.03), 1e-15);
}

// scipy.interpolate.make_interp_spline(t, s, k=5), first and second derivative 0 at both ends, and its derivatives.
TEST_CASE(a_table_is_followed_as_smoothly_as_scipy_would) {
    const Reference<double> wanted = reference_of(along_a_table());
    const auto check = [&](double t, const Vec3<double>& x, const Vec3<double>& v, const Vec3<double>& a) {
        const DesiredMotion<double> at = desired_motion_at(wanted, t);
        check_close(at.position, x, 1e-13);
        check_close(at.velocity, v, 1e-12);
        check_close(at.acceleration, a, 1e-11);
    };
    check(0.8, {0.03529844578534707, -0.5, 1.0337591498426446}, {-1.0800058109290351, 0, 0.24849885136325048},
          {-0.5932726599735383, 0, 0.5902824766082753});
    check(2.0, {-0.018631113938164686, -0.5, 0.7519983401088018}, {-2.7474165555795254, 0, -0.38534222020803705},
          {-1.7239823147086206, 0, 1.0099678781564854});
    check(3.2, {1.2682575093584536, -0.5, 0.9969419207039056}, {0.88215711354884, 0, 0.08562445713528222},
          {-14.930361177913113, 0, -1.4753233223185092});
    check(0.3, {0.2, -0.5, 1}, {0, 0, 0}, {0, 0, 0});
    check(0.5, {0.2, -0.5, 1}, {0, 0, 0}, {0, 0, 0});
    check(3.3, {1.3, -0.5, 1}, {0, 0, 0}, {0, 0, 0});
    check(9.0, {1.3, -0.5, 1}, {0, 0, 0}, {0, 0, 0});
}

TEST_CASE(a_table_of_two_points_is_a_minimum_jerk_motion) {
    Params params = with_law("hybrid").choose("reference.type", "table");
    const Vec3<double> from = tip_by_hand({0.4, 0.7, -0.9}, 0.3, 0.8, 0.6), to(0.6, 0.3, 0.8);
    params.set("reference.t[0]", 0.5).set("reference.t[1]", 2.5);
    for (int i = 0; i < 3; ++i) {
        const std::string column = std::string("reference.") + "xyz"[i];
        params.set(column + "[0]", from[i]).set(column + "[1]", to[i]);
    }
    const Reference<double> table = reference_of(params);
    params.choose("reference.type", "minimum_jerk").set("reference.tip", to);
    const Reference<double> motion = reference_of(params.set("reference.start", 0.5).set("reference.duration", 2));
    for (const double t : {0.0, 0.7, 1.5, 2.2, 4.0}) {
        check_close(desired_motion_at(table, t).position, desired_motion_at(motion, t).position, 1e-15);
        check_close(desired_motion_at(table, t).velocity, desired_motion_at(motion, t).velocity, 1e-15);
        check_close(desired_motion_at(table, t).acceleration, desired_motion_at(motion, t).acceleration, 1e-14);
    }
}

TEST_CASE(every_lane_follows_its_own_table) {
    const std::array<Controller<double>, 2> alone = {
        controller_of(along_a_table()),
        controller_of(along_a_table().set("reference.t[2]", 1.9).set("reference.z[3]", 0.7))};
    Controller<Pack<2>> both;
    for (int lane = 0; lane < 2; ++lane) {
        copy_controller_choices(alone[lane], both);
        each_law_number([lane](Pack<2>& all, const double& one) { all.set(lane, one); }, both, alone[lane]);
    }
    for (const double t : {0.2, 0.9, 1.5, 2.5, 5.0}) {
        const DesiredMotion<Pack<2>> wanted = desired_motion_at(both.reference, Pack<2>(t));
        for (int lane = 0; lane < 2; ++lane)
            for (int i = 0; i < 3; ++i) {
                const DesiredMotion<double> one = desired_motion_at(alone[lane].reference, t);
                CHECK(same_bits(wanted.position[i][lane], one.position[i]));
                CHECK(same_bits(wanted.acceleration[i][lane], one.acceleration[i]));
            }
    }
}

TEST_CASE(the_force_is_as_wanted) {
    Params params = with_law("hybrid").set("reference.force.value", 30).set("reference.force.initial", 10);
    params.set("reference.force.start", 2).set("reference.force.duration", 4);
    params.set("reference.force.amplitude", 3).set("reference.force.frequency", 0.5);
    const auto force = [&](const char* type, double t) {
        return desired_force_at(reference_of(Params(params).choose("reference.force.type", type)), t);
    };
    CHECK(force("constant", 0.0) == 30);
    CHECK(force("step", 1.99) == 10);
    CHECK(force("step", 2.01) == 30);
    CHECK(force("ramp", 3.0) == 15);
    CHECK(force("ramp", 7.0) == 30);
    CHECK(std::abs(force("sinusoid", 0.5) - 33) < 1e-14);
}

// ---- what stands between arm and controller

TEST_CASE(sections_that_are_absent_are_off) {
    const Setup setup = make_setup(with_law("hybrid"));
    CHECK((!setup.digital.sampling.on && !setup.observes() && !setup.estimation.on && !setup.plant.external_force.on));
    CHECK((static_cast<const SensorChoices&>(setup.plant.sensors) == SensorChoices{}));
    CHECK((static_cast<const SensorChoices&>(setup.digital.sensors) == SensorChoices{}));
    CHECK((setup.plant.controller.type == ControllerType::hybrid));
}

TEST_CASE(a_digital_controller_gives_the_plant_a_torque) {
    const Params params = with_law("hybrid").set("sampling", 1).set("observer", 1).set("controller.gravity", 5);
    const Setup setup = make_setup(params);
    CHECK((setup.plant.controller.type == ControllerType::none));
    CHECK(setup.plant.holds_torque);
    CHECK(setup.plant.held_torque == Vec3<double>(0, 0, 0));
    CHECK(setup.plant.controller.model.gravity[2] == -9.80665);
    CHECK(!setup.plant.observer.on);
    CHECK((setup.digital.controller.type == ControllerType::hybrid));
    CHECK(setup.digital.controller.model.gravity[2] == -5);
    CHECK(setup.digital.observer.on);
    CHECK(make_setup(with_law("hybrid").set("observer", 1)).plant.observer.on);
}

TEST_CASE(sampling_and_sensors_are_as_they_were_described) {
    Params params = with_law("hybrid").set("sampling", 1).set("sampling.rate", 250).set("sampling.delay", 1.5);
    params.set("sampling.seed", 9007199254740991).set("sensors", 1).set("sensors.encoder.counts", 4096);
    params.choose("sensors.velocity.estimate", "filtered").set("sensors.velocity.cutoff", 40);
    params.set("sensors.force.noise", 0.1).set("sensors.force.bias", {1, 2, 3}).set("sensors.force.resolution", 0.25);
    params.set("sensors.force.cutoff", 60).set("sensors.force.delay", 2.5).set("sensors.force.tool_mass", 0.3);
    const Setup setup = make_setup(params);
    const Sampling<double>& sampling = setup.digital.sampling;
    CHECK((sampling.on && sampling.has_delay));
    CHECK(sampling.period == 0.004);
    CHECK(sampling.delay == 1.5);
    CHECK(sampling.seed == 9007199254740991);
    const Sensors<double>& sensors = setup.digital.sensors;
    CHECK((sensors.has_encoder && sensors.has_noise && sensors.has_bias && sensors.has_resolution));
    CHECK((sensors.has_filter && sensors.has_delay && sensors.has_tool && !sensors.has_analog_filter));
    CHECK(sensors.encoder_step == 0.0015339807878856412);                  // 2 pi/4096
    CHECK(std::abs(sensors.velocity_share - 0.6340686930587067) < 1e-15);  // 1 - exp(-2 pi 40 0.004)
    CHECK(sensors.noise == 0.1);
    CHECK(sensors.bias == Vec3<double>(1, 2, 3));
    CHECK(sensors.resolution == 0.25);
    CHECK(std::abs(sensors.force_share - 0.7786398960093938) < 1e-15);  // 1 - exp(-2 pi 60 0.004)
    CHECK(sensors.force_delay == 2.5);
    CHECK(sensors.tool_mass == 0.3);
    CHECK(!make_setup(params.set("sensors.encoder.counts", 0)).digital.sensors.has_encoder);
    const Sensors<double> filtered = make_setup(params.set("sensors.force.analog_cutoff", 80)).plant.sensors;
    CHECK(filtered.has_analog_filter);
    CHECK(std::abs(filtered.analog_rate - 502.6548245743669) < 1e-12);  // 2 pi 80
}

TEST_CASE(observer_estimator_and_push_are_as_they_were_described) {
    Params params = with_law("hybrid").set("observer", 1).set("estimator", 1).set("push", 1);
    params.set("observer.gain", {50, 60, 70}).set("observer.threshold", 0.4).set("observer.hold", 0.1);
    params.set("observer.reflex_gain", 3).set("observer.retreat_gain", 4);
    params.set("observer.joint_stiffness", {5, 6, 7}).set("observer.joint_damping", {8, 9, 10});
    params.set("estimator.rate", 200).set("estimator.forgetting", 0.9).set("estimator.start", 2);
    params.set("estimator.largest_condition", 1e6).choose("estimator.wall", "fixed");
    params.set("push.force", {-1, 2, -3}).set("push.start", 0.5).set("push.rise", 0.25).set("push.duration", 4);
    const Setup setup = make_setup(params);
    const Observer<double>& observer = setup.plant.observer;
    CHECK((observer.on && setup.estimation.on && setup.plant.external_force.on));
    CHECK(observer.gain == Vec3<double>(50, 60, 70));
    CHECK(observer.threshold == Vec3<double>(0.4, 0.4, 0.4));
    CHECK(observer.hold == 0.1);
    CHECK(observer.reflex_gain == 3);
    CHECK(observer.retreat_gain == 4);
    CHECK(observer.joint_stiffness == Vec3<double>(5, 6, 7));
    CHECK(observer.joint_damping == Vec3<double>(8, 9, 10));
    const Estimation<double>& estimation = setup.estimation;
    CHECK(estimation.period == 0.005);
    CHECK(estimation.forgetting == 0.9);
    CHECK(estimation.start == 2);
    CHECK(estimation.max_condition == 1e6);
    CHECK(!estimation.wall_moves);
    CHECK(make_setup(params.choose("estimator.wall", "moving")).estimation.wall_moves);
    const ExternalForce<double>& external_force = setup.plant.external_force;
    CHECK(external_force.force == Vec3<double>(-1, 2, -3));
    CHECK(external_force.start == 0.5);
    CHECK(external_force.rise == 0.25);
    CHECK(external_force.end == 4.5);
}

// ---- limits of loops

static double max_real_part(const Eigen::MatrixXd& A) { return eigenvalues(A).real().maxCoeff(); }

// The value of c[n] s^n + ... + c[0].
static Eigen::MatrixXd companion(const std::vector<double>& c) {
    const auto n = Eigen::Index(c.size()) - 1;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i) A(0, i) = -c[std::size_t(n - 1 - i)] / c.back();
    for (Eigen::Index i = 1; i < n; ++i) A(i, i - 1) = 1;
    return A;
}

TEST_CASE(a_cubic_is_stable_where_all_its_roots_decay) {
    Random random(71);
    int stable = 0;
    for (int i = 0; i < 500; ++i) {
        const double m = random.in(0.1, 3), b = random.in(0.1, 3), c = random.in(0.1, 3), d = random.in(0.1, 6);
        const bool decays = max_real_part(companion({d, c, b, m})) < 0;
        CHECK(is_stable(m, b, c, d) == decays);
        stable += decays;
    }
    CHECK((stable > 100 && stable < 400));
    CHECK(is_stable(1, 2, 3, 0));
    CHECK((!is_stable(1, 0, 3, 0) && !is_stable(1, 2, 0, 0)));
}

TEST_CASE(an_admittance_bears_a_wall_up_to_where_its_roots_cross) {
    Random random(72);
    CHECK(std::abs(admittance_limit(2, 40, 200, 50, 1) - 1440) < 1e-9);
    for (int i = 0; i < 100; ++i) {
        const double M = random.in(0.5, 4), B = random.in(5, 80), K = random.in(50, 500);
        const double w = random.in(20, 80), z = random.in(0.4, 1.5);
        const double limit = admittance_limit(M, B, K, w, z);
        const auto growth = [&](double k_e) {
            return max_real_part(companion(
                {(K + k_e) * w * w, 2 * z * w * K + w * w * B, K + 2 * z * w * B + w * w * M, B + 2 * z * w * M, M}));
        };
        CHECK(growth(limit - 0.001 * (limit + K)) < 0);
        CHECK(growth(limit + 0.001 * (limit + K)) > 0);
    }
}

TEST_CASE(a_reference_may_be_moved_by_the_force_error_up_to_where_its_roots_cross) {
    Random random(73);
    CHECK(std::abs(reference_gain_limit(2, 80, 200, 5000) - 0.208) < 1e-15);
    for (int i = 0; i < 100; ++i) {
        const double M = random.in(0.5, 4), B = random.in(5, 80), K = random.in(50, 500), k_e = random.in(100, 9000);
        const double limit = reference_gain_limit(M, B, K, k_e);
        const auto growth = [&](double k_r) { return max_real_part(companion({K * k_r * k_e, K + k_e, B, M})); };
        CHECK(growth(0.999 * limit) < 0);
        CHECK(growth(1.001 * limit) > 0);
    }
}

// e'' = a, with a = -Kp e - Kd e' held for a period: the exact map of one period.
static double growth_of_held_acceleration(double Kp, double Kd, double T) {
    Eigen::MatrixXd A(2, 2);
    A << 1 - Kp * T * T / 2, T - Kd * T * T / 2, -Kp * T, 1 - Kd * T;
    return eigenvalues(A).cwiseAbs().maxCoeff();
}

TEST_CASE(a_held_acceleration_is_stable_up_to_the_longest_period) {
    Random random(74);
    CHECK(std::abs(max_period(400, 40) - 0.05) < 1e-15);
    CHECK(std::abs(max_period(400, 20) - 0.1) < 1e-15);
    CHECK(std::abs(max_period(400, 12) - 0.06) < 1e-15);
    CHECK(max_period(0, 10) == 0.2);
    for (int i = 0; i < 100; ++i) {
        const double Kp = random.in(10, 1000), Kd = random.in(1, 100), T = max_period(Kp, Kd);
        CHECK(growth_of_held_acceleration(Kp, Kd, 0.999 * T) < 1);
        CHECK(growth_of_held_acceleration(Kp, Kd, 1.001 * T) > 1);
    }
}

TEST_CASE(projected_mobility_is_an_eigenvalue_of_the_oblique_projector) {
    Random random(75);
    int negative = 0;
    for (int i = 0; i < 400; ++i) {
        const Arm<double> arm = random_params(random).arm();
        const Vec3<double> q = random.vector(-2.5, 2.5), n = random.vector(-1, 1).normalized();
        const Pose<double> p = pose(q);
        if (manipulability(arm, p) < 0.02) continue;
        const Eigen::Matrix3d J = jacobian(arm, p), M = mass_matrix(arm, p);
        const Eigen::Matrix3d S_p = Eigen::Matrix3d::Identity() - n * n.transpose();
        const Eigen::Matrix3d loop = inverse(M) * inverse(J) * S_p * J;
        const Eigen::Vector3d parts = eigenvalues(loop).real();
        std::vector<double> sorted(parts.data(), parts.data() + 3);
        std::sort(sorted.begin(), sorted.end(), [](double a, double b) { return std::abs(a) > std::abs(b); });
        const double least = std::min(sorted[0], sorted[1]), size = std::abs(sorted[0]);
        CHECK(std::abs(projected_mobility(arm, p, n) - least) <= 1e-9 * size);
        negative += least < -1e-6 * size;
    }
    CHECK(negative > 5);
}

// ---- any numbers

TEST_CASE(a_setup_is_made_of_whatever_the_rules_let_through) {
    Random random(76);
    for (const std::string& law : laws)
        for (int i = 0; i < 40; ++i) {
            Params params = with_law(law).set("sampling", i % 2).set("observer", i % 3 == 0);
            for (const Key& key : schema())
                if (key.path.starts_with("reference.") && key.kind == Kind::choice)
                    params.set(key.path, std::floor(random.in(0, double(key.choices.size()))));
            params.set("reference.tip", random.vector(-2, 2)).set("reference.q_amplitude", random.vector(-1, 1));
            if (!problems_of(params).empty()) continue;
            const Reference<double> wanted = reference_of(params);
            for (const double t : {0.0, 0.3, 1.0, 7.0}) {
                CHECK(desired_motion_at(wanted, t).position.allFinite());
                CHECK(desired_motion_at(wanted, t).acceleration.allFinite());
                CHECK(std::isfinite(desired_force_at(wanted, t)));
            }
        }
}

TEST_SUITE_END()

}  // namespace arm3r

// The rules between the keys of a controller, its reference, and the arm and wall it works with.

#include "base/number_text.hpp"
#include "setup/make_controller.hpp"
#include "setup/make_reference.hpp"
#include "validate/rules.hpp"

namespace arm3r {
namespace {

constexpr double min_sine = 1e-3;  // of the elbow angle, and of r/(a2 + a3), at the start of a law that inverts J

bool is_given(const Vec3<double>& v) { return !std::isnan(v[0]); }

std::string type_of(std::span<const double> params) { return choice_of(params, "controller.type"); }

// ---- the reference

// Exactly one of two keys with the same meaning must be given.
void need_one_of(const char* path, bool has_it, const char* other, bool has_other, const std::string& of,
                 ProblemList& problem_list) {
    if (has_it != has_other) return;
    problem_list.add([&] {
        return Problem{.code = has_it ? "scenario.conflict" : "scenario.missing_key",
                       .path = path,
                       .message = has_it ? std::string(other) + " says it already" : of + " needs a target",
                       .allowed = std::string("either ") + path + " or " + other,
                       .hint = has_it ? "take one of the two out" : "give one of the two"};
    });
}

void check_aim(std::span<const double> params, const std::string& reference, ProblemList& problem_list) {
    if (reference == "point" || reference == "line" || reference == "minimum_jerk")
        need_one_of("reference.tip", is_given(vector_at<"reference.tip">(params)), "reference.q",
                    is_given(vector_at<"reference.q">(params)), "reference.type " + reference, problem_list);
}

// A sinusoid is in the space of the law, joints or tip, and each of the two amplitudes belongs to one space.
void check_amplitude(std::span<const double> params, const std::string& reference, bool in_joints,
                     ProblemList& problem_list) {
    if (reference != "sinusoid") return;
    const char *right = "reference.tip_amplitude", *wrong = "reference.q_amplitude";
    if (in_joints) std::swap(right, wrong);
    const bool has_tip = is_given(vector_at<"reference.tip_amplitude">(params));
    const bool has_q = is_given(vector_at<"reference.q_amplitude">(params));
    const std::string space = in_joints ? "joint angles" : "positions of the tip";
    if (in_joints ? has_tip : has_q)
        problem_list.add([&] {
            return Problem{.code = "scenario.conflict",
                           .path = wrong,
                           .message = "controller.type " + type_of(params) + " works in " + space,
                           .allowed = right,
                           .hint = std::string("give ") + right + " in its place"};
        });
    else if (in_joints ? !has_q : !has_tip)
        problem_list.add([&] {
            return Problem{.code = "scenario.missing_key",
                           .path = right,
                           .message = "a sinusoid in " + space + " needs its amplitude",
                           .allowed = in_joints ? "a list of 3 numbers, rad" : "a list of 3 numbers, m"};
        });
}

void check_path_of_tip(std::span<const double> params, const std::string& reference, bool in_joints,
                       ProblemList& problem_list) {
    const bool is_of_tip = reference == "circle" || reference == "table";
    if (in_joints && is_of_tip)
        problem_list.add([&] {
            return Problem{.code = "scenario.conflict",
                           .path = "reference.type",
                           .message = "a " + reference + " is a path of the tip, and controller.type " +
                                      type_of(params) + " works in joint angles",
                           .got = reference,
                           .allowed = "hold, point, line, minimum_jerk or sinusoid",
                           .hint = "use controller.type resolved_acceleration or stiffness"};
        });
}

void check_target(std::span<const double> params, const Setup& setup, ProblemList& problem_list) {
    const Controller<double>& controller = setup.controller();
    const Vec3<double> tip = vector_at<"reference.tip">(params);
    const Path path = controller.reference.path;
    const bool is_aimed = path == Path::point || path == Path::line || path == Path::minimum_jerk;
    if (!controller.reference.in_joints || !is_aimed || !is_given(tip)) return;
    const Arm<double>& model = controller.model;
    const Vec3<double> from_base = minus(tip, base_position(model));
    const Vec3<double> x = model.is_elbow ? elbow_arm::to_base(model, from_base) : from_base;
    const double aside = hypot2(x[0], x[1]);
    if (std::abs(joints_at(model, tip, setup.q).cos_q3) > 1 + 1e-12)
        problem_list.add([&] {
            return Problem{.code = "scenario.out_of_reach",
                           .path = "reference.tip",
                           .message = "no joint angles bring the tip there",
                           .got = distance_from_reach(model, tip, radius(model, pose(setup.q)) >= 0),
                           .allowed = reach_text(model),
                           .hint = "move the target, or give reference.q"};
        });
    else if (aside < 1e-9 * reach(model))
        problem_list.add([&] {
            return Problem{.code = "scenario.singular",
                           .path = "reference.tip",
                           .message = "above or below joint 1 every angle of it brings the tip to the same place",
                           .got = shortest(aside) + " m from the axis of joint 1",
                           .allowed = "a target off that axis",
                           .hint = "give reference.q"};
        });
}

// ---- singular poses and the wall

void check_pose(std::span<const double> params, const Setup& setup, ProblemList& problem_list) {
    if (!inverts_jacobian(setup.controller())) return;
    const Arm<double>& model = setup.controller().model;
    const Pose<double> p = pose(setup.q);
    const double S3 = sine_of_bend(model, p), r = radius(model, p);
    const double min_r = min_sine * reach(model);
    const auto refuse = [&](const std::string& message, const std::string& got, const std::string& allowed) {
        problem_list.add([&] {
            return Problem{.code = "scenario.singular",
                           .path = "initial.q",
                           .message = "controller.type " + type_of(params) + " inverts the Jacobian, which is " +
                                      "singular where " + message,
                           .got = got,
                           .allowed = allowed,
                           .hint = "start from another pose, or use a law without an inverse, such as stiffness"};
        });
    };
    if (std::abs(S3) < min_sine)
        refuse("the elbow is straight or folded", std::string(bend_text(model)) + " = " + shortest(S3),
               "|" + std::string(bend_text(model)) + "| >= " + shortest(min_sine));
    if (std::abs(r) < min_r)
        refuse(tip_at_axis_text(model),
               shortest(std::abs(r)) + (model.is_elbow ? " m of the radius r" : " m from the axis"),
               "at least " + shortest(min_r) + " m");
}

void check_wall(std::span<const double> params, const Setup& setup, ProblemList& problem_list) {
    if (setup.plant.has_wall) return;
    const auto refuse = [&](const char* path, const std::string& who) {
        problem_list.add([&] {
            return Problem{.code = "scenario.needs_wall",
                           .path = path,
                           .message = who + ", and there is no wall",
                           .hint = "add a wall section; `wall: {}` is the lecture's"};
        });
    };
    if (tracks_force(setup.controller().type))
        refuse("controller.type", type_of(params) + " controls the force on a wall");
    if (setup.controller().type == ControllerType::admittance && setup.controller().reference.force != 0)
        refuse("reference.force.value", "this is a force on the wall");
    if (setup.estimation.on) refuse("estimator", "it estimates the stiffness of the wall");
}

// ---- gains

void check_order(const char* path, double low, const char* other, double high, bool may_be_equal, const char* unit,
                 ProblemList& problem_list) {
    if (may_be_equal ? low <= high : low < high) return;
    problem_list.add([&] {
        return Problem{.code = "scenario.order",
                       .path = path,
                       .message = std::string("must lie ") + (may_be_equal ? "not above " : "below ") + other,
                       .got = shortest(low) + " " + unit,
                       .allowed = (may_be_equal ? "at most " : "less than ") + shortest(high) + " " + unit};
    });
}

void check_levels(const Controller<double>& controller, ProblemList& problem_list) {
    const Gains<double>& gains = controller.gains;
    if (controller.type == ControllerType::energy_tank && controller.has_tank) {
        check_order("controller.tank_low", gains.tank_low, "controller.tank_high", gains.tank_high, false, "J",
                    problem_list);
        check_order("controller.tank_high", gains.tank_high, "controller.tank_capacity", gains.tank_capacity, true, "J",
                    problem_list);
        check_order("controller.tank_energy", gains.tank_energy, "controller.tank_capacity", gains.tank_capacity, true,
                    "J", problem_list);
    }
    if (tracks_force(controller.type) && controller.switching != Switching::always)
        check_order("controller.contact_off", gains.contact_off, "controller.contact_on", gains.contact_on, true, "N",
                    problem_list);
}

// An indirect reference is shifted until the spring presses with the desired force, which needs a stiffness in the
// direction of the force (7.18).
void check_compliance(const Setup& setup, ProblemList& problem_list) {
    const Controller<double>& law = setup.controller();
    if (law.type != ControllerType::adaptive_reference || law.adaptation != Adaptation::indirect) return;
    const Wall<double>& wall = setup.plant.wall;
    for (int i = 0; i < 3; ++i) {
        const bool presses = wall.rotation != Rotation::none || wall.n[i] != 0;
        if (!presses || law.gains.stiffness[i] > 0) continue;
        problem_list.add([&] {
            return Problem{.code = "scenario.needs_stiffness",
                           .path = "controller.stiffness",
                           .message =
                               "adaptation indirect shifts the reference until the spring presses on the wall, and "
                               "along " +
                               std::string(1, "xyz"[i]) + " there is no spring",
                           .got = shortest(law.gains.stiffness[i]) + " N/m along " + "xyz"[i],
                           .allowed = "above 0 along each axis of which the wall's normal has a part",
                           .hint = "give a stiffness, or take adaptation: integral"};
        });
        return;
    }
}

}  // namespace

void check_controller_keys(std::span<const double> params, ProblemList& problem_list) {
    const ControllerType type = controller_type_of(params);
    if (type == ControllerType::virtual_wall) check_direction<"controller.plane_normal">(params, problem_list);
    if (!tracks_path(type)) return;
    const std::string& reference = choice_of(params, "reference.type");
    check_aim(params, reference, problem_list);
    check_amplitude(params, reference, is_in_joints(type), problem_list);
    check_path_of_tip(params, reference, is_in_joints(type), problem_list);
    if (reference == "table")
        check_table<"reference.t", "reference.x", "reference.y", "reference.z">(
            params, "give all three coordinates at every instant", problem_list);
}

void check_controller(std::span<const double> params, const Setup& setup, ProblemList& problem_list) {
    check_wall(params, setup, problem_list);
    if (!has_law(setup.controller().type)) return;
    check_target(params, setup, problem_list);
    check_pose(params, setup, problem_list);
    check_levels(setup.controller(), problem_list);
    check_compliance(setup, problem_list);
}

}  // namespace arm3r

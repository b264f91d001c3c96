#include "setup/make_controller.hpp"

#include "setup/make_elbow.hpp"

namespace arm3r {
namespace {

template <Name path>
bool flag_at(std::span<const double> params) {
    return at<path>(params) != 0;
}

void set_choices(std::span<const double> params, Controller<double>& controller) {
    controller.variant = choice_at<"controller.variant", Variant>(params);
    controller.force_term = choice_at<"controller.force_term", ForceTerm>(params);
    controller.anti_windup = choice_at<"controller.anti_windup", AntiWindup>(params);
    controller.switching = choice_at<"controller.switching", Switching>(params);
    controller.inner = choice_at<"controller.inner", Inner>(params);
    controller.adaptation = choice_at<"controller.adaptation", Adaptation>(params);
    controller.compensates_gravity =
        controller.type != ControllerType::joint_pd || flag_at<"controller.compensate_gravity">(params);
    controller.cancels_force = !may_cancel_force(controller.type) || flag_at<"controller.cancel_force">(params);
    controller.ideal_cancellation = flag_at<"controller.ideal_cancellation">(params);
    controller.has_tank = flag_at<"controller.tank">(params);
    controller.controls_passivity = flag_at<"controller.passivity_control">(params);
}

void set_gains(std::span<const double> params, Gains<double>& gains) {
    each_gain([&]<Name path>(KeyOf<path>, double& gain) { gain = at<path>(params); },
              [&]<Name path>(KeyOf<path>, Vec3<double>& gain) { gain = each_axis<path>(params); }, gains);
    const Vec3<double> normal = gains.plane_normal;
    const double length = std::sqrt(dot(normal, normal));
    gains.plane_normal = {normal[0] / length, normal[1] / length, normal[2] / length};
}

}  // namespace

bool inverts_jacobian(const Controller<double>& controller) {
    switch (controller.type) {
        case ControllerType::resolved_acceleration:
        case ControllerType::shaped_impedance:
        case ControllerType::operational_space:
        case ControllerType::parallel:
        case ControllerType::adaptive_reference: return true;
        case ControllerType::impedance: return is_moving(controller.reference.path);
        case ControllerType::hybrid: return controller.variant != Variant::jacobian_transpose;
        case ControllerType::admittance: return controller.inner != Inner::joint_pd;
        default: return false;
    }
}

void set_controller(std::span<const double> params, Controller<double>& controller) {
    controller.type = controller_type_of(params);
    controller.algorithm = choice_at<"controller.algorithm", Algorithm>(params);
    controller.saturation = choice_at<"controller.saturation", Saturation>(params);
    controller.torque = {0, 0, 0};
    if (controller.type == ControllerType::constant)
        controller.torque = convention_of(params).flipped(vector_at<"controller.torque">(params));
    set_gains(params, controller.gains);  // of every type: a sampled controller without a law detects contact too
    if (has_law(controller.type)) set_choices(params, controller);
}

}  // namespace arm3r

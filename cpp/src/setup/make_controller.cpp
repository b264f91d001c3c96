#include "setup/make_controller.hpp"

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
    const bool may_leave_force =
        controller.type == ControllerType::computed_torque || controller.type == ControllerType::resolved_acceleration;
    controller.cancels_force = !may_leave_force || flag_at<"controller.cancel_force">(params);
    controller.ideal_cancellation = flag_at<"controller.ideal_cancellation">(params);
    controller.has_tank = flag_at<"controller.tank">(params);
    controller.controls_passivity = flag_at<"controller.passivity_control">(params);
}

void set_motion_gains(std::span<const double> params, Gains<double>& gains) {
    gains.joint_stiffness = vector_at<"controller.joint_stiffness">(params);
    gains.joint_damping = vector_at<"controller.joint_damping">(params);
    gains.position = each_axis<"controller.position_gain">(params);
    gains.velocity = each_axis<"controller.velocity_gain">(params);
    gains.mass = each_axis<"controller.mass">(params);
    gains.stiffness = each_axis<"controller.stiffness">(params);
    gains.damping = each_axis<"controller.damping">(params);
}

void set_force_gains(std::span<const double> params, Gains<double>& gains) {
    gains.force_mass = at<"controller.force_mass">(params);
    gains.force_damping = at<"controller.force_damping">(params);
    gains.force = at<"controller.force_gain">(params);
    gains.force_integral = at<"controller.force_integral_gain">(params);
    gains.integral_limit = at<"controller.integral_limit">(params);
    gains.tracking_time = at<"controller.tracking_time">(params);
    gains.contact_on = at<"controller.contact_on">(params);
    gains.contact_off = at<"controller.contact_off">(params);
}

void set_special_gains(std::span<const double> params, Gains<double>& gains) {
    gains.inner_bandwidth = at<"controller.inner_bandwidth">(params);
    gains.inner_damping_ratio = at<"controller.inner_damping_ratio">(params);
    gains.reference_gain = at<"controller.reference_gain">(params);
    gains.assumed_stiffness = at<"controller.assumed_stiffness">(params);
    gains.stiffness_amplitude = at<"controller.stiffness_amplitude">(params);
    gains.stiffness_frequency = at<"controller.stiffness_frequency">(params);
    gains.tank_energy = at<"controller.tank_energy">(params);
    gains.tank_low = at<"controller.tank_low">(params);
    gains.tank_high = at<"controller.tank_high">(params);
    gains.tank_capacity = at<"controller.tank_capacity">(params);
    gains.plane_point = vector_at<"controller.plane_point">(params);
    const Vec3<double> normal = vector_at<"controller.plane_normal">(params);
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
        controller.torque = to_slide(params, vector_at<"controller.torque">(params));
    set_force_gains(params, controller.gains);  // a sampled controller of any type detects contact
    if (!has_law(controller.type)) return;
    set_choices(params, controller);
    set_motion_gains(params, controller.gains);
    set_special_gains(params, controller.gains);
}

}  // namespace arm3r

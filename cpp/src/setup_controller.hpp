#pragma once
// The parts of make_setup() (setup.hpp) that concern the controller and what stands between it and the arm.

#include <cmath>

#include "arm3r/plant.hpp"
#include "at.hpp"
#include "setup.hpp"

namespace arm3r {

inline bool is_simscape(std::span<const double> params) { return is<"arm.convention", "simscape">(params); }

// A joint vector as it stands in the file, in the slide convention.
inline Vec3<double> to_slide(std::span<const double> params, const Vec3<double>& joint_vector) {
    return is_simscape(params) ? flipped(joint_vector) : joint_vector;
}

// The word that a choice stands at; the enumerators are in the order of the schema's words.
template <Name path, class Enum>
Enum choice_at(std::span<const double> params) {
    return static_cast<Enum>(static_cast<int>(at<path>(params)));
}

// One number stands for all three axes or joints.
template <Name path>
Vec3<double> each_axis(std::span<const double> params) {
    const Vec3<double> given = vector_at<path>(params);
    return std::isnan(given[1]) ? Vec3<double>(given[0], given[0], given[0]) : given;
}

inline Controls controls_of(std::span<const double> params) { return choice_at<"controller.type", Controls>(params); }

// Whether the law believes something of the arm: it has a copy of it, and a gravity.
constexpr bool has_model(Controls type) { return type >= Controls::gravity_compensation && type != Controls::user; }

// Whether what the law wants is told in joint angles, else in positions of the tip.
constexpr bool is_in_joints(Controls type) {
    return type == Controls::joint_pd || type == Controls::computed_torque || type == Controls::joint_stiffness;
}

// Whether the law divides by what vanishes in a singular pose.
bool inverts_jacobian(const Controller<double>& controller);

// All but the model and the setpoint.
void set_controller(std::span<const double> params, Controller<double>& controller);

// What the controller of `setup` wants; its model, the wall and the start must be there.
void set_setpoint(std::span<const double> params, const Setup& setup, Setpoint<double>& wanted);

// The joint angles that bring the tip of `arm` to a point (m, base axes): those of the branch that the pose `near` is of, in
// the turn next to it. Meaningless where |cos_q3| > 1.
Reach<double> joints_at(const Arm<double>& arm, const Vec3<double>& tip, const Vec3<double>& near);

Sampling<double> make_sampling(std::span<const double> params);
Sensors<double> make_sensors(std::span<const double> params);
Observer<double> make_observer(std::span<const double> params);
Estimation<double> make_estimation(std::span<const double> params);
TipLoad<double> make_load(std::span<const double> params);

}  // namespace arm3r

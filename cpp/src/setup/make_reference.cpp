#include <cmath>
#include <numbers>

#include "base/spline.hpp"
#include "setup/make_controller.hpp"
#include "setup/make_reference.hpp"

namespace arm3r {
namespace {

// The angle, whole turns added, that is next to another.
double next_to(double near, double angle) {
    constexpr double turn = 2 * std::numbers::pi;
    return angle + turn * nearest_integer((near - angle) / turn);
}

Vec3<double> tip_of(const Arm<double>& arm, const Vec3<double>& q) { return tip_position(arm, pose(q)); }

// reference.tip or reference.q, whichever is given, in the space in which the law works.
Vec3<double> target_of(std::span<const double> params, const Arm<double>& model, const Vec3<double>& start_q,
                       bool in_joints) {
    const Vec3<double> tip = vector_at<"reference.tip">(params);
    if (!std::isnan(tip[0])) return in_joints ? joints_at(model, tip, start_q).q : tip;
    const Vec3<double> q = to_slide(params, vector_at<"reference.q">(params));
    return in_joints ? q : tip_of(model, q);
}

// On the wall's face, or across the x axis where there is no wall: turning from e1 to e2, about the pressing direction.
void set_circle(std::span<const double> params, const Setup& setup, Setpoint<double>& wanted) {
    const double radius = at<"reference.radius">(params);
    const Vec3<double> e1 = setup.plant.has_wall ? setup.plant.wall.e1 : Vec3<double>(0, 1, 0);
    const Vec3<double> e2 = setup.plant.has_wall ? setup.plant.wall.e2 : Vec3<double>(0, 0, 1);
    wanted.across1 = {radius * e1[0], radius * e1[1], radius * e1[2]};
    wanted.across2 = {radius * e2[0], radius * e2[1], radius * e2[2]};
    wanted.turns = at<"reference.turns">(params);
    wanted.duration = at<"reference.period">(params) * wanted.turns;
}

void set_sinusoid(std::span<const double> params, Setpoint<double>& wanted) {
    wanted.amplitude = wanted.in_joints ? to_slide(params, vector_at<"reference.q_amplitude">(params))
                                        : vector_at<"reference.tip_amplitude">(params);
    wanted.frequency = at<"reference.frequency">(params);
}

template <Name column>
void set_curve(std::span<const double> params, int knots, Table<double>& curve) {
    const auto count = static_cast<std::size_t>(knots);
    for (std::size_t i = 0; i < count; ++i) {
        curve.t[i] = at<"reference.t">(params, i);
        curve.s[i] = at<column>(params, i);
    }
    curve.knots = knots;
    minimum_jerk_through({curve.t.data(), count}, {curve.s.data(), count}, {curve.v.data(), count},
                         {curve.a.data(), count});
}

void set_table(std::span<const double> params, Setpoint<double>& wanted) {
    while (wanted.knots < most_knots && !std::isnan(at<"reference.t">(params, std::size_t(wanted.knots))))
        ++wanted.knots;
    wanted.table = std::make_shared<std::array<Table<double>, 3>>();
    auto& [x, y, z] = *wanted.table;
    set_curve<"reference.x">(params, wanted.knots, x);
    set_curve<"reference.y">(params, wanted.knots, y);
    set_curve<"reference.z">(params, wanted.knots, z);
    wanted.start = x.t[0];
    wanted.duration = x.t[std::size_t(wanted.knots) - 1] - wanted.start;
}

void set_pressing(std::span<const double> params, Setpoint<double>& wanted) {
    wanted.pressing = choice_at<"reference.force.type", Pressing>(params);
    wanted.force = at<"reference.force.value">(params);
    wanted.force_before = at<"reference.force.initial">(params);
    wanted.force_start = at<"reference.force.start">(params);
    wanted.force_duration = at<"reference.force.duration">(params);
    wanted.force_amplitude = at<"reference.force.amplitude">(params);
    wanted.force_frequency = at<"reference.force.frequency">(params);
}

bool is_aimed(Path path) { return path == Path::point || path == Path::line || path == Path::minimum_jerk; }

}  // namespace

Reach<double> joints_at(const Arm<double>& arm, const Vec3<double>& tip, const Vec3<double>& near) {
    const Pose<double> p = pose(near);
    const double S3 = sin_q3(p);
    const bool front = radius(arm, p) >= 0;
    Reach<double> reach = inverse_kinematics(arm, tip, front, front == (S3 <= 0));
    for (int i = 0; i < 3; ++i) reach.q[i] = next_to(near[i], reach.q[i]);
    return reach;
}

void set_setpoint(std::span<const double> params, const Setup& setup, Setpoint<double>& wanted) {
    const Controller<double>& controller = setup.plant.controller;
    wanted.in_joints = is_in_joints(controller.type);
    wanted.from = wanted.in_joints ? setup.q : tip_of(controller.model, setup.q);
    wanted.to = wanted.from;
    wanted.across1 = wanted.across2 = wanted.amplitude = {0, 0, 0};
    wanted.turns = wanted.frequency = 0;
    wanted.path = wants_path(controller.type) ? choice_at<"reference.type", Path>(params) : Path::hold;
    wanted.start = at<"reference.start">(params);
    wanted.duration = at<"reference.duration">(params);
    if (is_aimed(wanted.path)) wanted.to = target_of(params, controller.model, setup.q, wanted.in_joints);
    if (wanted.path == Path::circle) set_circle(params, setup, wanted);
    if (wanted.path == Path::sinusoid) set_sinusoid(params, wanted);
    if (wanted.path == Path::table) set_table(params, wanted);
    wanted.end = wanted.start + wanted.duration;
    set_pressing(params, wanted);
}

}  // namespace arm3r

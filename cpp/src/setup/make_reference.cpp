#include <cmath>
#include <numbers>

#include "base/spline.hpp"
#include "setup/make_controller.hpp"
#include "setup/make_elbow.hpp"
#include "setup/make_reference.hpp"

namespace arm3r {
namespace {

// The angle plus whole turns that is nearest to another.
double next_to(double near, double angle) {
    constexpr double turn = 2 * std::numbers::pi;
    return angle + turn * nearest_integer((near - angle) / turn);
}

Vec3<double> tip_of(const Arm<double>& arm, const Vec3<double>& q) { return tip_position(arm, pose(q)); }

// reference.tip or reference.q, whichever is given, in the space of the law.
Vec3<double> target_of(std::span<const double> params, const Arm<double>& model, const Vec3<double>& start_q,
                       bool in_joints) {
    const Vec3<double> tip = vector_at<"reference.tip">(params);
    if (!std::isnan(tip[0])) return in_joints ? joints_at(model, tip, start_q).q : tip;
    const Vec3<double> q = convention_of(params).to_slide(vector_at<"reference.q">(params));
    return in_joints ? q : tip_of(model, q);
}

// On the wall's face, or across the x axis where there is no wall: turning from e1 to e2, about the pressing direction.
void set_circle(std::span<const double> params, const Setup& setup, Reference<double>& reference) {
    const double radius = at<"reference.radius">(params);
    const Vec3<double> e1 = setup.plant.has_wall ? setup.plant.wall.e1 : Vec3<double>(0, 1, 0);
    const Vec3<double> e2 = setup.plant.has_wall ? setup.plant.wall.e2 : Vec3<double>(0, 0, 1);
    reference.across1 = {radius * e1[0], radius * e1[1], radius * e1[2]};
    reference.across2 = {radius * e2[0], radius * e2[1], radius * e2[2]};
    reference.turns = at<"reference.turns">(params);
    reference.duration = at<"reference.period">(params) * reference.turns;
}

void set_sinusoid(std::span<const double> params, const Setup& setup, Reference<double>& reference) {
    reference.amplitude = reference.in_joints ? setup.convention.flipped(vector_at<"reference.q_amplitude">(params))
                                              : vector_at<"reference.tip_amplitude">(params);
    reference.frequency = at<"reference.frequency">(params);
}

template <Name column>
QuinticTable<double> curve_of(std::span<const double> params) {
    const std::span<const double> t = list_at<"reference.t">(params), s = list_at<column>(params);
    QuinticTable<double> curve{{t.begin(), t.end()}, {s.begin(), s.end()}, {}, {}};
    move_with_minimum_jerk(curve);
    return curve;
}

void set_table(std::span<const double> params, Reference<double>& reference) {
    reference.table = std::make_shared<std::array<QuinticTable<double>, 3>>(
        std::array{curve_of<"reference.x">(params), curve_of<"reference.y">(params), curve_of<"reference.z">(params)});
    const AlignedVector<double>& t = (*reference.table)[0].t;
    reference.knots = static_cast<int>(t.size());
    reference.start = t.front();
    reference.duration = t.back() - t.front();
}

void set_force_profile(std::span<const double> params, Reference<double>& reference) {
    reference.force_profile = choice_at<"reference.force.type", ForceProfile>(params);
    reference.force = at<"reference.force.value">(params);
    reference.force_before = at<"reference.force.initial">(params);
    reference.force_start = at<"reference.force.start">(params);
    reference.force_duration = at<"reference.force.duration">(params);
    reference.force_amplitude = at<"reference.force.amplitude">(params);
    reference.force_frequency = at<"reference.force.frequency">(params);
}

bool is_aimed(Path path) { return path == Path::point || path == Path::line || path == Path::minimum_jerk; }

}  // namespace

IkResult<double> joints_at(const Arm<double>& arm, const Vec3<double>& tip, const Vec3<double>& near) {
    const Pose<double> p = pose(near);
    IkResult<double> solution = inverse_kinematics_near(arm, tip, radius(arm, p), sine_of_bend(arm, p));
    for (int i = 0; i < 3; ++i) solution.q[i] = next_to(near[i], solution.q[i]);
    return solution;
}

void set_reference(std::span<const double> params, const Setup& setup, Reference<double>& reference) {
    const Controller<double>& controller = setup.plant.controller;
    reference.in_joints = is_in_joints(controller.type);
    reference.from = reference.in_joints ? setup.q : tip_of(controller.model, setup.q);
    reference.to = reference.from;
    reference.across1 = reference.across2 = reference.amplitude = {0, 0, 0};
    reference.turns = reference.frequency = 0;
    reference.path = tracks_path(controller.type) ? choice_at<"reference.type", Path>(params) : Path::hold;
    reference.start = at<"reference.start">(params);
    reference.duration = at<"reference.duration">(params);
    if (is_aimed(reference.path)) reference.to = target_of(params, controller.model, setup.q, reference.in_joints);
    if (reference.path == Path::circle) set_circle(params, setup, reference);
    if (reference.path == Path::sinusoid) set_sinusoid(params, setup, reference);
    if (reference.path == Path::table) set_table(params, reference);
    reference.end = reference.start + reference.duration;
    set_force_profile(params, reference);
}

}  // namespace arm3r

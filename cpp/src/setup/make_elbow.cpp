#include "setup/make_elbow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "arm3r/model/elbow_dynamics.hpp"
#include "schema/param_access.hpp"

namespace arm3r {
namespace {

// From the frame of a link, whose z is the positive axis of its joint, to that of slide: half a turn about x, or none.
Vec3<double> in_slide(const Vec3<double>& v, double sign) { return {v[0], sign * v[1], sign * v[2]}; }

template <Name link>
RigidBody<double> body_of(std::span<const double> params, double sign) {
    const Vec3<double> diagonal = vector_at<link + ".inertia">(params);
    const auto product = [&](std::size_t i) { return at<link + ".inertia">(params, i); };
    return {at<link + ".mass">(params),
            in_slide(vector_at<link + ".com">(params), sign),
            diagonal,
            {sign * product(3), sign * product(4), product(5)}};
}

// `along`: the positive axis of the joint; `turned`: the sign of the frame in which the axis is given.
template <Name rotor>
Rotor<double> rotor_of(std::span<const double> params, double joint_sign, const Vec3<double>& along, double turned) {
    const Vec3<double> given = vector_at<rotor + ".axis">(params);
    const Vec3<double> axis = std::isnan(given[0]) ? along : in_slide(given, turned);
    const double length = std::sqrt(dot(axis, axis));
    return {at<rotor + ".inertia">(params),
            at<rotor + ".ratio">(params) * joint_sign,
            at<rotor + ".mass">(params),
            {axis[0] / length, axis[1] / length, axis[2] / length}};
}

// About the fixed axes x, y, z, one after the other.
Mat3<double> rotation_of(const Vec3<double>& angles) {
    const auto [sr, cr] = sincos(angles[0]);
    const auto [sp, cp] = sincos(angles[1]);
    const auto [sy, cy] = sincos(angles[2]);
    return from_rows<double>({cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
                             {sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr}, {-sp, cp * sr, cp * cr});
}

}  // namespace

JointConvention convention_of(std::span<const double> params) {
    if (is<"arm.convention", "slide">(params)) return {};
    if (is<"arm.convention", "simscape">(params)) return {.sign = {1, -1, -1}};
    return {.sign = vector_at<"arm.joint_sign">(params), .zero = vector_at<"arm.joint_zero">(params)};
}

void set_elbow(std::span<const double> params, Arm<double>& arm) {
    const auto [sign, zero] = convention_of(params);
    Elbow<double>& elbow = arm.elbow;
    const Vec3<double> angles = vector_at<"arm.base.rotation">(params);
    elbow.position = vector_at<"arm.base.position">(params);
    elbow.rotation = rotation_of(angles);
    elbow.base_is_turned = !angles.isZero(0);
    elbow.shoulder_offset = at<"arm.shoulder_offset">(params);
    elbow.offset = sign[1] * at<"arm.link2.offset">(params);
    elbow.tip = in_slide(vector_at<"arm.link3.tip">(params), sign[2]);
    elbow.links = {body_of<"arm.link1">(params, 1), body_of<"arm.link2">(params, sign[1]),
                   body_of<"arm.link3">(params, sign[2])};
    elbow.rotors = {rotor_of<"arm.rotor1">(params, sign[0], {0, 0, sign[0]}, 1),
                    rotor_of<"arm.rotor2">(params, sign[1], {0, -sign[1], 0}, 1),
                    rotor_of<"arm.rotor3">(params, sign[2], {0, 0, sign[2]}, sign[1])};
    arm.base_height = elbow.position[2];
    arm.link1 = {elbow.links[0].mass, elbow.links[0].com[2], elbow.links[0].inertia[2]};
    arm.link2 = {at<"arm.link2.length">(params), elbow.links[1].mass, elbow.links[1].com[0], elbow.links[1].inertia};
    arm.link3 = {hypot2(elbow.tip[0], elbow.tip[1]), elbow.links[2].mass, elbow.links[2].com[0],
                 elbow.links[2].inertia};
}

LeastPivots least_pivots(const Arm<double>& arm) {
    using std::numbers::pi;
    constexpr int places = 16;  // of an angle: the mass matrix has its sines up to the second order
    LeastPivots least{{infinite, 0, 0}, {infinite, 0, 0}, infinite};
    const auto keep = [](WorstPose& worst, double value, double q2, double q3) {
        if (!(value >= worst.value)) worst = {value, q2, q3};
    };
    for (int i = 0; i < places; ++i)
        for (int j = 0; j < places; ++j) {
            const double q2 = 2 * pi * i / places, q3 = 2 * pi * j / places;
            const elbow_arm::Pivots<double> here = elbow_arm::pivots(arm, pose(Vec3<double>(0, q2, q3)));
            keep(least.lower, here.lower, q2, q3);
            keep(least.first, here.first, q2, q3);
            least.first_over_diagonal = std::min(least.first_over_diagonal, here.first / here.diagonal);
        }
    return least;
}

bool is_far_from_singular(const LeastPivots& least) {
    constexpr double far = 1e-3;  // many rounding errors
    return least.lower.value > far && least.first_over_diagonal > far && least.first.value >= min_inertia;
}

}  // namespace arm3r

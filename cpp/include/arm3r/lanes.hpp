#pragma once
// The numbers of a plant one by one, so that plants of different number types can be filled from each other.

#include "arm3r/plant.hpp"

namespace arm3r {

// f(x...) for each number x of plants of any number types, in a fixed order; flags and choices are left alone.
template <class F, class... Plants>
ARM3R_INLINE void each_number(F f, Plants&... plants) {
    const auto vector = [&](auto&... v) {
        for (int i = 0; i < 3; ++i) f(v[i]...);
    };
    const auto link = [&](auto&... l) {
        f(l.length...);
        f(l.mass...);
        f(l.com...);
        vector(l.inertia...);
    };
    const auto lumped = [&](auto&... l) {
        f(l.A1...), f(l.A2...), f(l.A3...), f(l.B...), f(l.B2...), f(l.B3...), f(l.J3...), f(l.G2...), f(l.G3...);
    };
    const auto arm = [&](auto&... a) {
        f(a.base_height...);
        f(a.link1.mass...), f(a.link1.com...), f(a.link1.inertia_axial...);
        link(a.link2...), link(a.link3...);
        f(a.payload...);
        vector(a.gravity...), vector(a.armature...), vector(a.damping...), vector(a.friction...);
        f(a.friction_velocity...);
        vector(a.torque_limit...);
        lumped(a.lumped...);
    };
    const auto wall = [&](auto&... w) {
        vector(w.point...), vector(w.n...), vector(w.e1...), vector(w.e2...);
        f(w.half1...), f(w.half2...), f(w.face_offset...);
        vector(w.velocity...);
        f(w.amplitude...), f(w.frequency...), f(w.phase...);
    };
    arm(plants.arm...);
    wall(plants.wall...);
    vector(plants.contact.stiffness...);
    vector(plants.controller.torque...);
    arm(plants.controller.model...);
}

template <class P>
void copy_choices(const Plant<P>& from, auto& to) {
    const auto copy_arm = [](const auto& a, auto& b) {
        b.gravity_is_vertical = a.gravity_is_vertical;
        b.has_damping = a.has_damping;
        b.has_dry_friction = a.has_dry_friction;
        b.has_torque_limit = a.has_torque_limit;
    };
    copy_arm(from.arm, to.arm);
    copy_arm(from.controller.model, to.controller.model);
    to.wall.motion = from.wall.motion;
    to.wall.has_outline = from.wall.has_outline;
    to.contact.law = from.contact.law;
    to.controller.type = from.controller.type;
    to.controller.algorithm = from.controller.algorithm;
    to.has_wall = from.has_wall;
    to.acts_on_arm = from.acts_on_arm;
}

}  // namespace arm3r

#pragma once
// The numbers of a plant one by one, so that plants of different number types can be filled from each other.

#include "arm3r/plant.hpp"

namespace arm3r {

// f(x...) for each number x of arms of any number types, in a fixed order; flags and choices are left alone.
template <class F, class... Arms>
ARM3R_INLINE void each_arm_number(F f, Arms&... a) {
    const auto vector = [&](auto&... v) ARM3R_INLINE_LAMBDA { f(v[0]...), f(v[1]...), f(v[2]...); };
    const auto link = [&](auto&... l) ARM3R_INLINE_LAMBDA {
        f(l.length...), f(l.mass...), f(l.com...);
        vector(l.inertia...);
    };
    const auto lumped = [&](auto&... l) ARM3R_INLINE_LAMBDA {
        f(l.A1...), f(l.A2...), f(l.A3...), f(l.B...), f(l.B2...), f(l.B3...), f(l.J3...), f(l.G2...), f(l.G3...);
    };
    f(a.base_height...);
    f(a.link1.mass...), f(a.link1.com...), f(a.link1.inertia_axial...);
    link(a.link2...), link(a.link3...);
    f(a.payload...);
    vector(a.gravity...), vector(a.armature...), vector(a.damping...), vector(a.friction...);
    f(a.friction_velocity...);
    vector(a.torque_limit...);
    lumped(a.lumped...);
}

// The same of plants.
template <class F, class... Plants>
ARM3R_INLINE void each_number(F f, Plants&... plants) {
    const auto vector = [&](auto&... v) ARM3R_INLINE_LAMBDA { f(v[0]...), f(v[1]...), f(v[2]...); };
    const auto wall = [&](auto&... w) ARM3R_INLINE_LAMBDA {
        vector(w.point...), vector(w.n...), vector(w.e1...), vector(w.e2...);
        f(w.half1...), f(w.half2...), f(w.face_offset...);
        vector(w.velocity...);
        f(w.amplitude...), f(w.frequency...), f(w.phase...);
    };
    each_arm_number(f, plants.arm...);
    wall(plants.wall...);
    vector(plants.contact.stiffness...);
    vector(plants.controller.torque...);
    each_arm_number(f, plants.controller.model...);
}

template <class A, class B>
ARM3R_INLINE void copy_arm_choices(const Arm<A>& from, Arm<B>& to) {
    to.gravity_is_vertical = from.gravity_is_vertical;
    to.has_damping = from.has_damping;
    to.has_dry_friction = from.has_dry_friction;
    to.has_torque_limit = from.has_torque_limit;
}

template <class A, class B>
void copy_choices(const Plant<A>& from, Plant<B>& to) {
    copy_arm_choices(from.arm, to.arm);
    copy_arm_choices(from.controller.model, to.controller.model);
    to.wall.motion = from.wall.motion;
    to.wall.has_outline = from.wall.has_outline;
    to.contact.law = from.contact.law;
    to.controller.type = from.controller.type;
    to.controller.algorithm = from.controller.algorithm;
    to.has_wall = from.has_wall;
    to.acts_on_arm = from.acts_on_arm;
}

}  // namespace arm3r

#pragma once
// Lists of the numbers of a plant, so that plants of different number types can be filled from each other.

#include <algorithm>

#include "arm3r/plant.hpp"

namespace arm3r {

// Calls f(x...) for each number x of elbow arms of any number types, in a fixed order; flags are left out.
template <class F, class... Elbows>
ARM3R_INLINE void each_elbow_number(F f, Elbows&... e) {
    const auto vector = [&](auto&... v) ARM3R_INLINE_LAMBDA { f(v[0]...), f(v[1]...), f(v[2]...); };
    vector(e.position...);
    for (int i = 0; i < 9; ++i) f(e.rotation.data()[i]...);
    f(e.shoulder_offset...), f(e.offset...);
    vector(e.tip...);
    for (std::size_t i = 0; i < 3; ++i) {
        f(e.links[i].mass...);
        vector(e.links[i].com...), vector(e.links[i].inertia...), vector(e.links[i].products...);
        f(e.rotors[i].inertia...), f(e.rotors[i].ratio...), f(e.rotors[i].mass...);
        vector(e.rotors[i].axis...);
    }
    f(e.lateral...), f(e.D2...), f(e.D3...), f(e.E2...), f(e.F2...), f(e.E3...), f(e.F3...), f(e.Gy2...), f(e.Gy3...);
    f(e.Hu...), f(e.Hv...), f(e.K12...), f(e.E23...), f(e.F23...);
    vector(e.gravity...);
    f(e.fixed_energy...);
}

// Calls f(x...) for each number x of arms of any number types, in a fixed order; flags and choices are left out. Their
// choices (copy_arm_choices) must be the same before.
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
    if ((... && a.is_elbow)) each_elbow_number(f, a.elbow...);
}

template <class F, class... Tables>
void each_table_number(F f, Tables&... tables) {
    const std::size_t knots = std::min({tables.t.size()...});
    for (std::size_t i = 0; i < knots; ++i) f(tables.t[i]...), f(tables.s[i]...), f(tables.v[i]...), f(tables.a[i]...);
}

// Calls f for each of the gains and the numbers of the reference of controllers.
template <class F, class... Controllers>
ARM3R_INLINE void each_law_number(F f, Controllers&... c) {
    const auto vector = [&](auto&... v) ARM3R_INLINE_LAMBDA { f(v[0]...), f(v[1]...), f(v[2]...); };
    const auto reference = [&](auto&... s) ARM3R_INLINE_LAMBDA {
        vector(s.from...), vector(s.to...);
        f(s.start...), f(s.duration...), f(s.end...);
        vector(s.across1...), vector(s.across2...);
        f(s.turns...);
        vector(s.amplitude...);
        f(s.frequency...), f(s.force...), f(s.force_before...), f(s.force_start...), f(s.force_duration...);
        f(s.force_amplitude...), f(s.force_frequency...);
        if ((... && (s.path == Path::table)))
            for (std::size_t i = 0; i < 3; ++i) each_table_number(f, (*s.table)[i]...);
    };
    each_gain([&](auto, auto&... x) ARM3R_INLINE_LAMBDA { f(x...); },
              [&](auto, auto&... v) ARM3R_INLINE_LAMBDA { vector(v...); }, c.gains...);
    reference(c.reference...);
}

// Calls f for each number of sensors.
template <class F, class... Sets>
ARM3R_INLINE void each_sensor_number(F f, Sets&... s) {
    f(s.encoder_step...), f(s.velocity_share...), f(s.noise...), f(s.resolution...);
    f(s.bias[0]...), f(s.bias[1]...), f(s.bias[2]...);
    f(s.analog_rate...), f(s.analog_share...), f(s.force_share...), f(s.force_delay...), f(s.tool_mass...);
}

template <class F, class... Observers>
ARM3R_INLINE void each_observer_number(F f, Observers&... o) {
    const auto vector = [&](auto&... v) ARM3R_INLINE_LAMBDA { f(v[0]...), f(v[1]...), f(v[2]...); };
    vector(o.gain...), vector(o.threshold...);
    f(o.hold...), f(o.reflex_gain...), f(o.retreat_gain...);
    vector(o.joint_stiffness...), vector(o.joint_damping...);
}

template <class F, class... Loads>
ARM3R_INLINE void each_external_force_number(F f, Loads&... l) {
    f(l.force[0]...), f(l.force[1]...), f(l.force[2]...), f(l.start...), f(l.rise...), f(l.end...);
}

template <class F, class... Contacts>
ARM3R_INLINE void each_contact_number(F f, Contacts&... c) {
    f(c.stiffness[0]...), f(c.stiffness[1]...), f(c.stiffness[2]...);
    f(c.damping...), f(c.exponent...), f(c.dissipation...), f(c.friction...), f(c.slip_velocity...);
}

// Calls f for each number of plants, except the tables of walls and the numbers that only a law uses.
template <class F, class... Plants>
ARM3R_INLINE void each_number(F f, Plants&... plants) {
    const auto vector = [&](auto&... v) ARM3R_INLINE_LAMBDA { f(v[0]...), f(v[1]...), f(v[2]...); };
    const auto sinusoid = [&](auto&... s) ARM3R_INLINE_LAMBDA { f(s.amplitude...), f(s.frequency...), f(s.phase...); };
    const auto wall = [&](auto&... w) ARM3R_INLINE_LAMBDA {
        vector(w.point...), vector(w.n...), vector(w.e1...), vector(w.e2...);
        f(w.half1...), f(w.half2...), f(w.face_offset...);
        vector(w.velocity...), vector(w.direction...);
        sinusoid(w.sinusoid...);
        f(w.ramp.distance...), f(w.ramp.start...), f(w.ramp.duration...);
        vector(w.axis...), f(w.turn_rate...);
        sinusoid(w.turn_sinusoid...);
    };
    each_arm_number(f, plants.arm...);
    wall(plants.wall...);
    each_contact_number(f, plants.contact...);
    vector(plants.held_torque...);
    each_arm_number(f, plants.controller.model...);
}

template <class A, class B>
ARM3R_INLINE void copy_arm_choices(const Arm<A>& from, Arm<B>& to) {
    static_cast<ArmChoices&>(to) = from;
    static_cast<ElbowChoices&>(to.elbow) = from.elbow;
}

template <class A, class B>
void copy_controller_choices(const Controller<A>& from, Controller<B>& to) {
    copy_arm_choices(from.model, to.model);
    static_cast<ControllerChoices&>(to) = from;
    static_cast<ReferenceChoices&>(to.reference) = from.reference;
    if (!from.reference.table) return;
    if (!to.reference.table)
        to.reference.table =
            std::make_shared<std::array<QuinticTable<B>, 3>>();  // otherwise other lanes use it already
    for (std::size_t i = 0; i < 3; ++i) (*to.reference.table)[i].set_knots((*from.reference.table)[i].t.size());
}

template <class A, class B>
void copy_choices(const Plant<A>& from, Plant<B>& to) {
    copy_arm_choices(from.arm, to.arm);
    static_cast<WallChoices&>(to.wall) = from.wall;
    if (from.wall.table) {
        to.wall.table = std::make_shared<QuinticTable<B>>();
        to.wall.table->set_knots(from.wall.table->t.size());
    }
    static_cast<ContactChoices&>(to.contact) = from.contact;
    copy_controller_choices(from.controller, to.controller);
    static_cast<SensorChoices&>(to.sensors) = from.sensors;
    static_cast<ObserverChoices&>(to.observer) = from.observer;
    to.external_force.on = from.external_force.on;
    static_cast<PlantChoices&>(to) = from;
}

}  // namespace arm3r

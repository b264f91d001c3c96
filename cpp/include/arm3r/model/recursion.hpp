#pragma once
// The arm once more, derived another way on purpose: Newton-Euler, link by link, on rotation matrices and the link data as
// stated. It shares no formula with kinematics.hpp and dynamics.hpp; it is the transform sensor, and it checks them (3.12).
// Slide convention.

#include <array>

#include "arm3r/model/arm.hpp"

namespace arm3r {

// One body of the chain, in its own axes: z is its joint axis.
template <class T>
struct Body {
    Mat3<T> R;        // from this body's axes to its parent's
    Vec3<T> origin;   // m, of its joint, in the parent's axes
    Vec3<T> com;      // m, from its joint
    T mass;           // kg
    Vec3<T> inertia;  // kg m^2, principal, about com
};

template <class P, class T>
ARM3R_INLINE std::array<Body<T>, 3> chain(const Arm<P>& arm, const Vec3<T>& q) {
    const T o(0.0), l(1.0);
    std::array<Body<T>, 3> bodies;

    const SinCos<T> one = sincos(q[0]);
    bodies[0].R = from_rows<T>({one.cos, -one.sin, o}, {one.sin, one.cos, o}, {o, o, l});
    bodies[0].origin = {o, o, o};
    bodies[0].com = {o, o, T(arm.link1.com)};
    bodies[0].mass = T(arm.link1.mass);
    bodies[0].inertia = {o, o, T(arm.link1.inertia_axial)};

    const SinCos<T> two = sincos(q[1]);  // a quarter turn about x lays z along joint 2, then q2 about that z
    bodies[1].R = from_rows<T>({two.cos, -two.sin, o}, {o, o, -l}, {two.sin, two.cos, o});
    bodies[1].origin = {o, o, T(arm.base_height)};
    bodies[1].com = {T(arm.link2.com), o, o};
    bodies[1].mass = T(arm.link2.mass);
    bodies[1].inertia = broadcast<T>(arm.link2.inertia);

    const SinCos<T> three = sincos(q[2]);
    bodies[2].R = from_rows<T>({three.cos, -three.sin, o}, {three.sin, three.cos, o}, {o, o, l});
    bodies[2].origin = {T(arm.link2.length), o, o};
    bodies[2].com = {T(arm.link3.com), o, o};
    bodies[2].mass = T(arm.link3.mass);
    bodies[2].inertia = broadcast<T>(arm.link3.inertia);
    return bodies;
}

// A vector in the axes of body `i`, turned into base axes.
template <class T>
ARM3R_INLINE Vec3<T> to_base(const std::array<Body<T>, 3>& bodies, int i, Vec3<T> v) {
    for (; i >= 0; --i) v = times(bodies[i].R, v);
    return v;
}

template <class T>
struct TipSensor {
    Vec3<T> position, velocity;  // m, m/s, base axes
};

template <class P, class T>
ARM3R_INLINE TipSensor<T> tip_sensor(const Arm<P>& arm, const Vec3<T>& q, const Vec3<T>& qd) {
    const std::array<Body<T>, 3> bodies = chain(arm, q);
    const T o(0.0);
    Vec3<T> omega(o, o, o), velocity(o, o, o);  // of the body's joint, in its axes
    for (int i = 0; i < 3; ++i) {
        velocity = transposed_times(bodies[i].R, plus(velocity, cross(omega, bodies[i].origin)));
        omega = transposed_times(bodies[i].R, omega);
        omega[2] = omega[2] + qd[i];
    }
    const Vec3<T> tip(T(arm.link3.length), o, o);
    Vec3<T> position = tip;
    for (int i = 2; i >= 0; --i) position = plus(bodies[i].origin, times(bodies[i].R, position));
    return {position, to_base(bodies, 2, plus(velocity, cross(omega, tip)))};
}

// tau for a motion and a force at the tip; armature and friction included (3.12).
template <class P, class T>
Vec3<T> recursion_inverse_dynamics(const Arm<P>& arm, const Vec3<T>& q, const Vec3<T>& qd, const Vec3<T>& qdd,
                                   const Vec3<T>& f_on_tip) {
    const std::array<Body<T>, 3> bodies = chain(arm, q);
    const T o(0.0);
    std::array<Vec3<T>, 3> force, moment;  // that each body needs, at its centre of mass, in its axes

    // outward: gravity enters as an acceleration of the base
    Vec3<T> omega(o, o, o), alpha(o, o, o);
    Vec3<T> acceleration(T(-arm.gravity[0]), T(-arm.gravity[1]), T(-arm.gravity[2]));
    for (int i = 0; i < 3; ++i) {
        const Body<T>& body = bodies[i];
        const Vec3<T> joint =
            plus(acceleration, plus(cross(alpha, body.origin), cross(omega, cross(omega, body.origin))));
        acceleration = transposed_times(body.R, joint);
        omega = transposed_times(body.R, omega);
        alpha = transposed_times(body.R, alpha);
        const Vec3<T> spin(o, o, qd[i]);
        alpha = plus(alpha, cross(omega, spin));
        alpha[2] = alpha[2] + qdd[i];
        omega[2] = omega[2] + qd[i];

        const Vec3<T> of_com = plus(acceleration, plus(cross(alpha, body.com), cross(omega, cross(omega, body.com))));
        const Vec3<T> angular_momentum(body.inertia[0] * omega[0], body.inertia[1] * omega[1],
                                       body.inertia[2] * omega[2]);
        const Vec3<T> inertial(body.inertia[0] * alpha[0], body.inertia[1] * alpha[1], body.inertia[2] * alpha[2]);
        force[i] = Vec3<T>(body.mass * of_com[0], body.mass * of_com[1], body.mass * of_com[2]);
        moment[i] = plus(inertial, cross(omega, angular_momentum));
    }

    // inward: f and n that the parent exerts on each body, at its joint, starting from the payload and the force on the
    // tip
    Vec3<T> push = f_on_tip;
    for (int i = 0; i < 3; ++i) push = transposed_times(bodies[i].R, push);
    const Vec3<T> tip(T(arm.link3.length), o, o);
    const Vec3<T> of_tip = plus(acceleration, plus(cross(alpha, tip), cross(omega, cross(omega, tip))));
    Vec3<T> f(arm.payload * of_tip[0] - push[0], arm.payload * of_tip[1] - push[1], arm.payload * of_tip[2] - push[2]);
    Vec3<T> n = cross(tip, f);
    Vec3<T> tau;
    for (int i = 2; i >= 0; --i) {
        f = plus(f, force[i]);
        n = plus(n, plus(moment[i], cross(bodies[i].com, force[i])));
        tau[i] = n[2] + arm.armature[i] * qdd[i] + arm.damping[i] * qd[i];
        if (arm.has_dry_friction) tau[i] = tau[i] + arm.friction[i] * tanh(T(qd[i] / arm.friction_velocity));
        f = times(bodies[i].R, f);
        n = plus(times(bodies[i].R, n), cross(bodies[i].origin, f));
    }
    return tau;
}

template <class P, class T>
Vec3<T> recursion_gravity_torque(const Arm<P>& arm, const Vec3<T>& q) {
    const Vec3<T> zero(T(0.0), T(0.0), T(0.0));
    return recursion_inverse_dynamics(arm, q, zero, zero, zero);
}

// qdd: the mass matrix column by column from unit accelerations, then a 3x3 Cholesky-free elimination.
template <class P, class T>
Vec3<T> recursion_forward_dynamics(const Arm<P>& arm, const Vec3<T>& q, const Vec3<T>& qd, const Vec3<T>& tau,
                                   const Vec3<T>& f_on_tip) {
    const T o(0.0);
    const Vec3<T> zero(o, o, o);
    const Vec3<T> bias = recursion_inverse_dynamics(arm, q, qd, zero, f_on_tip);
    const Vec3<T> at_rest = recursion_inverse_dynamics(arm, q, zero, zero, zero);
    Mat3<T> M;
    for (int j = 0; j < 3; ++j) {
        Vec3<T> unit = zero;
        unit[j] = T(1.0);
        const Vec3<T> column = minus(recursion_inverse_dynamics(arm, q, zero, unit, zero), at_rest);
        for (int i = 0; i < 3; ++i) M(i, j) = column[i];
    }
    Vec3<T> x = minus(tau, bias);
    for (int k = 0; k < 2; ++k) {
        for (int i = k + 1; i < 3; ++i) {
            const T factor = M(i, k) / M(k, k);
            for (int j = k + 1; j < 3; ++j) M(i, j) = M(i, j) - factor * M(k, j);
            x[i] = x[i] - factor * x[k];
        }
    }
    for (int i = 2; i >= 0; --i) {
        for (int j = i + 1; j < 3; ++j) x[i] = x[i] - M(i, j) * x[j];
        x[i] = x[i] / M(i, i);
    }
    return x;
}

}  // namespace arm3r

#pragma once
// The arm once more, derived another way on purpose: Newton-Euler, link by link, on rotation matrices and the link data as
// stated. It shares no formula with kinematics.hpp and dynamics.hpp; it is the transform sensor, and it checks them (3.12).
// Slide convention.

#include <array>

#include "arm3r/model/arm.hpp"

namespace arm3r {

// One body of the chain, in its own axes: its joint turns about z, or slides along it.
template <class T>
struct Body {
    Mat3<T> R;            // from this body's axes to its parent's
    Vec3<T> origin;       // m, of its joint, in the parent's axes; moves with a joint that slides
    Vec3<T> com;          // m, from its joint
    T mass;               // kg
    Vec3<T> inertia;      // kg m^2, diagonal of the tensor about com
    Vec3<T> products;     // kg m^2, its xy, xz, yz; of an elbow arm
    bool slides = false;  // then q is in m, and a torque is a force in N
};

template <class P, class T>
ARM3R_INLINE void put_on(Body<T>& body, const RigidBody<P>& link) {
    body.com = broadcast<T>(link.com);
    body.mass = T(link.mass);
    body.inertia = broadcast<T>(link.inertia);
    body.products = broadcast<T>(link.products);
}

// The chain of an elbow arm from the base on: its frames, bodies and offsets in place of those of the planar arm.
template <class P, class T>
ARM3R_INLINE void extend(const Elbow<P>& elbow, std::array<Body<T>, 3>& bodies) {
    Mat3<T> R;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            R(i, j) = elbow.rotation(i, 0) * bodies[0].R(0, j) + elbow.rotation(i, 1) * bodies[0].R(1, j) +
                      elbow.rotation(i, 2) * bodies[0].R(2, j);
    bodies[0].R = R;
    bodies[0].origin = broadcast<T>(elbow.position);
    bodies[1].origin = {T(elbow.shoulder_offset), T(0.0), T(0.0)};
    bodies[2].origin[2] = T(elbow.offset);
    for (int i = 0; i < 3; ++i) put_on(bodies[i], elbow.links[i]);
}

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
    if (arm.is_elbow) extend(arm.elbow, bodies);
    return bodies;
}

// The tip in the axes of link 3, m from its joint.
template <class T, class P>
ARM3R_INLINE Vec3<T> tip_of_link3(const Arm<P>& arm) {
    return arm.is_elbow ? broadcast<T>(arm.elbow.tip) : Vec3<T>(T(arm.link3.length), T(0.0), T(0.0));
}

// The tensor of a body times a vector, in its axes.
template <class P, class T>
ARM3R_INLINE Vec3<T> inertia_times(const Arm<P>& arm, const Body<T>& body, const Vec3<T>& v) {
    const Vec3<T>&d = body.inertia, &o = body.products;
    if (!arm.is_elbow) return {d[0] * v[0], d[1] * v[1], d[2] * v[2]};
    return {d[0] * v[0] + o[0] * v[1] + o[1] * v[2], o[0] * v[0] + d[1] * v[1] + o[2] * v[2],
            o[1] * v[0] + o[2] * v[1] + d[2] * v[2]};
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

template <class T>
ARM3R_INLINE TipSensor<T> tip_sensor(const std::array<Body<T>, 3>& bodies, const Vec3<T>& tip, const Vec3<T>& qd) {
    const T o(0.0);
    Vec3<T> omega(o, o, o), velocity(o, o, o);  // of the body's joint, in its axes
    for (int i = 0; i < 3; ++i) {
        velocity = transposed_times(bodies[i].R, plus(velocity, cross(omega, bodies[i].origin)));
        omega = transposed_times(bodies[i].R, omega);
        T& along_z = bodies[i].slides ? velocity[2] : omega[2];
        along_z = along_z + qd[i];
    }
    Vec3<T> position = tip;
    for (int i = 2; i >= 0; --i) position = plus(bodies[i].origin, times(bodies[i].R, position));
    return {position, to_base(bodies, 2, plus(velocity, cross(omega, tip)))};
}

template <class P, class T>
ARM3R_INLINE TipSensor<T> tip_sensor(const Arm<P>& arm, const Vec3<T>& q, const Vec3<T>& qd) {
    return tip_sensor<T>(chain(arm, q), tip_of_link3<T>(arm), qd);
}

// The moment, N m, that a rotor needs of the link that carries it, and what its joint's actuator needs for it.
template <class T>
struct CarriedRotor {
    Vec3<T> moment;
    T on_joint;
};

// omega and alpha: of that link, in its axes.
template <class P, class T>
ARM3R_INLINE CarriedRotor<T> carried_rotor(const Rotor<P>& rotor, const Vec3<T>& omega, const Vec3<T>& alpha,
                                           const T& qd, const T& qdd) {
    const Vec3<T> axis = broadcast<T>(rotor.axis);
    const T spin = dot(axis, omega) + rotor.ratio * qd;
    const T change = rotor.inertia * (dot(axis, alpha) + rotor.ratio * qdd);
    return {plus(scaled(change, axis), scaled(T(rotor.inertia * spin), cross(omega, axis))), rotor.ratio * change};
}

// The motion of a body's joint, in the axes of the body.
template <class T>
struct BodyMotion {
    Vec3<T> omega, alpha, acceleration;  // rad/s, rad/s^2, m/s^2

    // Of a point that the body carries, from its joint.
    ARM3R_INLINE Vec3<T> acceleration_of(const Vec3<T>& point) const {
        return plus(acceleration, plus(cross(alpha, point), cross(omega, cross(omega, point))));
    }
};

// The motion of a body, of that of its parent.
template <class T>
ARM3R_INLINE BodyMotion<T> beyond_joint(const BodyMotion<T>& parent, const Body<T>& body, const T& qd, const T& qdd) {
    BodyMotion<T> motion = {transposed_times(body.R, parent.omega), transposed_times(body.R, parent.alpha),
                            transposed_times(body.R, parent.acceleration_of(body.origin))};
    const Vec3<T> turned = cross(motion.omega, Vec3<T>(T(0.0), T(0.0), qd));
    if (body.slides) {
        motion.acceleration = plus(motion.acceleration, scaled(T(2.0), turned));
        motion.acceleration[2] = motion.acceleration[2] + qdd;
    } else {
        motion.alpha = plus(motion.alpha, turned);
        motion.alpha[2] = motion.alpha[2] + qdd;
        motion.omega[2] = motion.omega[2] + qd;
    }
    return motion;
}

// tau for a motion and a force at the tip; armature and friction included (3.12). The bodies are those of the arm, at q.
template <class P, class T>
ARM3R_INLINE Vec3<T> recursion_inverse_dynamics(const Arm<P>& arm, const std::array<Body<T>, 3>& bodies,
                                                const Vec3<T>& qd, const Vec3<T>& qdd, const Vec3<T>& f_on_tip) {
    const T o(0.0);
    std::array<Vec3<T>, 3> force, moment;  // that each body needs, at its centre of mass, in its axes
    Vec3<T> geared(o, o, o);               // N m, that the actuators need for the rotors beside `armature`
    if (arm.is_elbow)
        geared[0] = carried_rotor(arm.elbow.rotors[0], Vec3<T>(o, o, o), Vec3<T>(o, o, o), qd[0], qdd[0]).on_joint;

    // outward: gravity enters as an acceleration of the base
    BodyMotion<T> motion = {Vec3<T>(o, o, o), Vec3<T>(o, o, o),
                            Vec3<T>(T(-arm.gravity[0]), T(-arm.gravity[1]), T(-arm.gravity[2]))};
    for (int i = 0; i < 3; ++i) {
        const Body<T>& body = bodies[i];
        motion = beyond_joint(motion, body, qd[i], qdd[i]);
        force[i] = scaled(body.mass, motion.acceleration_of(body.com));
        moment[i] =
            plus(inertia_times(arm, body, motion.alpha), cross(motion.omega, inertia_times(arm, body, motion.omega)));
        if (arm.is_elbow && i < 2) {
            const CarriedRotor<T> rotor =
                carried_rotor(arm.elbow.rotors[i + 1], motion.omega, motion.alpha, qd[i + 1], qdd[i + 1]);
            const Vec3<T> at = bodies[i + 1].origin, from_com = minus(at, body.com);
            const Vec3<T> push = scaled(T(arm.elbow.rotors[i + 1].mass), motion.acceleration_of(at));
            force[i] = plus(force[i], push);
            moment[i] = plus(moment[i], plus(rotor.moment, cross(from_com, push)));
            geared[i + 1] = rotor.on_joint;
        }
    }

    // inward: f and n that the parent exerts on each body, at its joint, starting from the payload and the force on the
    // tip
    Vec3<T> push = f_on_tip;
    for (int i = 0; i < 3; ++i) push = transposed_times(bodies[i].R, push);
    const Vec3<T> tip = tip_of_link3<T>(arm);
    const Vec3<T> of_tip = motion.acceleration_of(tip);
    Vec3<T> f(arm.payload * of_tip[0] - push[0], arm.payload * of_tip[1] - push[1], arm.payload * of_tip[2] - push[2]);
    Vec3<T> n = cross(tip, f);
    Vec3<T> tau;
    for (int i = 2; i >= 0; --i) {
        f = plus(f, force[i]);
        n = plus(n, plus(moment[i], cross(bodies[i].com, force[i])));
        tau[i] = (bodies[i].slides ? f[2] : n[2]) + arm.armature[i] * qdd[i] + arm.damping[i] * qd[i];
        if (arm.is_elbow) tau[i] = tau[i] + geared[i];
        if (arm.has_dry_friction) tau[i] = tau[i] + arm.friction[i] * tanh(T(qd[i] / arm.friction_velocity));
        f = times(bodies[i].R, f);
        n = plus(times(bodies[i].R, n), cross(bodies[i].origin, f));
    }
    return tau;
}

template <class P, class T>
Vec3<T> recursion_inverse_dynamics(const Arm<P>& arm, const Vec3<T>& q, const Vec3<T>& qd, const Vec3<T>& qdd,
                                   const Vec3<T>& f_on_tip) {
    return recursion_inverse_dynamics(arm, chain(arm, q), qd, qdd, f_on_tip);
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

#pragma once
// Passivity of a sampled law: it may put out the energy of its own spring and the reserve of energy that it took from
// the arm before; docs/model.md (8.8). After Hannaford and Ryu 2002 and Franken et al. 2011. Slide convention, base
// axes.

#include "arm3r/control/controllers.hpp"

namespace arm3r {

// Whether memory[0] of the law is such a reserve, J.
inline bool has_reserve(const ControllerChoices& law) {
    return law.controls_passivity || (law.type == ControllerType::energy_tank && law.has_tank);
}

// The potential energy of the arm less that of the law's spring, J: its gradient is the law's torque without damping.
template <class P, class T>
ARM3R_INLINE T law_potential(const Controller<P>& controller, const Pose<T>& p, const Vec3<T>& x_d) {
    const Gains<P>& gains = controller.gains;
    const Vec3<T> x = tip_position(controller.model, p);
    T twice_spring;
    if (controller.type == ControllerType::virtual_wall) {
        const T depth = max(T(0.0), dot(broadcast<T>(gains.plane_normal), minus(broadcast<T>(gains.plane_point), x)));
        twice_spring = gains.stiffness[0] * depth * depth;
    } else {
        const Vec3<T> e = minus(x, x_d);
        twice_spring = dot(e, cwise_product(gains.stiffness, e));
    }
    return potential_energy(controller.model, p) - 0.5 * twice_spring;
}

// The state of the arm at a later instant, as the model predicts it, and the reserve at that instant.
template <class T>
struct Prediction {
    Vec3<T> q, qd;
    Pose<T> pose;
    T potential, reserve;  // J
};

// Advances the prediction by `time` under a constant torque without contact, to third order. Returns the change of the
// joint angles, rad.
template <class P, class T>
ARM3R_INLINE Vec3<T> predict(const Controller<P>& controller, const Vec3<T>& x_d, const Vec3<T>& tau, const T& time,
                             Prediction<T>& at) {
    const Vec3<T> first = forward_dynamics(controller.model, at.pose, at.qd, tau, zero_vector<T>());
    Vec3<T> q, qd, way;
    for (int i = 0; i < 3; ++i) {
        q[i] = at.q[i] + time * (at.qd[i] + 0.5 * time * first[i]);
        qd[i] = at.qd[i] + time * first[i];
    }
    const Vec3<T> second = forward_dynamics(controller.model, pose(q), qd, tau, zero_vector<T>());
    for (int i = 0; i < 3; ++i) {
        way[i] = time * (at.qd[i] + time * (2.0 * first[i] + second[i]) / 6.0);
        at.q[i] = at.q[i] + way[i];
        at.qd[i] = at.qd[i] + 0.5 * time * (first[i] + second[i]);
    }
    at.pose = pose(at.q);
    const T potential = law_potential(controller, at.pose, x_d);
    at.reserve = at.reserve - (dot(tau, way) - (potential - at.potential));
    at.potential = potential;
    return way;
}

// The torque -alpha M qd that keeps the reserve from becoming negative where `tau` alone, held for a period, would use
// more energy than there is.
template <class P, class T>
ARM3R_INLINE Vec3<T> braking_torque(const Controller<P>& controller, const Vec3<T>& x_d, const Vec3<T>& tau,
                                    const T& period, const Prediction<T>& at) {
    constexpr double doubt = 0.01;  // relative error of the prediction that is allowed for
    Prediction<T> next = at;
    const Vec3<T> way = predict(controller, x_d, tau, period, next);
    const Vec3<T> p = times(mass_matrix(controller.model, at.pose), way);
    const T o(0.0), least(1e-300), given = at.reserve - next.reserve;
    const T excess = doubt * abs(given) - next.reserve;
    const T per_share = 2.0 * dot(p, way) / (period * period), most = given + per_share;
    const T root = sqrt(max(o, T(most * most - 4.0 * per_share * excess)));
    const T share = min(T(2.0 * excess / max(least, T(most + root))), T(0.5 * most / max(least, per_share)));
    const T alpha = select(excess > o && most > o, T(2.0 * share / (period * period)), o);
    return {-alpha * p[0], -alpha * p[1], -alpha * p[2]};
}

}  // namespace arm3r

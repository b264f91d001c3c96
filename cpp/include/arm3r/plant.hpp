#pragma once
// Arm, wall and controller together: the right-hand side of the equation of motion, with the energy books beside it (4.9).

#include "arm3r/contact.hpp"
#include "arm3r/controllers.hpp"
#include "arm3r/integrators.hpp"

namespace arm3r {

// q, qd, and what has passed through the books so far: work of the actuators, work of the wall, dissipated energy.
enum : std::size_t { motion_size = 6, ledger_size = 3, state_size = motion_size + ledger_size };

enum class Touch {
    none,        // the tip is free, or behind the plate without having come through its face
    pressed,     // in contact: the law holds, smoothly continued past the instants at which contact ends
    each_stage,  // fixed steps: contact is wherever the tip is inside, asked anew at each stage
};

template <class P>
struct Plant {
    Arm<P> arm;
    Wall<P> wall;
    Contact<P> contact;
    Controller<P> controller;
    bool has_wall = false, acts_on_arm = false;
};

// The tip as the wall sees it (4.3), (4.4), (4.7).
template <class P, class T>
ARM3R_INLINE Indentation<T> tip_indentation(const Plant<P>& plant, const WallState<T>& wall, const Pose<T>& p,
                                            const Vec3<T>& qd) {
    return indentation(plant.wall, wall, tip_position(plant.arm, p), tip_velocity(plant.arm, p, qd));
}

// The derivative of the state. N is motion_size for the motion alone, state_size with the books.
template <class P, class T>
class RightHandSide {
public:
    explicit RightHandSide(const Plant<P>& plant)
        : plant_(plant),
          needs_azimuth_(!plant.arm.gravity_is_vertical || !plant.controller.model.gravity_is_vertical ||
                         plant.has_wall) {}

    Touch touch = Touch::none;

    // The stages of a step are turned from the sines and cosines at the nearest point of a grid of angles (elementary.hpp,
    // sincos_near), which change so rarely that they are kept. What is kept never changes a result: it is that of the point.
    template <std::size_t N>
    ARM3R_INLINE void begin_step(const State<T, N>& y) {
        const Vec3<T> nearest(on_grid(y[0]), on_grid(y[1]), on_grid(T(y[1] + y[2])));
        auto is_kept = nearest[1] == anchor_q_[1] && nearest[2] == anchor_q_[2];
        if (needs_azimuth_) is_kept = is_kept && nearest[0] == anchor_q_[0];
        if (all(is_kept)) return;
        move_anchor(nearest);
    }

    template <std::size_t N>
    ARM3R_INLINE void operator()(const T& t, const State<T, N>& y, State<T, N>& dy) const {
        WallState<T> wall = no_wall<T>();
        if (plant_.acts_on_arm && touch != Touch::none) wall = wall_at(plant_.wall, t);
        derivative(wall, pose_near(y), y, dy);
    }

    // The same where the pose is known, and the wall unless it is not felt.
    template <std::size_t N>
    ARM3R_INLINE void derivative(const WallState<T>& wall, const Pose<T>& p, const State<T, N>& y,
                                 State<T, N>& dy) const {
        const Vec3<T> q(y[0], y[1], y[2]), qd(y[3], y[4], y[5]);
        const Arm<P>& arm = plant_.arm;
        const Vec3<T> tau = limited(arm, control(plant_.controller, q, p));
        const Vec3<T> tau_f = friction_torque(arm, qd);
        Vec3<T> drive = minus(tau, tau_f);
        T wall_power(0.0), contact_loss(0.0);
        if (plant_.acts_on_arm && touch != Touch::none) {
            const Indentation<T> in = tip_indentation(plant_, wall, p, qd);
            const ContactForce<T> force = contact_force(plant_.wall, plant_.contact, in);
            const auto felt = [&] ARM3R_INLINE_LAMBDA { return plus(drive, tip_force_torque(arm, p, force.on_tip)); };
            if (touch == Touch::pressed) {
                drive = felt();
                wall_power = dot(force.on_tip, wall.velocity);
                contact_loss = force.dissipated;
            } else if (const auto inside = in.depth > T(0.0); any(inside)) {
                const auto touching = inside && within(in);
                const Vec3<T> with = felt();
                drive = {select(touching, with[0], drive[0]), select(touching, with[1], drive[1]),
                         select(touching, with[2], drive[2])};
                wall_power = select(touching, dot(force.on_tip, wall.velocity), wall_power);
                contact_loss = select(touching, force.dissipated, contact_loss);
            }
        }
        const Vec3<T> qdd = joint_acceleration(arm, p, qd, drive);
        if constexpr (N == motion_size) dy = {qd[0], qd[1], qd[2], qdd[0], qdd[1], qdd[2]};
        else
            dy = {qd[0],        qd[1],      qd[2],
                  qdd[0],       qdd[1],     qdd[2],
                  dot(tau, qd), wall_power, T(dot(tau_f, qd) + contact_loss)};
    }

    // The pose near the one of begin_step().
    template <std::size_t N>
    ARM3R_INLINE Pose<T> pose_near(const State<T, N>& y) const {
        const auto [second, third] =
            sincos_near_pair(anchor_q_[1], SinCos<T>{anchor_.S2, anchor_.C2}, y[1], anchor_q_[2],
                             SinCos<T>{anchor_.S23, anchor_.C23}, T(y[1] + y[2]));
        if (!needs_azimuth_) return {T(0.0), T(1.0), second.sin, second.cos, third.sin, third.cos};
        const SinCos<T> first = sincos_near(anchor_q_[0], SinCos<T>{anchor_.S1, anchor_.C1}, y[0]);
        return {first.sin, first.cos, second.sin, second.cos, third.sin, third.cos};
    }

private:
    ARM3R_INLINE static T on_grid(const T& angle) {
        constexpr double points_per_radian = 32;
        return nearest_integer(T(angle * points_per_radian)) * (1 / points_per_radian);
    }

    ARM3R_INLINE void move_anchor(const Vec3<T>& nearest) {
        const SinCos<T> first = sincos(nearest[0]), second = sincos(nearest[1]), third = sincos(nearest[2]);
        anchor_q_ = nearest;
        anchor_ = {first.sin, first.cos, second.sin, second.cos, third.sin, third.cos};
    }

    ARM3R_INLINE auto within(const Indentation<T>& in) const {
        const T zero(0.0);
        return plant_.wall.has_outline ? inside_outline(plant_.wall, in) >= zero : zero >= zero;
    }

    const Plant<P>& plant_;
    bool needs_azimuth_;
    Vec3<T> anchor_q_{T(0.0), T(0.0), T(0.0)};
    Pose<T> anchor_{T(0.0), T(1.0), T(0.0), T(1.0), T(0.0), T(1.0)};
};

}  // namespace arm3r

#pragma once
// How well a controller did, in numbers, summed up along the motion by the trapezoidal rule between sights of it, lane by
// lane; docs/model.md (8.10).

#include <limits>

#include "setup.hpp"
#include "simulation.hpp"

namespace arm3r {

// What is looked at, at one instant.
template <class T>
struct Sight {
    T t;                    // s
    T force, force_wanted;  // N, normal
    T touches;              // 1 in contact, else 0
    T path_error_2;         // m^2: of the tip from its reference; where force is controlled, along the wall only
    T saturated;            // 1 where a torque is at its limit
    Vec3<T> q, tau;         // rad, N m
    T work;                 // J, of all actuators so far
};

// Square of the tip's distance from its reference; of angles, where they put the tip of the true arm.
template <class P, class T>
ARM3R_INLINE T path_error_2(const Arm<P>& arm, const Controller<P>& controller, const T& t, const Vec3<T>& tip,
                            const Vec3<T>& n, const T& force_phase) {
    const Wanted<T> wanted = wanted_at(controller.setpoint, t);
    const Vec3<T> goal = controller.setpoint.in_joints ? tip_position(arm, pose(wanted.position)) : wanted.position;
    const Vec3<T> off = minus(tip, goal);
    const T across = wants_force(controller.type) ? T(force_phase * dot(n, off)) : T(0.0);
    return max(T(0.0), T(dot(off, off) - across * across));
}

// What is worth a look: what a law wants, and limits that there are.
struct Looks {
    bool force, path, limits;
};

template <class T>
class Score {
public:
    explicit Score(const Setup& setup)
        : torque_is_held_(setup.digital.sampling.on),
          looks_{wants_force(setup.law().type), wants_path(setup.law().type), setup.plant.arm.has_torque_limit} {}

    const Looks& looks() const { return looks_; }
    // Whether the sights of a step's two ends tell all: the work of a torque that is held.
    bool needs_ends_only() const { return torque_is_held_ && !looks_.force && !looks_.path; }

    void put(int lane);

    // Where the next sight goes: what there is to look for of it.
    ARM3R_INLINE Sight<T>& next() { return sights_[1 - last_]; }

    // From the next sight on; also where something other than the motion has changed, like a new sample's torque.
    ARM3R_INLINE void begin() { last_ = 1 - last_; }

    // From the last sight to the next one, where `moved`.
    template <class M>
    ARM3R_INLINE void advance(const M& moved) {
        const Sight<T>&before = sights_[last_], &now = next();
        const T dt = select(moved, T(now.t - before.t), T(0.0)), half = 0.5 * dt;
        if (looks_.force) judge_force(moved, half, before, now);
        if (looks_.path) {
            path_2_ = path_2_ + half * (before.path_error_2 + now.path_error_2);
            largest_path_2_ = max_where(moved, largest_path_2_, now.path_error_2);
        }
        if (looks_.limits) saturated_time_ = saturated_time_ + dt * before.saturated;
        share_out_work(moved, before, now);
        begin();
    }

    // Into the metrics of a lane.
    void tell(int lane, const Setup& setup, Metrics& metrics) const;

private:
    static constexpr double settled_share = 0.05, never = -std::numeric_limits<double>::infinity();

    template <class M>
    ARM3R_INLINE void judge_force(const M& moved, const T& half, const Sight<T>& before, const Sight<T>& now) {
        const T o(0.0);
        const T miss = now.force_wanted - now.force, miss_before = before.force_wanted - before.force;
        touching_time_ = touching_time_ + half * (before.touches + now.touches);
        miss_2_ = miss_2_ + half * (miss_before * miss_before * before.touches + miss * miss * now.touches);
        const auto in_touch = moved && now.touches > o;
        reached_ = select(in_touch && miss <= o, T(1.0), reached_);
        largest_miss_ = max_where(in_touch && reached_ > o, largest_miss_, T(abs(miss)));
        overshoot_ = max_where(in_touch, overshoot_, T(-miss));
        const auto unsettled = moved && abs(miss) > settled_share * abs(now.force_wanted);
        unsettled_until_ = select(unsettled, now.t, unsettled_until_);
    }

    // Exact where the torque is constant; else what the trapezoidal rule misses of the total is shared equally.
    template <class M>
    ARM3R_INLINE void share_out_work(const M& moved, const Sight<T>& before, const Sight<T>& now) {
        Vec3<T> part;
        for (int i = 0; i < 3; ++i) {
            const T tau = torque_is_held_ ? before.tau[i] : T(0.5 * (before.tau[i] + now.tau[i]));
            part[i] = tau * (now.q[i] - before.q[i]);
        }
        const T missing = ((now.work - before.work) - (part[0] + part[1] + part[2])) * (1.0 / 3);
        for (int i = 0; i < 3; ++i) work_[i] = work_[i] + select(moved, T(part[i] + missing), T(0.0));
    }

    const bool torque_is_held_;
    const Looks looks_;
    Sight<T> sights_[2];
    int last_ = 0;
    T touching_time_{0.0}, miss_2_{0.0}, reached_{0.0}, largest_miss_{0.0}, overshoot_{0.0};
    T unsettled_until_{never};
    T path_2_{0.0}, largest_path_2_{0.0}, saturated_time_{0.0};
    Vec3<T> work_{T(0.0), T(0.0), T(0.0)};
};

}  // namespace arm3r

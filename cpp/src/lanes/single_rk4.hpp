#pragma once
// A single run by RK4 (5.1), whose steps in which nothing happens are taken in one loop.

#include "lanes/lane_rk4.hpp"

namespace arm3r {

class SingleRk4 : public LaneRk4<double> {
    using Y = State<double, state_size>;

public:
    using LaneRk4<double>::LaneRk4;

    // Takes event-free steps, at most so many, that end before `until`: none in which the run, its budget or a formula of
    // time may end, the contact may change, the depth may have its greatest value, or a number may be out of range. The
    // next step is one of step(), which they leave the same bits as if it had taken them; the start of the last step and
    // what belongs to its end alone are not set.
    void take_event_free_steps(double until, int most) {
        if (!has_common_terms_ || is_controlled_ || performance_.samples() || may_be_ill_conditioned_ || has_failed())
            return;
        Moment now{t_, y_, f_, in_, tau_};
        EnergyBalance<double> balance = balance_;
        double accepted = accepted_;
        const double before = accepted, last = accepted + std::min(most, whole_steps_);
        while (accepted < last) {
            const double t1 = start_ + (accepted + 1.0) * step_;
            if (t1 >= until || !take_event_free_step(t1, now, balance)) break;
            accepted += 1;
        }
        t_ = now.t, y_ = now.y, f_ = now.f, in_ = now.in, tau_ = now.tau;
        balance_ = balance;
        whole_steps_ -= int(accepted - before);
        evaluations_ += 4 * (accepted - before);
        accepted_ = accepted;
    }

private:
    struct Moment {
        double t;
        Y y, f;
        Indentation<double> in;
        Vec3<double> tau;
    };

    // Moves `now` to t1 and returns whether the step is free of events; else changes nothing.
    ARM3R_INLINE bool take_event_free_step(double t1, Moment& now, EnergyBalance<double>& balance) {
        const double h = step_;
        Vec3<double> work = power_of(now.tau, now.y);
        Y y = stepped_alone<Terms::common>(now.t, now.y, now.f, h, work);
        if (!is_finite<Terms::common>(y) || is_out_of_range(y)) return false;
        if (performance_.is_on()) work = work_in_step(now.tau, now.y, y, h, work);
        drop_tiny_rates(y);
        rhs_.begin_step(y);
        const Pose<double> p = rhs_.pose_near(y);
        const Vec3<double> qd(y[3], y[4], y[5]);
        if (plant_.has_wall && !touch(t1, p, qd, now)) {
            rhs_.begin_step(now.y);
            return false;
        }
        now.t = t1, now.y = y;
        rhs_.common_derivative(t1, p, y, now.f, now.tau);
        balance.update(
            Energies<double>{kinetic_energy(plant_.arm, p, qd), potential_energy(plant_.arm, p), stored(now.in)}, y);
        if (performance_.is_on()) performance_.add_work(work, true);
        return true;
    }

    // Moves the indentation and the contact of `now` to t1, if nothing happens to them before.
    ARM3R_INLINE bool touch(double t1, const Pose<double>& p, const Vec3<double>& qd, Moment& now) {
        const double h = step_;
        Indentation<double> in = now.in;
        set_indentation(even_wall_at(plant_.wall, t1), p, qd, in);
        const Cubic depth(now.in.depth, h * now.in.rate, in.depth, h * in.rate);
        if (may_be_eventful(depth, now.in, in, h, true)) return false;
        contact_.add_elastic(contact_.touching(), depth.fourth, depth.mean(), h, t1);
        now.in = in;
        return true;
    }
};

}  // namespace arm3r

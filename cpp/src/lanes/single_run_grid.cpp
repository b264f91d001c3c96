#include "arm3r/numbers/eigen_traits.hpp"
#include "lanes/lane_rk4.hpp"
#include "lanes/single_run_template.hpp"

namespace arm3r {

namespace {

// A single run by RK4 (5.1), whose event-free steps are taken in one loop: nothing happens in them but the motion.
class SingleRk4 : public LaneRk4<double> {
    using Y = State<double, state_size>;

public:
    using LaneRk4<double>::LaneRk4;

    // Takes event-free steps, at most so many, that end before `until`, s: the run, its budget or a formula of time does
    // not end with them, the contact does not change, the depth has not its greatest value within them, and every number
    // is in range. The bits are those of step(), which must take the next step: the start of the last one, and the pose
    // and the energies at its end, are not set.
    void take_event_free_steps(double until, int most);

private:
    // What changes from step to step.
    struct Instant {
        double t;
        Y y, f;
        Indentation<double> in;
        Vec3<double> tau;
        EnergyBalance<double> balance;
    };

    bool take_event_free_step(double t1, Instant& now);
    bool move_indentation(double t1, const Pose<double>& p, const Vec3<double>& qd, Instant& now);
};

[[gnu::noinline]] void SingleRk4::take_event_free_steps(double until, int most) {
    if (!has_common_terms_ || is_controlled_ || performance_.samples() || may_be_ill_conditioned_ || has_failed())
        return;
    Instant now{t_, y_, f_, in_, tau_, balance_};
    double accepted = accepted_;
    const double before = accepted, last = accepted + std::min(most, whole_steps_);
    while (accepted < last) {
        const double t1 = start_ + (accepted + 1.0) * step_;
        if (t1 >= until || !take_event_free_step(t1, now)) break;
        accepted += 1;
    }
    t_ = now.t, y_ = now.y, f_ = now.f, in_ = now.in, tau_ = now.tau, balance_ = now.balance;
    whole_steps_ -= int(accepted - before);
    evaluations_ += 4 * (accepted - before);
    accepted_ = accepted;
}

// Moves `now` to t1 and returns whether the step is free of events; else changes nothing.
ARM3R_INLINE bool SingleRk4::take_event_free_step(double t1, Instant& now) {
    const double h = step_;
    Vec3<double> work;
    if (sums_work()) work = power_of(now.tau, now.y);
    Y y = stepped_alone<Terms::common>(now.t, now.y, now.f, h, work);
    if (!is_finite<Terms::common>(y) || is_out_of_range(y)) return false;
    if (performance_.sums_work()) work = work_in_step(now.tau, now.y, y, h, work);
    drop_tiny_rates(y);
    rhs_.begin_step(y);
    const Pose<double> p = rhs_.pose_near(y);
    const Vec3<double> qd(y[3], y[4], y[5]);
    if (plant_.has_wall && !move_indentation(t1, p, qd, now)) {
        rhs_.begin_step(now.y);
        return false;
    }
    now.t = t1, now.y = y;
    rhs_.common_derivative(t1, p, y, now.f, now.tau);
    now.balance.update(
        Energies<double>{kinetic_energy(plant_.arm, p, qd), potential_energy_of_pose(plant_.arm, p), stored(now.in)},
        y);
    if (performance_.sums_work()) performance_.add_work(work, true);
    return true;
}

// Moves the indentation of `now` and the contact to t1, if nothing happens to them before.
ARM3R_INLINE bool SingleRk4::move_indentation(double t1, const Pose<double>& p, const Vec3<double>& qd, Instant& now) {
    const double h = step_;
    Indentation<double> in = now.in;
    set_indentation(plant_.wall, even_wall_at(plant_.wall, t1), tip_position(plant_.arm, p),
                    tip_velocity(plant_.arm, p, qd), in);
    const Cubic depth(now.in.depth, h * now.in.rate, in.depth, h * in.rate);
    if (may_be_eventful(depth, now.in, in, h, t1, true)) return false;
    contact_.add_elastic(contact_.touching(), depth.fourth, depth.mean(), h, t1);
    now.in = in;
    return true;
}

}  // namespace

SingleRunMethod single_run_on_grid() { return single_run_by<SingleRk4>(); }
SingleRunMethod single_run_on_grid_with_memory() { return single_run_by<LaneRk4<double, full_size>>(); }

}  // namespace arm3r

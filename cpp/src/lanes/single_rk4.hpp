#pragma once
// A single run by RK4 (5.1), whose event-free steps are taken in one loop: nothing happens in them but the motion.

#include "lanes/lane_rk4.hpp"

namespace arm3r {

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

}  // namespace arm3r

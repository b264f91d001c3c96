#pragma once
// The state that a user's law gets, and the torque that it returns, in the arm's convention.

#include "arm3r/arm3r.h"
#include "control/sampled_controller.hpp"
#include "setup/setup.hpp"

namespace arm3r {

class LawView {
public:
    explicit LawView(const Setup& setup)
        : arm_(setup.plant.arm),
          wall_(setup.plant.wall),
          has_wall_(setup.plant.has_wall),
          observes_(setup.observes()),
          estimates_(setup.estimation.on),
          convention_(setup.convention),
          period_(setup.digital.sampling.period) {}

    // Fills a state of zeros, or one that was filled before.
    void fill_state(double tick, const GroundTruth& truth, const Measurement<double>& sensed,
                    const ControllerState<double>& controller_state, arm3r_law_state& state) const;

    Vec3<double> torque(const double* tau) const;  // slide

private:
    void write_angles(const Vec3<double>& q, double* out) const;
    void write_joints(const Vec3<double>& v, double* out) const;  // rates, torques and rows of the Jacobian

    Arm<double> arm_;
    Wall<double> wall_;
    bool has_wall_, observes_, estimates_;
    JointConvention convention_;
    double period_;
};

}  // namespace arm3r

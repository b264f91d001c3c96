#pragma once
// The probable cause of a run that ended badly: an unstable sampled loop, or a pose in which the Jacobian of a law has
// no inverse. Each cause is one sentence with its instant and its number.

#include <optional>
#include <string>

#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// Detects whether the torque of a sampled loop oscillates between its samples, and how fast that grows.
class TorqueOscillation {
public:
    // The torque that acts from t on; may be called several times with the same one.
    void include(double t, const Vec3<double>& tau) {
        if (tau[0] != last_[0] || tau[1] != last_[1] || tau[2] != last_[2]) add(t, tau);
    }

    std::optional<std::string> error_message(double period) const;

private:
    // Statistics of a few changes of the torque, N m: the sum of the changes of all joints less that of their net
    // change, and the largest torque.
    struct Block {
        Vec3<double> first{0, 0, 0}, way{0, 0, 0};
        double begin = 0, largest = 0;
        int changes = 0;
    };

    void add(double t, const Vec3<double>& tau);
    void close(double t);

    Vec3<double> last_{0, 0, 0};
    Block block_;
    // of the consecutive blocks that oscillated; < 0: none
    double since_ = -1, until_ = -1, first_swing_ = 0, last_swing_ = 0;
};

// Advice on how to make the solution more accurate.
const char* accuracy_advice(const Solver& solver);

// For a law that inverts the Jacobian: the first singular pose that the arm passed, or the pose nearest to one in the
// rows or at the end, q in rad, slide; empty if none is near.
std::optional<std::string> singular_pose(const Setup& setup, const Run& run, const Vec3<double>& q);

// Of an observer at joints with friction: the largest residual in the rows before anything has touched or pushed the arm,
// where it is not small beside that friction, and whether that explains it.
std::optional<std::string> friction_in_residual(const Setup& setup, const Run& run);

// Of a run by rk4: the first contact that began or ended within a step and made the torque or the force jump there (5.1).
std::optional<std::string> jump_at_contact(const Setup& setup, const Run& run);

// Of a run without contact whose controller was to press: how near to the wall the tip came, in the rows.
std::optional<std::string> missed_contact(const Setup& setup, const Run& run, double contacts);

}  // namespace arm3r

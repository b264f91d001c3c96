#pragma once
// What lies behind a run that ended badly, where it can be seen from outside: a sampled loop that is unstable, or a pose in
// which a law finds no inverse of the Jacobian. Each cause is one sentence with its instant and its number.

#include <optional>
#include <string>

#include "record/run_data.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// Whether the torque of a sampled loop goes to and fro between its samples, and how fast that grows.
class TorqueSwings {
public:
    // The torque that acts from t on; called as often as one likes.
    void note(double t, const Vec3<double>& tau) {
        if (tau[0] != last_[0] || tau[1] != last_[1] || tau[2] != last_[2]) add(t, tau);
    }

    std::optional<std::string> complaint(double period) const;

private:
    // Of some changes of the torque, N m: the sum of their sizes over all joints less that of their sums, and the largest torque.
    struct Block {
        Vec3<double> first{0, 0, 0}, way{0, 0, 0};
        double begin = 0, largest = 0;
        int changes = 0;
    };

    void add(double t, const Vec3<double>& tau);
    void close(double t);

    Vec3<double> last_{0, 0, 0};
    Block block_;
    double since_ = -1, until_ = -1, first_swing_ = 0, last_swing_ = 0;  // of the blocks in a row that swung; < 0: none
};

// How to have the motion followed more closely.
const char* accuracy_advice(const Solver& solver);

// Where a law that inverts the Jacobian came closest to a pose without an inverse, in the rows or at the end, if that is
// close. q: rad, slide.
std::optional<std::string> singular_pose(const Setup& setup, const Run& run, const Vec3<double>& q);

}  // namespace arm3r

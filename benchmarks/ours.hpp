#pragma once
// The jobs as arm3r does them.

#include <array>
#include <vector>

#include "setup.hpp"

namespace bench {

inline constexpr double step = 1e-3;           // s
inline constexpr int steps_per_run = 1000;     // then from the start again
inline constexpr std::size_t state_count = 1024;

using Joints = std::array<double, 3>;

struct Query {
    Joints q, qd, tau;
};

const std::vector<Query>& queries();  // the same ones for everyone, spread over the workspace

arm3r::Setup free_fall();          // the lecture's arm, let go
arm3r::Setup compensated_at_wall();  // held up, and pushed by the moving wall

void forward_dynamics(const arm3r::Arm<double>& arm, const Query& query, Joints& qdd);

// The motion from the setup's start, as the simulator steps it. `Size` components of the state: with or without the books.
template <std::size_t Size> class Stepper {
public:
    explicit Stepper(const arm3r::Setup& setup);
    void start();
    void step();
    const arm3r::State<double, Size>& state() const { return y_; }

private:
    arm3r::Setup setup_;
    arm3r::RightHandSide<double, double> rhs_;
    arm3r::State<double, Size> y_, f_;
    double t_;
};

}  // namespace bench

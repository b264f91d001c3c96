#pragma once
// The jobs as arm3r does them.

#include <array>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "arm3r/numbers/eigen_traits.hpp"
#include "setup/setup.hpp"

namespace bench {

inline constexpr double step = 1e-3;        // s
inline constexpr int steps_per_run = 1000;  // then from the start again
inline constexpr std::size_t state_count = 1024;

using Joints = std::array<double, 3>;

struct Query {
    Joints q, qd, tau;
};

const std::vector<Query>& queries();  // the same ones for everyone, spread over the workspace

std::vector<double> free_fall();            // the lecture's arm, released
std::vector<double> compensated_at_wall();  // held up, and pushed by the moving wall
std::vector<double> elbow_free_fall();      // the same of a UR5 with its wrist locked
std::vector<double> elbow_compensated_at_wall();

void forward_dynamics(const arm3r::Arm<double>& arm, const Query& query, Joints& qdd);

// The motion from the setup's start, stepped by RK4 only. `Size` components of the state: with or without the
// quadratures.
template <std::size_t Size>
class Stepper {
public:
    explicit Stepper(const std::vector<double>& params);
    void start();
    void advance(int steps);
    const arm3r::State<double, Size>& state() const { return y_; }

private:
    arm3r::Setup setup_;
    arm3r::RightHandSide<double, double> rhs_;
    arm3r::State<double, Size> y_, f_;
    double t_;
};

// The same steps of as many arms in parallel as this processor's registers hold, each with its own numbers and pose;
// they count arm by arm.
template <std::size_t Size>
class PackStepper {
public:
    explicit PackStepper(const std::vector<double>& params);
    void start() { taken_ = 0; }
    void advance(int steps);

private:
    template <int N>
    void march(int steps);

    arm3r::Setup setup_;
    std::tuple<arm3r::Plant<arm3r::Pack<2>>, arm3r::Plant<arm3r::Pack<4>>, arm3r::Plant<arm3r::Pack<8>>> plants_;
    int taken_ = 0;
    double sum_ = 0;  // so that the result is used
};

// The same steps within a whole run: after each step contact, energy balance and conditioning are checked; two rows are
// logged. As a Stepper it has its setup before it is timed, for as many steps as the last time.
class WholeRun {
public:
    explicit WholeRun(std::vector<double> params) : params_(std::move(params)) {}
    void advance(int steps);

private:
    void prepare(int steps);

    std::vector<double> params_;
    int steps_ = 0;
    std::optional<arm3r::Setup> setup_;
};

}  // namespace bench

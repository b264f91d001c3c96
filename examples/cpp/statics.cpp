// The joint torques with which the arm at rest presses with 20 N on a wall: tau = tau_g + J^T f.

#include <arm3r/arm3r.hpp>
#include <cstdio>

using namespace arm3r::api;

int main() {
    const Arm arm = Scenario("{format: 1, arm: {link2: {length: 0.6}, link3: {length: 0.4}}}").arm();
    const std::optional<Vector> q = arm.inverse_kinematics({0.7, 0.1, 0.2});
    if (!q) return 1;
    const Vector force = {20, 0, 0}, weight = arm.gravity_torque(*q);  // N, on the wall; N m
    const Matrix J = arm.jacobian(*q);
    std::printf("joint  weight  and 20 N\n");
    for (std::size_t i = 0; i < 3; ++i) {
        const double press = J[i] * force[0] + J[3 + i] * force[1] + J[6 + i] * force[2];
        std::printf("%5zu %7.3f %9.3f N m\n", i + 1, weight[i], weight[i] + press);
    }
}

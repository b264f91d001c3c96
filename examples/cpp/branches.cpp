// A run that is stepped by hand: at the moment of contact it branches, and each branch goes on with another damping.

#include <arm3r/arm3r.hpp>
#include <cstdio>

using namespace arm3r::api;

// 20 N along x, which a spring keeps at its height.
Vector torque(const arm3r_law_state& state, double damping) {
    const Vector f = {20, -500 * state.tip[1], -500 * state.tip[2]};  // N
    Vector tau;
    for (std::size_t i = 0; i < 3; ++i) {
        tau[i] = state.tau_g[i] - damping * state.qd[i];
        for (std::size_t k = 0; k < 3; ++k) tau[i] += state.jacobian[3 * k + i] * f[k];  // J^T f
    }
    return tau;
}

int main() {
    Simulation simulation(Scenario(R"(
format: 1
wall: {point: [1.75, 0, 0], motion: {type: fixed}, contact: {stiffness: 5000}, acts_on_arm: true}
controller: {type: user}
sampling: {rate: 1000}
time: {stop: 1}
)"));
    while (simulation.state().contact == 0) simulation.step(torque(simulation.state(), 1));
    std::printf("contact at %.3f s\n", simulation.state().t);
    for (const double damping : {1, 3, 10}) {
        Simulation branch = simulation;
        while (!branch.is_over()) branch.step(torque(branch.state(), damping));
        const Run run = branch.run();
        std::printf("damping %2g N m s/rad: %zu events, %.2f N in the end\n", damping, run.events().size(),
                    run.column("f_on_wall_x").back());
    }
}

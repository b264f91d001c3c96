// A wall that hits the arm: when, how hard, and how it ends. A mistake in the scenario is answered with its place.

#include <arm3r/arm3r.hpp>
#include <cstdio>

using namespace arm3r::api;

int main() {
    Scenario scenario(R"(
format: 1
wall: {point: [1.9, 0, 0], contact: {stiffness: 1000}, motion: {type: constant, velocity: 0.5}, acts_on_arm: true}
controller: {type: gravity_compensation}
time: {stop: 1}
)");
    const Run run = scenario.run();
    for (const arm3r_event& event : run.events())
        std::printf("%s at %.4f s\n", event.type == 0 ? "contact" : "release", event.t);
    const auto depth = run.column("depth");
    std::printf("%zu rows, the last with a depth of %.4f m\n", depth.size(), depth.back());
    try {
        scenario.set("wall.contact.stifness", "2000").validate();
    } catch (const ScenarioError& error) {
        std::printf("%s\n", error.what());
    }
}

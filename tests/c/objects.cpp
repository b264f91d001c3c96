// arm3r.hpp against the C interface that it stands on: the same bits, and failures that come out as what they are. Prints
// what does not hold.

#include <arm3r/arm3r.hpp>
#include <cmath>
#include <cstdio>
#include <stdexcept>

using namespace arm3r::api;

namespace {

int failures = 0;

void require(bool holds, const char* what) {
    if (holds) return;
    std::printf("does not hold: %s\n", what);
    ++failures;
}

template <class Failure, class Work>
bool throws(Work work) {
    try {
        work();
        return false;
    } catch (const Failure&) {
        return true;
    }
}

const char* const pressed = R"(
format: 1
arm: {link2: {length: 0.9}, link3: {length: 0.7}}
wall: {point: [1.45, 0, 0], motion: {type: constant, velocity: 0.3}, contact: {stiffness: 1500}, acts_on_arm: true}
controller: {type: user}
sampling: {rate: 500}
time: {stop: 0.4}
)";

Vector damped(const arm3r_law_state& state) {
    Vector tau;
    for (std::size_t i = 0; i < 3; ++i) tau[i] = state.tau_g[i] - 2 * state.qd[i];
    return tau;
}

void check_arm() {
    const Arm arm = Scenario(pressed).arm();
    const Vector q = {0.4, -0.3, 0.9}, qd = {0.2, -0.7, 0.5}, tau = {1.5, -2, 0.3}, f = {3, -1, 2};
    const Vector again = arm.inverse_dynamics(q, qd, arm.forward_dynamics(q, qd, tau, f), f);
    for (std::size_t i = 0; i < 3; ++i)
        require(std::abs(again[i] - tau[i]) < 1e-12, "inverse dynamics undo forward dynamics");
    const Vector still = arm.inverse_dynamics(q, qd, {}), product = arm.velocity_product(q, qd),
                 weight = arm.gravity_torque(q), inertial = arm.inverse_dynamics(q, {}, {0, 1, 0});
    const Matrix M = arm.mass_matrix(q);
    for (std::size_t i = 0; i < 3; ++i) {
        require(std::abs(still[i] - product[i] - weight[i]) < 1e-12, "without acceleration there are C qd and g");
        require(std::abs(inertial[i] - weight[i] - M[3 * i + 1]) < 1e-12, "a column of M");
    }
    require(!arm.inverse_kinematics({5, 0, 0}), "out of reach is no pose");
    require(throws<UsageError>([&] { arm.tip_position({NAN, 0, 0}); }), "no number is a mistake of the caller");
}

void check_laws() {
    const Scenario scenario(pressed);
    const Run run = scenario.run(damped);
    Simulation simulation(scenario);
    while (!simulation.is_over()) simulation.step(damped(simulation.state()));
    const Run stepped = simulation.run();
    require(run.outcome() == ARM3R_RUN_OK && run.rows() == stepped.rows(), "both come to their end");
    for (const std::string& name : run.columns())
        for (std::size_t i = 0; i < run.rows(); ++i)
            require(run.column(name)[i] == stepped.column(name)[i], name.c_str());
    const auto fails = [](const arm3r_law_state&) -> Vector { throw std::domain_error("from the law"); };
    require(throws<std::domain_error>([&] { scenario.run(fails); }), "what a law throws comes out");
    require(throws<std::out_of_range>([&] { run.column("no such column"); }), "a column that there is not");
}

void check_batch() {
    const Scenario scenario = Scenario(pressed).set("controller", "{type: gravity_compensation}");
    const std::vector<double> stiffness = {500, 1500, 4000};
    const Batch batch(scenario, {"wall.contact.stiffness"}, {stiffness});
    require(batch.size() == 3, "three runs");
    for (std::size_t i = 0; i < stiffness.size(); ++i) {
        const Run alone = Scenario(scenario).set("wall.contact.stiffness", std::to_string(stiffness[i])).run();
        const auto x = alone.column("tip_x");
        require(std::abs(batch["tip_x"][i] - x.back()) < 1e-12 && batch["contacts"][i] == 1, "a run of the batch");
    }
    require(throws<std::invalid_argument>([&] { Batch(scenario, {"time.stop", "time.start"}, {stiffness, {0}}); }),
            "lists of different lengths");
    require(throws<UsageError>([&] { Batch(scenario, {"no.such.key"}, {stiffness}); }), "a key that there is not");
    require(throws<std::out_of_range>([&] { batch["no such number"]; }), "a number that there is not");
}

void check_scenarios() {
    Scenario first(pressed), second = first;
    second.set("time.stop", "0.2");
    require(first.at("time.stop") == "0.4" && second.at("time.stop") == "0.2", "a copy is one of its own");
    first = second;
    require(first.at("time.stop") == "0.2", "an assignment");
    require(throws<UsageError>([] { Scenario::load("/no/such/file.yaml"); }), "a file that there is not");
    require(throws<ScenarioError>([] { Scenario("format: 1\nwal: {}\n").validate(); }), "a key that there is not");
    require(throws<OutputError>([&] { first.run(damped).save("/no/such/folder/run.csv"); }),
            "a folder that there is not");
    require(throws<IncompatibleError>([] { Scenario("format: 99\n").validate(); }), "another format");
}

}  // namespace

int main() {
    check_arm();
    check_laws();
    check_batch();
    check_scenarios();
    return failures != 0;
}

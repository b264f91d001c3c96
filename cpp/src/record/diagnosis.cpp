#include "record/diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"
#include "setup/make_controller.hpp"

namespace arm3r {
namespace {

constexpr int changes_per_block = 4;
constexpr double min_swing = 1;    // relative to the largest torque: the torque changed back by half its size
constexpr double min_growth = 10;  // growth from the first oscillating block to the last one
constexpr double close_to_singular = 1e-3;
constexpr double a_visible_share = 0.1;  // of the friction, as a residual

double to_thousandths(double x) { return nearest_integer(1000 * x) / 1000; }

double determinant(const Arm<double>& arm, const Vec3<double>& q) { return jacobian_determinant(arm, pose(q)); }

// No pose has a larger one.
double max_determinant(const Arm<double>& arm) {
    const double a2 = arm.link2.length, a3 = arm.link3.length;
    return a2 * a3 * reach(arm);
}

// What is no continuous function of time where the contact begins or ends; null: nothing.
const char* what_jumps(const Setup& setup, const Event& event) {
    const Controller<double>& law = setup.controller();
    if (!setup.digital.sampling.on && tracks_force(law.type) &&
        (law.switching != Switching::always || integrates_force(law.type)))
        return "the law switches, and sees this only at the end of the step";
    const Plant<double>& plant = setup.plant;
    if (!plant.acts_on_arm) return nullptr;
    if (plant.contact.damping > 0) return "the wall's damping makes the force jump";
    const Vec3<double> tip(event.tip[0], event.tip[1], event.tip[2]);
    const Indentation<double> in = indentation(plant.wall, wall_at(plant.wall, event.t), tip, {0, 0, 0});
    const bool at_edge = std::abs(inside_outline(plant.wall, in)) < std::abs(in.depth);
    return at_edge ? "the tip passes the edge of the plate, and the force jumps" : nullptr;
}

}  // namespace

const char* accuracy_advice(const Solver& solver) {
    switch (solver.method) {
        case SolverMethod::rk4: return "take a smaller solver.step";
        case SolverMethod::taylor: return "tighten solver.tol, or limit solver.max_step";
        default:
            return solver.atol > solver.rtol ? "tighten solver.atol, or limit solver.max_step"
                                             : "tighten solver.rtol, or limit solver.max_step";
    }
}

void TorqueOscillation::add(double t, const Vec3<double>& tau) {
    if (block_.changes == 0) block_ = {.first = last_, .way = {0, 0, 0}, .begin = t, .largest = 0, .changes = 0};
    for (int i = 0; i < 3; ++i) {
        block_.way[i] += std::abs(tau[i] - last_[i]);
        block_.largest = std::max(block_.largest, std::abs(tau[i]));
    }
    last_ = tau;
    if (++block_.changes == changes_per_block) close(t);
}

void TorqueOscillation::close(double t) {
    double swing = 0;
    for (int i = 0; i < 3; ++i) swing += block_.way[i] - std::abs(last_[i] - block_.first[i]);
    block_.changes = 0;
    if (!(swing > min_swing * block_.largest)) {
        since_ = -1;
        return;
    }
    if (since_ < 0) {
        since_ = block_.begin;
        first_swing_ = swing;
    }
    until_ = t;
    last_swing_ = swing;
}

std::optional<std::string> TorqueOscillation::error_message(double period) const {
    if (since_ < 0 || !(last_swing_ > min_growth * first_swing_)) return std::nullopt;
    const double samples = std::max(1.0, (until_ - since_) / period - changes_per_block);
    const double growth = exp(log(last_swing_ / first_swing_) / samples);
    return "the sampled loop is unstable: from t = " + shortest(since_) +
           " s on the torque oscillates, and its amplitude grows by a factor of " + shortest(to_thousandths(growth)) +
           " per sample; use a higher sampling.rate, less delay, or lower gains";
}

std::optional<std::string> singular_pose(const Setup& setup, const Run& run, const Vec3<double>& q) {
    if (!inverts_jacobian(setup.controller())) return std::nullopt;
    const std::string inverts = "the law inverts the Jacobian, and the arm ",
                      advice = "; keep the arm bent, or use a law without an inverse, such as stiffness";
    if (const auto& passed = run.singular_passage)
        return inverts + "passed a singular pose at t = " + rounded(passed->t, 9) + " s, q = " + rounded(passed->q, 6) +
               " rad" + advice;
    const Arm<double>& model = setup.controller().model;
    double closest = determinant(model, q), when = run.t_end;
    const auto t = run.find(ColumnIndex("t"));
    const auto q1 = run.find(ColumnIndex("q1")), q2 = run.find(ColumnIndex("q2")), q3 = run.find(ColumnIndex("q3"));
    for (std::size_t row = 0; row < run.rows; ++row) {
        const Vec3<double> there(q1[row], q2[row], q3[row]);
        const double here = determinant(model, setup.convention.to_slide(there));
        if (std::abs(here) < std::abs(closest)) closest = here, when = t[row];
    }
    const double share = std::abs(closest) / max_determinant(model);
    if (!(share < close_to_singular)) return std::nullopt;
    return inverts + "came close to a singular pose at t = " + shortest(when) +
           " s, where det J = " + shortest(closest) + " m^3 is " + shortest(share) + " of the largest" + advice;
}

std::optional<std::string> friction_in_residual(const Setup& setup, const Run& run) {
    if (!setup.observes()) return std::nullopt;
    const ExternalForce<double>& push = setup.plant.external_force;
    const double until =
        std::min(run.events.empty() ? infinite : run.events.front().t, push.on ? push.start : infinite);
    constexpr ColumnIndex residual[] = {"residual1", "residual2", "residual3"};
    const auto t = run.find(ColumnIndex("t"));
    double largest = 0, when = 0, friction = 0;
    int joint = 0;
    for (int i = 0; i < 3; ++i) {
        const double own = std::max(setup.plant.arm.friction[i], setup.controller().model.friction[i]);
        const std::span<const double> r = run.find(residual[i]);
        for (std::size_t row = 0; row < r.size() && t[row] < until; ++row)
            if (own > 0 && std::abs(r[row]) > std::max(largest, a_visible_share * own))
                largest = std::abs(r[row]), when = t[row], joint = i + 1, friction = own;
    }
    if (joint == 0) return std::nullopt;
    constexpr double a_sum = 2;  // of the friction of the arm and that of the model
    const bool is_friction = largest <= a_sum * friction;
    return "the residual of the observer reached " + rounded(largest, 4) + " N m in joint " + std::to_string(joint) +
           " at t = " + rounded(when, 6) + " s, before anything touched the arm: " +
           (is_friction ? "the friction of this joint, " + rounded(friction, 4) +
                              " N m, can be taken for an external "
                              "torque; give controller.model the friction of the arm, or keep "
                        : "more than its friction, " + rounded(friction, 4) +
                              " N m, explains; compare controller.model with the arm, or keep ") +
           "observer.threshold above it";
}

std::optional<std::string> jump_at_contact(const Setup& setup, const Run& run) {
    if (!setup.solver.is_on_grid()) return std::nullopt;
    for (const Event& event : run.events) {
        const char* what = event.t > setup.start ? what_jumps(setup, event) : nullptr;
        if (!what) continue;
        return std::string("contact ") + (event.type == Event::make ? "begins" : "ends") +
               " at t = " + rounded(event.t, 9) + " s within a step of rk4, where " + what +
               ": that step is of first order, and so is what follows; compare with a smaller solver.step, or take "
               "solver.events: located, or method: dopri5: their steps end there";
    }
    return std::nullopt;
}

std::optional<std::string> missed_contact(const Setup& setup, const Run& run, double contacts) {
    const Controller<double>& law = setup.controller();
    const double wanted = std::max(law.reference.force, law.reference.force_before);
    if (contacts > 0 || !setup.plant.has_wall || !tracks_force(law.type) || !(wanted > 0)) return std::nullopt;
    std::string message = "no contact: reference.force wants " + shortest(wanted) + " N";
    const std::span<const double> depths = run.find(ColumnIndex("depth"));
    const double nearest = depths.empty() ? infinite : -std::ranges::max(depths);
    if (nearest >= 0 && nearest < infinite)  // below 0 the tip is beside the plate
        message += ", and in the rows the tip came no nearer to the wall than " + rounded(nearest, 4) + " m";
    return message + (law.switching == Switching::always
                          ? "; move the reference or the wall towards the other"
                          : "; without contact the tip keeps to its reference: let it lead to the wall, or take "
                            "controller.switching: always");
}

}  // namespace arm3r

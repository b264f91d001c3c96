#include "record/metrics.hpp"

#include <iterator>

namespace arm3r {

namespace {

using R = const Metrics&;

constexpr SummaryNumber numbers[] = {
    {"outcome", "1", "how the run ended: 0 ok, else the index of its name", [](R r) { return double(r.outcome); }},
    {"t_end", "s", "time reached", [](R r) { return r.t_end; }},
    {"contacts", "1", "how often contact was made", [](R r) { return r.contacts; }},
    {"first_contact", "s", "when contact was first made", [](R r) { return r.first_contact; }},
    {"first_release", "s", "when contact was first lost", [](R r) { return r.first_release; }},
    {"contact_time", "s", "time in contact", [](R r) { return r.contact_time; }},
    {"peak_force", "N", "largest normal contact force", [](R r) { return r.peak_force; }},
    {"final_force", "N", "normal contact force at the end", [](R r) { return r.final_force; }},
    {"impulse", "N s", "integral of the normal contact force", [](R r) { return r.impulse; }},
    {"q1", "rad", "joint angle 1 at the end", [](R r) { return r.q[0]; }},
    {"q2", "rad", "joint angle 2 at the end", [](R r) { return r.q[1]; }},
    {"q3", "rad", "joint angle 3 at the end", [](R r) { return r.q[2]; }},
    {"qd1", "rad/s", "joint rate 1 at the end", [](R r) { return r.qd[0]; }},
    {"qd2", "rad/s", "joint rate 2 at the end", [](R r) { return r.qd[1]; }},
    {"qd3", "rad/s", "joint rate 3 at the end", [](R r) { return r.qd[2]; }},
    {"tip_x", "m", "tip position along base x at the end", [](R r) { return r.tip[0]; }},
    {"tip_y", "m", "tip position along base y at the end", [](R r) { return r.tip[1]; }},
    {"tip_z", "m", "tip position along base z at the end", [](R r) { return r.tip[2]; }},
    {"work_actuators", "J", "work of the applied torques", [](R r) { return r.work_of_actuators; }},
    {"work_wall", "J", "work of the wall's drive on the arm, and of a push", [](R r) { return r.work_of_wall; }},
    {"energy_dissipated", "J", "energy lost to friction, damping and contact", [](R r) { return r.dissipated; }},
    {"ledger_residual", "J", "largest residual of the energy balance at the end of a step",
     [](R r) { return r.ledger_residual; }},
    {"force_error_rms", "N", "root mean square of the force error over the time in contact",
     [](R r) { return r.force_error_rms; }, MetricGroup::force_error},
    {"force_error_peak", "N", "largest force error in contact since the force first reached its reference",
     [](R r) { return r.force_error_peak; }, MetricGroup::force_extremes},
    {"overshoot", "N", "largest force above its reference; 0 if it is never above", [](R r) { return r.overshoot; },
     MetricGroup::force_extremes},
    {"settling_time", "s", "from first contact until the force stays within 5 % of its reference",
     [](R r) { return r.settling_time; }, MetricGroup::settling},
    {"tip_path_error_rms", "m", "root mean square of the tip's distance from its reference",
     [](R r) { return r.path_error_rms; }, MetricGroup::path_error},
    {"tip_path_error_max", "m", "largest distance of the tip from its reference", [](R r) { return r.path_error_max; },
     MetricGroup::path_maximum},
    {"work_1", "J", "work of torque 1", [](R r) { return r.work[0]; }, MetricGroup::work},
    {"work_2", "J", "work of torque 2", [](R r) { return r.work[1]; }, MetricGroup::work},
    {"work_3", "J", "work of torque 3", [](R r) { return r.work[2]; }, MetricGroup::work},
    {"saturation_share", "1", "share of the time in which a torque is at its limit",
     [](R r) { return r.saturation_share; }, MetricGroup::saturation},
    {"stiffness_estimate", "N/m", "the wall's stiffness by least squares, where it is identifiable",
     [](R r) { return r.stiffness_estimate; }},
    {"wall_speed_estimate", "m/s", "the wall's speed towards the arm by least squares, where it is identifiable",
     [](R r) { return r.wall_speed_estimate; }},
    {"steps.accepted", "1", "steps taken", [](R r) { return double(r.steps.accepted); }},
    {"steps.rejected", "1", "steps tried again with a smaller one", [](R r) { return double(r.steps.rejected); }},
    {"steps.evaluations", "1", "evaluations of the equation of motion",
     [](R r) { return double(r.steps.evaluations); }},
    {"steps.stiff", "1", "steps taken by the method for stiff equations", [](R r) { return r.stiff_steps; }},
    {"peak_force_time", "s", "when the normal contact force was largest", [](R r) { return r.peak_force_time; }},
    {"energy_dissipated_joints", "J", "the part lost to damping and friction of the joints",
     [](R r) { return r.dissipated_parts[0]; }},
    {"energy_dissipated_contact", "J",
     "the part lost in the contact along its normal and by springs that are still loaded when contact ends",
     [](R r) { return r.dissipated_parts[1]; }},
    {"energy_dissipated_friction", "J", "the part lost to friction along the wall",
     [](R r) { return r.dissipated_parts[2]; }},
    {"energy_dissipated_edges", "J", "the part lost where the tip left the plate across an edge",
     [](R r) { return r.dissipated_parts[3]; }},
    {"first_contact_peak", "N",
     "largest normal force in the first 0.5 s of the first contact: transient (ISO/TS 15066)",
     [](R r) { return r.first_peak; }},
    {"first_contact_peak_time", "s", "when the first contact had that force", [](R r) { return r.first_peak_time; }},
    {"stiffness_sigma", "N/m", "standard deviation of stiffness_estimate, where it is identifiable",
     [](R r) { return r.stiffness_sigma; }},
};

}  // namespace

const std::vector<SummaryNumber>& summary_table() {
    static const std::vector<SummaryNumber> table(std::begin(numbers), std::end(numbers));
    return table;
}

void set_end_values(const Setup& setup, double t, const FullState& y, bool is_touching, const ContactTally& contacts,
                    const Peak& peak, Metrics& metrics) {
    metrics.t_end = t;
    metrics.q = angles_out(setup, angles(y));
    metrics.qd = rates_out(setup, rates(y));
    metrics.tip = without_negative_zero(tip_position(setup.plant.arm, pose(angles(y))));
    metrics.work_of_actuators = y[work_of_actuators];
    metrics.work_of_wall = y[work_of_wall];
    metrics.dissipated = y[dissipated];
    metrics.dissipated_parts = dissipated_parts(setup.plant, y, contacts.lost_at_edges);
    metrics.contacts = contacts.contacts;
    metrics.first_contact = contacts.first_contact;
    metrics.first_release = contacts.first_separation;
    metrics.contact_time = contacts.contact_time(t, is_touching);
    metrics.peak_force = peak.force;
    if (contacts.contacts == 0) return;
    metrics.peak_force_time = peak.t;
    const Peak first = contacts.peak_of_first(peak);
    metrics.first_peak = first.force;
    metrics.first_peak_time = first.t;
}

}  // namespace arm3r

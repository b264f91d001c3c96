#include "control/controller_view.hpp"

namespace arm3r {
namespace {

// One by one: read in pairs, numbers that were just written have to be waited for. + 0.0: no negative zero.
void write(const Vec3<double>& v, double* out) {
    out[0] = v[0] + 0.0;
    out[1] = v[1] + 0.0;
    out[2] = v[2] + 0.0;
}

}  // namespace

void LawView::write_angles(const Vec3<double>& q, double* out) const { write(convention_.from_slide(q), out); }
void LawView::write_joints(const Vec3<double>& v, double* out) const { write(convention_.flipped(v), out); }

void LawView::fill_state(double tick, const GroundTruth& truth, const Measurement<double>& sensed,
                         const ControllerState<double>& controller_state, arm3r_law_state& state) const {
    state.tick = tick;
    state.t = sensed.t;
    state.period = period_;
    write_angles(sensed.q, state.q);
    write_joints(sensed.qd, state.qd);
    write(tip_position(arm_, sensed.pose), state.tip);
    write(tip_velocity(arm_, sensed.pose, sensed.qd), state.tip_velocity);
    const Mat3<double> J = jacobian(arm_, sensed.pose);
    for (int row = 0; row < 3; ++row) write_joints({J(row, 0), J(row, 1), J(row, 2)}, state.jacobian + 3 * row);
    write_joints(gravity_torque(arm_, sensed.pose), state.tau_g);
    write(sensed.f_on_tip, state.f_on_tip);
    state.contact = sensed.contact;
    if (has_wall_) {
        const WallState<double> wall = wall_at(wall_, sensed.t);
        Vec3<double> point = wall.position;
        for (int i = 0; i < 3; ++i) point[i] = point[i] + wall_.face_offset * sensed.n[i];
        write(sensed.n, state.wall_normal);
        write(point, state.wall_point);
        write(wall.velocity, state.wall_velocity);
    }
    if (observes_) {
        write_joints(controller_state.residual, state.residual);
        state.collision = controller_state.collision;
    }
    if (estimates_) {
        state.stiffness_estimate = controller_state.stiffness;
        state.stiffness_sigma = controller_state.stiffness_sigma;
        state.wall_speed_estimate = controller_state.wall_speed;
        state.identifiable = controller_state.identifiable;
    }
    write_angles(truth.q, state.q_true);
    write_joints(truth.qd, state.qd_true);
    write(truth.f_on_tip, state.f_on_tip_true);
}

Vec3<double> LawView::torque(const double* tau) const {
    return convention_.flipped(Vec3<double>(tau[0], tau[1], tau[2]));
}

}  // namespace arm3r

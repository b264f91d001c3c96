#pragma once
// The motion of the arm in the form of which its Taylor kernels are made (docs/model.md, 5.5), recorded on a tape.

#include <array>

#include "arm3r/lanes.hpp"
#include "arm3r/numbers/eigen_traits.hpp"
#include "integrate/taylor_recipes.hpp"

namespace arm3r {

// The states with given initial values: the wall, the motion and the quadratures. Functions of them are added later.
constexpr std::size_t wall_size = 9, given_size = wall_size + state_size;

// Sine and cosine of both link angles: s2, c2, s3, c3.
constexpr std::size_t directions_size = 4;

// Inputs: the squared angular frequency of the wall, its state, the motion, the derivatives of the directions times the
// link's rate, for an elbow arm the acceleration of q1, the numbers of the plant. Outputs: the derivatives of wall and angles, the directions, the equation of
// motion, the derivatives of the quadratures, the powers of the torques, then the signals.
class Recording {
public:
    explicit Recording(const Recipe& recipe) : recipe_(recipe), plant_(chosen(recipe)) {
        const Expr frequency_2 = tape_.input();
        for (Vec3<Expr>* const vector : {&wall_.position, &wall_.velocity, &wall_.acceleration})
            for (Expr& x : *vector) x = tape_.input();
        for (Vec3<Expr>* const vector : {&q_, &qd_})
            for (Expr& x : *vector) x = tape_.input();
        for (Expr& x : turning_) x = tape_.input();
        if (recipe.elbow) q1dd_ = tape_.input();
        each_number([&](Expr& x) { x = tape_.input(); }, plant_);
        const SinCos<Expr> first = sincos(q_[0]), second = sincos(q_[1]), third = sincos(q_[1] + q_[2]);
        pose_ = {first.sin, first.cos, second.sin, second.cos, third.sin, third.cos};

        for (const Expr& x : wall_.velocity) tape_.output(x);
        for (const Expr& x : wall_.acceleration) tape_.output(recipe.even_wall ? Expr(0.0) : x);
        for (const Expr& x : wall_.velocity)  // zero unless the wall oscillates
            tape_.output(recipe.even_wall ? Expr(0.0) : -(frequency_2 * x));
        for (const Expr& x : qd_) tape_.output(x);
        for (const Expr& x : {pose_.S2, pose_.C2, pose_.S23, pose_.C23}) tape_.output(x);
        if (recipe.force) press();
        if (recipe.elbow) record_elbow_equation();
        else record_equation();
        record_powers();
        if (!recipe.signals) return;
        const Vec3<Expr> still{0.0, 0.0, 0.0};
        const Indentation<Expr> in = indentation(plant_.wall, wall_, tip_position(plant_.arm, pose_), still);
        for (const Expr& x : {in.depth, in.across1, in.across2}) tape_.output(x);
    }

    const Tape& tape() const { return tape_; }

private:
    static Plant<Expr> chosen(const Recipe& recipe) {
        Plant<Expr> plant;
        plant.has_wall = plant.acts_on_arm = recipe.signals;
        plant.wall.motion = Motion::fixed;
        plant.contact.law = ContactLaw::spring;
        plant.holds_torque = recipe.torque == TorqueSource::held;
        if (recipe.torque == TorqueSource::gravity_compensation)
            plant.controller.type = ControllerType::gravity_compensation;
        plant.controller.algorithm = Algorithm::closed_form;
        plant.arm.gravity_is_vertical = plant.controller.model.gravity_is_vertical = !recipe.oblique;
        plant.arm.has_damping = recipe.damping;
        plant.arm.has_dry_friction = recipe.friction;
        plant.arm.has_torque_limit = plant.holds_torque;
        for (Arm<Expr>* arm : {&plant.arm, &plant.controller.model})
            arm->is_elbow = arm->elbow.base_is_turned = recipe.elbow;
        return plant;
    }

    // What acts at the end of a lever in the arm's plane: along the radius, across the plane, and up.
    struct PlaneForce {
        Expr radial{0.0}, around{0.0}, up{0.0};
    };

    // The weight of `moment` kg m at a radius, under a gravity vector.
    PlaneForce weight(const Expr& moment, const Vec3<Expr>& g) const {
        if (plant_.arm.gravity_is_vertical) return {0.0, 0.0, moment * g[2]};
        return {moment * (g[0] * pose_.C1 + g[1] * pose_.S1), moment * (g[1] * pose_.C1 - g[0] * pose_.S1),
                moment * g[2]};
    }
    // The weight of link 2 or 3, less what the actuators compensate: equal ones leave no rounding error (3.8).
    PlaneForce weight_left(Expr Lumped<Expr>::* moment) const {
        const PlaneForce whole = weight(plant_.arm.lumped.*moment, plant_.arm.gravity);
        if (recipe_.torque != TorqueSource::gravity_compensation) return whole;
        const Arm<Expr>& model = plant_.controller.model;
        const PlaneForce compensated = weight(model.lumped.*moment, model.gravity);
        return {whole.radial - compensated.radial, whole.around - compensated.around, whole.up - compensated.up};
    }

    void press() {
        const Indentation<Expr> in = indentation_at_rest(plant_.wall, wall_, tip_position(plant_.arm, pose_));
        normal_force_ = plant_.contact.stiffness[0] * in.depth;
        const Vec3<Expr> n = recipe_.elbow ? elbow_arm::to_base(plant_.arm, plant_.wall.n) : plant_.wall.n;
        push_.radial = n[0] * (pose_.C1 * normal_force_) + n[1] * (pose_.S1 * normal_force_);
        push_.around = n[1] * (pose_.C1 * normal_force_) - n[0] * (pose_.S1 * normal_force_);
        push_.up = n[2] * normal_force_;
    }

    // (5.5): the inertia about the first axis and what changes its momentum; the generalised forces on both link angles
    // without the part that the matrix multiplies; the matrix.
    void record_equation() {
        const Arm<Expr>& arm = plant_.arm;
        const Lumped<Expr>& l = arm.lumped;
        const Expr &a2 = arm.link2.length, &a3 = arm.link3.length;
        const auto& [S1, C1, S2, C2, S3, C3] = pose_;
        const Expr &S2dd = turning_[1], C2dd = -turning_[0], &S3dd = turning_[3], C3dd = -turning_[2];
        const PlaneForce weight2 = weight_left(&Lumped<Expr>::G2), weight3 = weight_left(&Lumped<Expr>::G3);
        const Vec3<Expr> drive =
            minus(recipe_.torque == TorqueSource::held ? torque() : zero_vector<Expr>(), friction_torque(arm, qd_));

        const Expr P = l.A2 * C2 + l.B * C3, Q = l.A3 * C3 + l.B * C2;
        const Expr w1_2 = qd_[0] * qd_[0];
        tape_.output(l.A1 + (C2 * (P + l.B * C3) + l.A3 * (C3 * C3)));
        tape_.output(drive[0] + C2 * (weight2.around + a2 * push_.around) + C3 * (weight3.around + a3 * push_.around));
        tape_.output((drive[1] - drive[2]) + C2 * (weight2.up + a2 * push_.up - l.B * S3dd) -
                     S2 * (weight2.radial + a2 * push_.radial + P * w1_2 - l.B * C3dd));
        tape_.output(drive[2] + C3 * (weight3.up + a3 * push_.up - l.B * S2dd) -
                     S3 * (weight3.radial + a3 * push_.radial + Q * w1_2 - l.B * C2dd));

        tape_.output(l.B2 + l.J3);
        tape_.output(l.B * (C2 * C3 + S2 * S3) - l.J3);
        tape_.output(l.B3 + l.J3);
    }

    // The same of an elbow arm: (10.6), (10.7) and (10.9), in which the acceleration of q1 stands beside the derivatives of
    // the directions' products. The matrix has its row of q1, too.
    void record_elbow_equation() {
        const Arm<Expr>&arm = plant_.arm, &model = plant_.controller.model;
        const Lumped<Expr>& l = arm.lumped;
        const Elbow<Expr>& e = arm.elbow;
        const Expr &a1 = e.shoulder_offset, &a2 = arm.link2.length, &a3 = e.tip[0], &b3 = e.tip[1];
        const auto& [S1, C1, S2, C2, S3, C3] = pose_;
        const Expr &S2dd = turning_[1], C2dd = -turning_[0], &S3dd = turning_[3], C3dd = -turning_[2];
        const Expr Z3dd = l.G3 * S3dd + e.Gy3 * C3dd, X3dd = l.G3 * C3dd - e.Gy3 * S3dd;
        const Expr X2 = l.G2 * C2 - e.Gy2 * S2, X3 = l.G3 * C3 - e.Gy3 * S3, Z3 = l.G3 * S3 + e.Gy3 * C3;
        const Expr reached = a1 + a2 * C2, w1_2 = qd_[0] * qd_[0];
        const PlaneForce x2 = elbow_weight_left(l.G2, model.lumped.G2), x3 = elbow_weight_left(l.G3, model.lumped.G3),
                         y2 = elbow_weight_left(e.Gy2, model.elbow.Gy2), y3 = elbow_weight_left(e.Gy3, model.elbow.Gy3),
                         hu = elbow_weight_left(e.Hu, model.elbow.Hu), hv = elbow_weight_left(e.Hv, model.elbow.Hv);
        const Vec3<Expr> drive =
            minus(recipe_.torque == TorqueSource::held ? torque() : zero_vector<Expr>(), friction_torque(arm, qd_));

        tape_.output(l.A1 + (C2 * (l.A2 * C2 + (2.0 * e.D2) * S2 + (2.0 * a2) * X3) +
                             C3 * (l.A3 * C3 + (2.0 * e.D3) * S3) + (2.0 * a1) * (X2 + X3)));
        tape_.output(drive[0] + C2 * (x2.around + a2 * push_.around) - S2 * y2.around +
                     C3 * (x3.around + a3 * push_.around) - S3 * (y3.around + b3 * push_.around) +
                     (hu.around - hv.radial + a1 * push_.around - e.lateral * push_.radial) -
                     (e.E2 * turning_[0] + e.F2 * turning_[1] + e.E3 * turning_[2] + e.F3 * turning_[3]));
        tape_.output(
            (drive[1] - drive[2]) +
            C2 * (x2.up - y2.radial + a2 * push_.up - (a1 * e.Gy2 - e.D2 * C2) * w1_2 - a2 * Z3dd - e.F2 * q1dd_) -
            S2 * (y2.up + x2.radial + a2 * push_.radial + (l.A2 * C2 + e.D2 * S2 + (a1 * l.G2 + a2 * X3)) * w1_2 -
                  a2 * X3dd + e.E2 * q1dd_));
        tape_.output(drive[2] +
                     C3 * (x3.up - y3.radial + (a3 * push_.up - b3 * push_.radial) -
                           (reached * e.Gy3 - e.D3 * C3) * w1_2 - a2 * (l.G3 * S2dd - e.Gy3 * C2dd) - e.F3 * q1dd_) -
                     S3 * (y3.up + x3.radial + (b3 * push_.up + a3 * push_.radial) +
                           (l.A3 * C3 + e.D3 * S3 + reached * l.G3) * w1_2 - a2 * (e.Gy3 * S2dd + l.G3 * C2dd) +
                           e.E3 * q1dd_));

        tape_.output(l.B2 + l.J3);
        tape_.output(a2 * (C2 * X3 + S2 * Z3) - l.J3);
        tape_.output(l.B3 + l.J3);
        tape_.output(e.E2 * S2 + e.F2 * C2);
        tape_.output(e.E3 * S3 + e.F3 * C3);
    }

    // As weight_left(), of a first moment of the arm and the model's.
    PlaneForce elbow_weight_left(const Expr& moment, const Expr& of_model) const {
        const PlaneForce whole = weight(moment, plant_.arm.elbow.gravity);
        if (recipe_.torque != TorqueSource::gravity_compensation) return whole;
        const PlaneForce compensated = weight(of_model, plant_.controller.model.elbow.gravity);
        return {whole.radial - compensated.radial, whole.around - compensated.around, whole.up - compensated.up};
    }

    Vec3<Expr> torque() const { return torque_without_memory(plant_, q_, pose_); }

    // The derivatives of the quadratures (4.9), then the powers of the torques.
    void record_powers() {
        const Vec3<Expr> power = powers();
        const Expr joint_loss = dot(friction_torque(plant_.arm, qd_), qd_);
        tape_.output(power[0] + (power[1] + power[2]));
        tape_.output(recipe_.force ? normal_force_ * dot(plant_.wall.n, wall_.velocity) : Expr(0.0));
        tape_.output(joint_loss);
        tape_.output(joint_loss);
        tape_.output(0.0);
        for (const Expr& x : power) tape_.output(x);
    }

    // W, of each torque. Those of gravity compensation are written in products that the motion has too, such as c2 w2.
    Vec3<Expr> powers() const {
        if (recipe_.torque != TorqueSource::gravity_compensation || recipe_.elbow) {
            const Vec3<Expr> tau = torque();
            return {tau[0] * qd_[0], tau[1] * qd_[1], tau[2] * qd_[2]};
        }
        const Arm<Expr>& model = plant_.controller.model;
        const Expr &G2 = model.lumped.G2, &G3 = model.lumped.G3;
        const auto& [S1, C1, S2, C2, S3, C3] = pose_;
        const Expr w3 = qd_[1] + qd_[2], up = C3 * qd_[1];
        Vec3<Expr> power{0.0, -(model.gravity[2] * (G2 * (C2 * qd_[1]) + G3 * up)),
                         -(model.gravity[2] * (G3 * (C3 * w3 - up)))};
        if (!recipe_.oblique) return power;
        const Vec3<Expr>& g = model.gravity;
        const Expr along = g[0] * C1 + g[1] * S1, around_w1 = g[1] * (C1 * qd_[0]) - g[0] * (S1 * qd_[0]);
        const Expr inward = S3 * qd_[1];
        power[0] = -((G2 * C2 + G3 * C3) * around_w1);
        power[1] = power[1] + along * (G2 * (S2 * qd_[1]) + G3 * inward);
        power[2] = power[2] + along * (G3 * (S3 * w3 - inward));
        return power;
    }

    Tape tape_;
    const Recipe recipe_;
    Plant<Expr> plant_;
    WallState<Expr> wall_;
    Vec3<Expr> q_, qd_;
    std::array<Expr, directions_size> turning_;
    Expr q1dd_{0.0};
    Pose<Expr> pose_;
    Expr normal_force_{0.0};
    PlaneForce push_;
};

}  // namespace arm3r

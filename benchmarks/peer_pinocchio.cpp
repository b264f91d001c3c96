#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/config.hpp>

#include "peers.hpp"

namespace peers {

namespace pin = pinocchio;

namespace {

pin::Inertia inertia_of(const Body& body) {
    const double *d = body.inertia, *o = body.products;
    const Eigen::Matrix3d tensor =
        (Eigen::Matrix3d() << d[0], o[0], o[1], o[0], d[1], o[2], o[1], o[2], d[2]).finished();
    return {body.mass, {body.com[0], body.com[1], body.com[2]}, tensor};
}

pin::Model model_of(const Numbers& numbers) {
    pin::Model model;
    model.gravity.linear(Eigen::Vector3d(numbers.gravity[0], numbers.gravity[1], numbers.gravity[2]));
    const Eigen::Matrix3d quarter_turn = (Eigen::Matrix3d() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished();
    const pin::SE3 shoulder(quarter_turn, Eigen::Vector3d(numbers.shoulder_offset, 0, numbers.base_height));
    const pin::SE3 elbow(Eigen::Matrix3d::Identity(), Eigen::Vector3d(numbers.link2.length, 0, numbers.offset));
    const auto first = model.addJoint(0, pin::JointModelRZ(), pin::SE3::Identity(), "joint1");
    const auto second = model.addJoint(first, pin::JointModelRZ(), shoulder, "joint2");
    const auto third = model.addJoint(second, pin::JointModelRZ(), elbow, "joint3");
    const Eigen::Vector3d turret(0, 0, numbers.turret_inertia);
    model.appendBodyToJoint(first, {0, Eigen::Vector3d::Zero(), turret.asDiagonal()}, pin::SE3::Identity());
    model.appendBodyToJoint(second, inertia_of(numbers.link2), pin::SE3::Identity());
    model.appendBodyToJoint(third, inertia_of(numbers.link3), pin::SE3::Identity());
    return model;
}

}  // namespace

struct Pinocchio::Implementation {
    explicit Implementation(const Numbers& numbers) : model(model_of(numbers)), data(model) {}
    pin::Model model;
    pin::Data data;
};

const char* Pinocchio::build() { return "Pinocchio " PINOCCHIO_VERSION ", " PEER_BUILD; }

Pinocchio::Pinocchio(const Numbers& numbers) : in_(std::make_unique<Implementation>(numbers)) {}
Pinocchio::~Pinocchio() = default;

void Pinocchio::forward_dynamics(const double* q, const double* qd, const double* tau, double* qdd) {
    using In = Eigen::Map<const Eigen::Vector3d>;
    Eigen::Map<Eigen::Vector3d> out(qdd);
    out = pin::aba(in_->model, in_->data, In(q), In(qd), In(tau), pin::Convention::WORLD);
}

}  // namespace peers

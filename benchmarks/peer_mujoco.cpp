#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <string>

#include "peers.hpp"

namespace peers {

namespace {

struct Inertial {
    const Body& body;
};

// Body axes: x along the link, y along the joint, pointing right of the arm; a slide joint turns about -y.
std::ostream& operator<<(std::ostream& out, const Inertial& inertial) {
    const auto& [length, mass, com, inertia, products] = inertial.body;
    return out << "<inertial mass='" << mass << "' pos='" << com[0] << " 0 0' diaginertia='" << inertia[0] << ' '
               << inertia[2] << ' ' << inertia[1] << "'/>";
}

std::string mjcf(const Numbers& n, double step) {
    std::ostringstream xml;
    xml << std::setprecision(17) << "<mujoco>\n<compiler angle='radian'/>\n<option integrator='RK4' timestep='" << step
        << "' gravity='" << n.gravity[0] << ' ' << n.gravity[1] << ' ' << n.gravity[2] << "'>\n"
        << "<flag constraint='disable' contact='disable' sensor='disable' autoreset='disable'/>\n</option>\n"
        << "<worldbody>\n<body>\n<joint axis='0 0 1'/>\n"
        << "<inertial mass='1' pos='0 0 0' diaginertia='" << n.turret_inertia << ' ' << n.turret_inertia << ' '
        << n.turret_inertia << "'/>\n"
        << "<body pos='0 0 " << n.base_height << "'>\n<joint axis='0 -1 0'/>\n"
        << Inertial{n.link2} << '\n'
        << "<body pos='" << n.link2.length << " 0 0'>\n<joint axis='0 -1 0'/>\n"
        << Inertial{n.link3} << '\n'
        << "</body>\n</body>\n</body>\n</worldbody>\n</mujoco>\n";
    return xml.str();
}

mjModel* model_of(const std::string& xml) {
    char why[500] = "";
    mjSpec* spec = mj_parseXMLString(xml.c_str(), nullptr, why, sizeof why);
    mjModel* model = spec ? mj_compile(spec, nullptr) : nullptr;
    if (!model)
        throw std::runtime_error("MuJoCo does not take the arm: " + std::string(spec ? mjs_getError(spec) : why));
    mj_deleteSpec(spec);
    return model;
}

}  // namespace

struct Mujoco::Implementation {
    explicit Implementation(const std::string& xml) : model(model_of(xml)), data(mj_makeData(model)) {}
    ~Implementation() {
        mj_deleteData(data);
        mj_deleteModel(model);
    }
    mjModel* model;
    mjData* data;
};

const char* Mujoco::build() {
    static char text[64];
    std::snprintf(text, sizeof text, "MuJoCo %s, its own wheel", mj_versionString());
    return text;
}

Mujoco::Mujoco(const Numbers& numbers, double step) : in_(std::make_unique<Implementation>(mjcf(numbers, step))) {}
Mujoco::~Mujoco() = default;

void Mujoco::forward_dynamics(const double* q, const double* qd, const double* tau, double* qdd) {
    start(q, qd);
    std::copy_n(tau, 3, in_->data->qfrc_applied);
    mj_forward(in_->model, in_->data);
    std::copy_n(in_->data->qacc, 3, qdd);
}

void Mujoco::start(const double* q, const double* qd) {
    std::copy_n(q, 3, in_->data->qpos);
    std::copy_n(qd, 3, in_->data->qvel);
}

void Mujoco::advance(int steps) {
    for (int i = 0; i < steps; ++i) mj_step(in_->model, in_->data);
}

const double* Mujoco::q() const { return in_->data->qpos; }
const double* Mujoco::qd() const { return in_->data->qvel; }

}  // namespace peers

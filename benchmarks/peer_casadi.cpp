#include "casadi_arm.h"

#include <algorithm>
#include <cstdio>

#include "peers.hpp"

namespace peers {

const char* Casadi::build() {
    int major, minor, patch;
    casadi_arm_casadi_version(&major, &minor, &patch);
    static char text[256];
    std::snprintf(text, sizeof text, "CasADi %d.%d.%d, %s", major, minor, patch, PEER_BUILD);
    return text;
}

void Casadi::forward_dynamics(const double* q, const double* qd, const double* tau, double* qdd) {
    const double* in[] = {q, qd, tau};
    double* out[] = {qdd};
    casadi_forward_dynamics(in, out, nullptr, nullptr, 0);
}

void Casadi::start(const double* q, const double* qd) {
    std::copy_n(q, 3, y_);
    std::copy_n(qd, 3, y_ + 3);
    t_ = 0;
}

void Casadi::advance(int steps) {
    const auto take_step = pushed_ ? casadi_pushed_step : casadi_falling_step;
    const double* in[] = {y_, &t_, &step_};
    double* out[] = {y_};
    for (int i = 0; i < steps; ++i, t_ += step_) take_step(in, out, nullptr, nullptr, 0);
}

}  // namespace peers

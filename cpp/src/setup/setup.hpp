#pragma once
// From the flat parameters to the typed things that a run works on. Slide convention from here on.

#include <span>
#include <string>
#include <vector>

#include "arm3r/plant.hpp"
#include "base/problem_list.hpp"

namespace arm3r {

struct Solver {
    enum Method { dopri5, rk4, taylor, rodas4, automatic } method;
    double rtol, atol;      // of the adaptive methods but taylor
    double tol;             // of taylor
    double max_step, step;  // s; max_step may be inf
    double max_steps;

    bool marches() const { return method == rk4 || method == taylor; }  // in lanes too (march.hpp)
};

struct Setup {
    bool simscape;  // how q, qd and torques are written at the faces
    Plant<double> plant;
    Digital<double> digital;  // on: the plant's own controller is the torque that this one holds
    Estimation<double> estimation;
    Vec3<double> q, qd;  // at the start
    Solver solver;
    double start, stop, log_every;  // s

    const Controller<double>& law() const { return digital.sampling.on ? digital.controller : plant.controller; }
    bool observes() const { return digital.sampling.on ? digital.observer.on : plant.observer.on; }
    bool is_scored() const { return law().type != Controls::none; }

    // Instants nearer to each other than this, s, are the same but for rounding.
    double clock_rounding() const;
};

// The choices in `params` must be in order; what their numbers must keep to is said by validate() (schema.hpp), of
// which `check_setup` is the last part.
Arm<double> make_arm(std::span<const double> params);
Setup make_setup(std::span<const double> params);

// Every number of controller.model, and the number of the plant's arm that it replaces where it is given.
struct Replacement {
    std::size_t from, to;
};
const std::vector<Replacement>& model_numbers();

// The same parameters with whatever controller.model says in the place of the plant's arm, and whether it says anything.
std::vector<double> with_model(std::span<const double> params);
bool model_differs(std::span<const double> params);

}  // namespace arm3r

#pragma once
// From the flat parameters to the typed things that a run works on. Slide convention from here on.

#include <span>
#include <string>
#include <vector>

#include "arm3r/plant.hpp"
#include "findings.hpp"

namespace arm3r {

struct Solver {
    enum Method { dopri5, rk4, taylor } method;
    double rtol, atol;      // of dopri5
    double tol;             // of taylor
    double max_step, step;  // s; max_step may be inf
    double max_steps;
};

struct Setup {
    bool simscape;  // how q, qd and torques are written at the faces
    Plant<double> plant;
    Vec3<double> q, qd;  // at t = 0
    Solver solver;
    double stop, log_every;  // s
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

// What no single key can break: the mass matrix over the whole workspace (3.10), the start, what a method cannot do.
void check_setup(std::span<const double> params, Findings& findings);

// What is allowed but probably a slip, each one sentence with the numbers.
std::vector<std::string> likely_slips(std::span<const double> params);

// Smallest M11 and smallest determinant of the lower block over all poses, and the link angles where they occur (3.10).
struct WorstPose {
    double value;
    double q2, q3;  // rad, slide
};
WorstPose smallest_M11(const Lumped<double>& lumped);
WorstPose smallest_lower_determinant(const Lumped<double>& lumped);

}  // namespace arm3r

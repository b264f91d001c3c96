#include "lanes/lane_run_members.hpp"
#include "validate/rules.hpp"

namespace arm3r {
namespace {

// Whether the determinant of joints 2 and 3 can be as small as its rounding error in some pose.
bool may_be_ill_conditioned(const Arm<double>& arm) {
    if (arm.is_elbow) return !arm.elbow.is_far_from_singular;
    const Lumped<double>& l = arm.lumped;
    const double largest = (l.B2 + l.B3 + 2 * std::abs(l.B)) * (l.B3 + l.J3);
    return !(min_lower_determinant(l).value > 64 * std::numeric_limits<double>::epsilon() * largest);
}

// The order of taylor. Where nothing cuts a step short, a quarter more, for longer steps: what a step costs beside its
// series is then paid less often.
int series_order(const Setup& setup) {
    const double tol = setup.solver.tol;
    const bool may_be_cut =
        setup.plant.has_wall || setup.plant.arm.has_dry_friction || setup.digital.sampling.on || setup.estimation.on;
    return order_of(may_be_cut ? tol : tol * std::sqrt(std::sqrt(tol)));
}

}  // namespace

BatchKey batch_key_of(const Setup& setup) {
    const Plant<double>& plant = setup.plant;
    const Arm<double>&arm = plant.arm, &model = plant.controller.model;
    return {
        setup.solver.method,
        setup.solver.method == SolverMethod::taylor ? series_order(setup) : 0,
        may_be_ill_conditioned(arm),
        plant.wall.table ? plant.wall.table->knots() : 0,
        plant,
        arm,
        model,
        arm.elbow,
        model.elbow,
        plant.wall,
        plant.contact,
        setup.controller(),
        setup.controller().reference,
        setup.digital.sampling,
        setup.digital.sensors,
        setup.digital.observer,
        setup.estimation,
        plant.external_force.on,
    };
}

#define ARM3R_WITHOUT_MEMORY(T) ARM3R_LANE_RUN(T, state_size)
ARM3R_LANE_TYPES(ARM3R_WITHOUT_MEMORY)

}  // namespace arm3r

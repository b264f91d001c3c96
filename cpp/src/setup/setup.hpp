#pragma once
// Makes typed data from the flat parameters. All of it is in the slide convention.

#include <span>
#include <string>
#include <vector>

#include "arm3r/plant.hpp"
#include "base/problem_list.hpp"
#include "schema/columns.hpp"
#include "schema/solver_method.hpp"
#include "setup/metric_groups.hpp"

namespace arm3r {

struct Solver {
    SolverMethod method;
    double rtol, atol;      // of the adaptive methods except taylor
    double tol;             // of taylor
    double max_step, step;  // s; max_step may be inf
    double max_steps;
    StepEvents events;  // of rk4

    // Whether all steps have one length, wherever contact or a formula of time changes.
    bool is_on_grid() const { return method == SolverMethod::rk4 && events == StepEvents::grid; }
    // Whether no step is by the method for stiff equations.
    bool is_explicit() const { return method != SolverMethod::rodas4 && method != SolverMethod::automatic; }
};

struct Setup {
    JointConvention convention;  // of q, qd and torques of input and output
    Plant<double> plant;
    DigitalController<double> digital;  // if it is on, the plant has no controller and holds the torque of this one
    Estimation<double> estimation;
    Vec3<double> q, qd;  // at the start
    Solver solver;
    double start, stop, log_every;               // s
    ColumnSet logged;                            // the columns of the log, as far as the run has them; t is always one
    MetricGroups metrics = MetricGroups::all();  // that are wanted

    const Controller<double>& controller() const { return digital.sampling.on ? digital.controller : plant.controller; }
    bool observes() const { return digital.sampling.on ? digital.observer.on : plant.observer.on; }
    bool has_performance() const { return controller().type != ControllerType::none && metrics.want_performance(); }

    // Whether steps end where the arm passes a singular pose: a continuous law that inverts the Jacobian has a peak of its
    // torque there, of limited height, which may be shorter than a step (5.2).
    bool ends_steps_at_singular_poses() const;

    // From parameters whose choices are in order; what their numbers must keep to is said by validate() (validate.hpp),
    // of which check_setup() is the last part.
    explicit Setup(std::span<const double> params);
    // Sets again what the numbers of `initial` and `wall.contact` say, but for the reference of a law, which may begin at
    // the initial pose.
    void set_start_and_contact(std::span<const double> params);

    // Copied in many files, compiled in one.
    Setup();
    Setup(const Setup&);
    Setup(Setup&&) noexcept;
    Setup& operator=(const Setup&);
    Setup& operator=(Setup&&) noexcept;
    ~Setup();

    // Instants that differ by less than this, s, are equal except for rounding.
    double clock_rounding() const;
};

Arm<double> make_arm(std::span<const double> params);
inline Setup make_setup(std::span<const double> params) { return Setup(params); }

// Every number of controller.model, and the number of the plant's arm that it replaces where it is given.
struct Replacement {
    std::size_t from, to;
};
const std::vector<Replacement>& model_numbers();

// The same parameters with the numbers of controller.model in place of the plant's arm, and whether there are any.
std::vector<double> with_model(std::span<const double> params);
bool model_differs(std::span<const double> params);

}  // namespace arm3r

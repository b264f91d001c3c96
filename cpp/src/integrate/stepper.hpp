#pragma once
// Adaptive steps by an explicit method, by one for stiff equations, or by an automatic choice between the two;
// docs/model.md (5.2), (5.6), (5.7).

#include <string>

#include "arm3r/ode/rodas.hpp"
#include "control/compiled_laws.hpp"
#include "integrate/dense_output.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// N is state_size, or full_size where a controller remembers something.
template <std::size_t N>
class Stepper {
public:
    using Y = State<double, N>;

    explicit Stepper(const Setup& setup);
    // Copies the state of another one of an equal setup; set() and set_start() must be called next.
    Stepper(const Setup& setup, const Stepper& other) : Stepper(setup) { state_ = other.state_; }

    // Sets the contact and the inputs of a continuous controller, for both methods.
    void set(ContactForceMode force_mode, double contact, double force_phase, double latest);

    // Evaluates f at (t, y), the start of the next step.
    void set_start(double t, const Y& y);
    const Y& f0() const { return state_.f0; }
    void evaluate(double t, const Y& y, Y& dy) {
        state_.evaluations += 1;
        rhs_(t, y, dy);
    }

    // Tries a step. Returns the error in units of its tolerance, infinite if the step fails.
    double attempt(double t, const Y& y, double h);
    const Y& end() const { return state_.is_stiff ? state_.by_stiff.y1 : state_.by_explicit.y1; }
    void interpolate(double t, const Y& y, double h, DenseOutput& dense) const;
    double factor(double error) const { return state_.is_stiff ? Stiff::step_factor(error) : step_factor(error); }

    // Accepts the step. `continues`: the next step starts at its end without a restart, and the method may be changed
    // there.
    void accept(double t, const Y& y, double h, bool continues);

    bool is_stiff() const { return state_.is_stiff; }
    std::int64_t evaluations() const { return state_.evaluations; }
    std::int64_t stiff_steps() const { return state_.stiff_steps; }
    std::string choices() const;  // of auto: which method it used when, and why
    const RightHandSide<double, double>& right_hand_side() const { return rhs_; }
    // The applied torque of a continuous controller.
    Vec3<double> torque(double t, const WallState<double>& wall, const Pose<double>& p, const Vec3<double>& f_on_tip,
                        const Y& y) const;

private:
    using Explicit = Dopri5<double, N, motion_size, quadrature_count, quadrature_parts>;
    using Stiff = Rodas4<N, motion_size, quadrature_count, quadrature_parts>;
    using D = Dual<derivatives_per_pass>;

    bool has_contact_heat() const;
    bool is_quiet(const Y& y, double h) const;
    double with_work_of_wall(double error, const Y& y, double h) const;
    double error_of(std::size_t i, double h) const {
        return state_.is_stiff ? state_.by_stiff.error_of(i) : state_.by_explicit.error_of(i, h);
    }
    void select_method(double t, double h);

    struct Choice {
        double t, measure;  // s, h lambda
        bool is_stiff;
    };
    static constexpr std::size_t max_listed_choices = 8;

    // All that changes from step to step; a copy continues as the original would.
    struct StepperState {
        Explicit by_explicit;
        Stiff by_stiff;
        Linearization<N> linearization;
        bool has_linearization = false;
        Y f0{};
        bool is_stiff = false;
        int signs = 0, doubts = 0;  // consecutive signs for the other method, and against it
        std::array<Choice, max_listed_choices> choices{};
        std::size_t choice_count = 0;
        std::int64_t evaluations = 0, stiff_steps = 0;
        double max_work_of_wall = 0;  // J, either way
    };

    const Setup& setup_;
    RightHandSide<double, double> rhs_;  // its sines are a cache, its contact is set by set()
    RightHandSide<double, D> rhs_of_duals_;
    StepperState state_;
};

}  // namespace arm3r

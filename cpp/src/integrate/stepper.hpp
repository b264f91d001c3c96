#pragma once
// Adaptive steps by an explicit method, by one for stiff equations, or by whichever of the two is the right one at the
// time; docs/model.md (5.2), (5.6), (5.7).

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
    // As far as another one of an equal setup; set() and begin() come next.
    Stepper(const Setup& setup, const Stepper& other) : Stepper(setup) { now_ = other.now_; }

    // The mode of contact and what a continuous controller takes for granted, for both methods.
    void set(Touch touch, double contact, double force_phase, double latest);

    // f at (t, y), from where the next step goes.
    void begin(double t, const Y& y);
    const Y& f0() const { return now_.f0; }
    void evaluate(double t, const Y& y, Y& dy) {
        now_.evaluations += 1;
        rhs_(t, y, dy);
    }

    // Tries a step; the error in units of its tolerance, infinite where it has no end.
    double attempt(double t, const Y& y, double h);
    const Y& end() const { return now_.is_stiff ? now_.by_stiff.y1 : now_.by_explicit.y1; }
    void interpolate(double t, const Y& y, double h, Inside& inside) const;
    double factor(double error) const { return now_.is_stiff ? Stiff::step_factor(error) : step_factor(error); }

    // The step was taken. Whether `end` is where the next one goes on from, and the method may be changed there.
    void accept(double t, const Y& y, double h, bool goes_on);

    bool is_stiff() const { return now_.is_stiff; }
    std::int64_t evaluations() const { return now_.evaluations; }
    std::int64_t stiff_steps() const { return now_.stiff_steps; }
    std::string choices() const;  // of auto: which method it took when, and why
    const RightHandSide<double, double>& right_hand_side() const { return rhs_; }
    // The torque that is applied, and what a continuous controller is told.
    Vec3<double> torque(double t, const WallState<double>& wall, const Pose<double>& p, const Vec3<double>& f_on_tip,
                        const Y& y) const;

private:
    using Explicit = Dopri5<double, N, motion_size, ledger_size, ledger_parts>;
    using Stiff = Rodas4<N, motion_size, ledger_size, ledger_parts>;
    using D = Dual<slopes_at_once>;

    bool counts_heat() const;
    bool is_quiet(const Y& y, double h) const;
    double with_work_of_wall(double error, const Y& y, double h) const;
    double error_of(std::size_t i, double h) const {
        return now_.is_stiff ? now_.by_stiff.error_of(i) : now_.by_explicit.error_of(i, h);
    }
    void judge_stiffness(double t, double h);

    struct Choice {
        double t, measure;  // s, h lambda
        bool is_stiff;
    };
    static constexpr std::size_t most_told = 8;

    // All that changes from step to step; a copy of it goes on as the original would.
    struct Present {
        Explicit by_explicit;
        Stiff by_stiff;
        Linearization<N> slopes;
        bool has_slopes = false;
        Y f0{};
        bool is_stiff = false;
        int signs = 0, doubts = 0;  // that the other method is the right one, and that it is not
        std::array<Choice, most_told> choices{};
        std::size_t choice_count = 0;
        std::int64_t evaluations = 0, stiff_steps = 0;
        double most_work_of_wall = 0;  // J, either way
    };

    const Setup& setup_;
    RightHandSide<double, double> rhs_;  // its sines are a cache, its contact is that of the last set()
    RightHandSide<double, D> rhs_of_duals_;
    Present now_;
};

}  // namespace arm3r

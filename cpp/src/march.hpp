#pragma once
// Runs that march side by side, each as if alone: T = double is one run, Pack<N> are N. What all methods share: clock,
// state, contact, books and metrics of every lane. What is rare, a change of contact or the end of a run, is done
// lane by lane in doubles, by the same functions for every T.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "arm3r/eigen_traits.hpp"
#include "arm3r/lanes.hpp"
#include "contact_step.hpp"
#include "ledger.hpp"

namespace arm3r {

template <class T>
struct Lanes {
    static constexpr int count = 1;
    using Mask = bool;
    static double get(const T& x, int) { return x; }
    static void set(T& x, int, double value) { x = value; }
    static bool is(bool mask, int) { return mask; }
};

template <int N>
struct Lanes<Pack<N>> {
    static constexpr int count = N;
    using Mask = PackMask<N>;
    static double get(const Pack<N>& x, int lane) { return x[lane]; }
    static void set(Pack<N>& x, int lane, double value) { x.set(lane, value); }
    static bool is(const Mask& mask, int lane) { return mask[lane]; }
};

// What is the same in all lanes, so that nothing that no lane needs is computed, and every lane rounds alike.
struct Structure {
    Solver::Method method;
    int order;  // of taylor
    bool has_wall, acts_on_arm, has_outline, may_be_ill_conditioned;
    Motion motion;
    Law law;
    Controls controls;
    Algorithm algorithm;
    std::array<bool, 8> flags;  // of arm and model

    bool operator==(const Structure&) const = default;
};

Structure structure_of(const Setup& setup);

// Of theta, for an instant near t in a step of h.
inline double event_resolution(double t, double h) {
    return std::max(finest_event, 4 * std::numeric_limits<double>::epsilon() * std::abs(t)) / h;
}

template <class T>
class March {
public:
    using Mask = typename Lanes<T>::Mask;
    static constexpr int lanes = Lanes<T>::count;

    explicit March(const Setup& any_lane);

    // Put a run into a lane. The lanes put in since then begin with the next call of begin().
    void put(int lane, const Setup& setup);
    ARM3R_INLINE void begin() {
        observe();
        for (int lane = 0; lane < lanes; ++lane)
            if (is_new_[lane]) begin_lane(lane);
        if (any_embedded_) rhs_.derivative(wall_, p_, y_, f_);
    }

    void retire(int lane);
    bool is_running(int lane) const { return running_[lane]; }
    bool is_anyone_running() const { return any(alive_); }
    bool has_ended(int lane) const { return running_[lane] && (outcome_[lane] != ARM3R_RUN_OK || at_stop(lane)); }
    ARM3R_INLINE bool someone_ended() const { return failed_ || any(alive_ && t_ >= stop_); }
    void forget_failures() { failed_ = false; }

    void stop_lane(int lane, arm3r_outcome outcome) {
        if (outcome_[lane] == ARM3R_RUN_OK) outcome_[lane] = outcome;
        failed_ = true;
    }
    Metrics metrics(int lane) const;
    Flows flows(int lane) const;
    Steps steps(int lane) const {
        const auto count = [&](const T& x) { return std::int64_t(Lanes<T>::get(x, lane)); };
        return {count(accepted_), count(rejected_), count(evaluations_)};
    }

    // One lane, in doubles.
    double t(int lane) const { return Lanes<T>::get(t_, lane); }
    double h(int lane) const { return Lanes<T>::get(h_, lane); }
    FullState y(int lane) const { return state_of(y_, lane); }
    Mode mode(int lane) const { return mode_[lane]; }
    double energy_at_start(int lane) const { return Lanes<T>::get(energy_at_start_, lane); }
    arm3r_outcome outcome(int lane) const { return outcome_[lane]; }

protected:
    static FullState state_of(const State<T, state_size>& y, int lane) {
        FullState one;
        for (std::size_t i = 0; i < state_size; ++i) one[i] = Lanes<T>::get(y[i], lane);
        return one;
    }
    ARM3R_INLINE static Mask select_mask(const Mask& which, const Mask& a, const Mask& b) {
        return (which && a) || (!which && b);
    }

    // ---- one instant

    // Pose, wall, indentation, derivative and energies at the present state.
    ARM3R_INLINE void observe() {
        if (needs_derivative_) {
            rhs_.begin_step(y_);
            p_ = rhs_.pose_near(y_);
        } else {
            p_ = pose(Vec3<T>(y_[0], y_[1], y_[2]));
        }
        const Vec3<T> qd(y_[3], y_[4], y_[5]);
        if (plant_.has_wall) {
            wall_ = wall_at(plant_.wall, t_);
            in_ = tip_indentation(plant_, wall_, p_, qd);
        }
        if (needs_derivative_) rhs_.derivative(wall_, p_, y_, f_);
        kinetic_ = kinetic_energy(plant_.arm, p_, qd);
        potential_ = potential_energy(plant_.arm, p_);
    }

    ARM3R_INLINE T stored() const {
        if (!plant_.acts_on_arm) return T(0.0);
        return select(touching_ && in_.depth > T(0.0), T(0.5 * stiffness_ * in_.depth * in_.depth), T(0.0));
    }

    // ---- after a step

    // To `t1`, `y1` where `moved`; rates that are next to nothing become nothing.
    ARM3R_INLINE void accept(const Mask& moved, const T& t1, const State<T, state_size>& y1) {
        if (all(moved)) y_ = y1;
        else
            for (std::size_t i = 0; i < state_size; ++i) y_[i] = select(moved, y1[i], y_[i]);
        for (std::size_t i = 3; i < motion_size; ++i) y_[i] = select(abs(y_[i]) < T(smallest_rate), T(0.0), y_[i]);
        t_ = select(moved, t1, t_);
        accepted_ = accepted_ + select(moved, T(1.0), T(0.0));
    }

    ARM3R_INLINE static Mask is_finite(const State<T, state_size>& y) {
        T sum = y[0];
        for (std::size_t i = 1; i < state_size; ++i) sum = sum + y[i];
        return sum * 0.0 == T(0.0);
    }

    ARM3R_INLINE void close_books() {
        const T contact = stored();
        const T residual = ((kinetic_ + potential_ + contact) - energy_at_start_) - (y_[6] + y_[7] - y_[8]);
        const T size = select(residual == residual, abs(residual), T(std::numeric_limits<double>::infinity()));
        residual_ = max(residual_, size);
        exchanged_ = max(max(max(exchanged_, abs(y_[6])), max(abs(y_[7]), abs(y_[8]))),
                         max(kinetic_, abs(potential_ - potential_at_start_)));
        held_ = max(held_, T(abs(kinetic_) + abs(potential_) + abs(contact)));
    }

    ARM3R_INLINE void judge_lanes() {
        Mask bad = max(max(abs(y_[0]), abs(y_[1])), abs(y_[2])) > T(sincos_limit);
        if (may_be_ill_conditioned_) bad = bad || !well_conditioned();
        bad = bad || (accepted_ + rejected_ >= max_steps_ && t_ < stop_);
        bad = bad && alive_;
        if (any(bad)) fail_lanes(bad);
    }

    ARM3R_INLINE Mask well_conditioned() const {
        const Mat3<T> M = mass_matrix(plant_.arm, p_);
        constexpr double epsilon = std::numeric_limits<double>::epsilon();
        return M(0, 0) > T(0.0) && T(M(1, 1) * M(2, 2) - M(1, 2) * M(1, 2)) > T(8 * epsilon * M(1, 1) * M(2, 2));
    }

    // ---- contact

    // The depth from a to b within the step has been gone through.
    void pass(int lane, const Polynomial<double>& depth, double a, double b);
    void change_mode(int lane, const Change& change);

    const Setup& setup(int lane) const { return setups_[lane]; }

    // What change_mode() has changed is felt from here on.
    [[gnu::noinline]] void evaluate_anew() {
        if (needs_derivative_) rhs_.derivative(wall_, p_, y_, f_);
    }

    // What the spring holds at a depth.
    double stored_at(int lane, double depth) const {
        const bool holds = plant_.acts_on_arm && mode_[lane] == Mode::contact && depth > 0;
        return holds ? 0.5 * Lanes<T>::get(stiffness_, lane) * depth * depth : 0;
    }

    void fail_lanes(const Mask& bad);

    Plant<T> plant_;  // its stiffness is 0 in lanes that are embedded, or free where so decided
    RightHandSide<T, T> rhs_;
    bool needs_derivative_ = true, only_contact_is_felt_ = false, may_be_ill_conditioned_;

    T t_{0.0}, h_{0.0}, stop_{0.0};
    State<T, state_size> y_{}, f_{};
    Pose<T> p_;
    WallState<T> wall_;
    Indentation<T> in_;
    T kinetic_, potential_;

    T stiffness_{0.0};
    Mask alive_ = false, touching_ = false, embedded_ = false;
    std::array<Mode, lanes> mode_{};
    bool any_embedded_ = false, any_touching_ = false;

    T energy_at_start_{0.0}, potential_at_start_{0.0}, residual_{0.0}, exchanged_{0.0}, held_{0.0};
    T deepest_{0.0}, depth_time_{0.0};
    T accepted_{0.0}, rejected_{0.0}, evaluations_{0.0}, max_steps_{0.0};

private:
    bool at_stop(int lane) const { return !(Lanes<T>::get(t_, lane) < Lanes<T>::get(stop_, lane)); }
    void begin_lane(int lane);
    void set_mode(int lane, Mode mode);
    void set_running(int lane, bool running);

    std::array<Setup, lanes> setups_;
    std::array<bool, lanes> running_{}, is_new_{};
    std::array<arm3r_outcome, lanes> outcome_{};
    bool failed_ = false;
    struct Contacts {
        double count, events, first_contact, first_release, time, since;
    };
    std::array<Contacts, lanes> contacts_;
};

}  // namespace arm3r

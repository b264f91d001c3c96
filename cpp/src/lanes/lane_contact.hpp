#pragma once
// The contact of every lane: the mode it is in, the changes so far, and the peak and the impulse of the normal force
// (4.8). Steps without a change are added on the number type, the others lane by lane in doubles.

#include <algorithm>
#include <array>

#include "arm3r/numbers/polynomial.hpp"
#include "arm3r/numbers/widths.hpp"
#include "contact/contact_change.hpp"
#include "record/contact_tally.hpp"
#include "setup/setup.hpp"

namespace arm3r {

// N: the normal force over a step of h seconds from theta = a to b, at five equidistant points of the depth.
template <class P, class S>
ARM3R_INLINE std::array<S, 5> normal_forces(const Contact<P>& law, const Polynomial<S>& depth, const S& h, const S& a,
                                            const S& b) {
    std::array<S, 5> force;
    const S o(0.0);
    for (int i = 0; i < 5; ++i) {
        const S theta = a + (b - a) * (0.25 * i);
        force[i] = normal_force(law, Indentation<S>{value(depth, theta), slope(depth, theta) / h, o, o, o, o});
    }
    return force;
}

// A step, or a part of it, of one lane: from theta = a to b of h seconds that begin at t0.
struct StepPart {
    double t0, h, a, b;
};

template <class T>
class LaneContact {
public:
    using Mask = typename Lanes<T>::Mask;
    static constexpr int lanes = Lanes<T>::count;

    LaneContact(const Contact<T>& law, bool sums_force) : law_(law), is_elastic_(!sums_force) {}

    // The run of the lane begins without contact.
    void load_lane(int lane, const Contact<double>& law, double start);
    void set_mode(int lane, ContactMode mode);
    // The run begins in contact.
    void begin(int lane, double t, double depth, double force);
    // Counts a change of the mode. Returns whether there are too many.
    bool count(int lane, const ContactChange& change);

    // In every mode, for sensors and performance.
    const Contact<T>& law() const { return law_; }
    // Then depths are summed, and the force is the stiffness times the depth.
    bool is_elastic() const { return is_elastic_; }
    ContactMode mode(int lane) const { return mode_[lane]; }
    ARM3R_INLINE const Mask& touching() const { return touching_; }
    ARM3R_INLINE const Mask& embedded() const { return embedded_; }
    ARM3R_INLINE const Mask& separated() const { return separated_; }
    ARM3R_INLINE bool any_touching() const { return any_touching_; }
    ARM3R_INLINE bool any_embedded() const { return any_embedded_; }
    // Whether the first contact of a lane is transient, and until when, s; infinite in the others.
    bool any_transient() const { return is_any_transient_; }
    const T& transient_until() const { return transient_until_; }
    // Where the first contact ceases to be transient by t.
    ARM3R_INLINE Mask ends_transient(const T& t) const {
        return is_any_transient_ ? t >= transient_until_ : Mask(false);
    }

    // ---- a step

    const T& max_depth() const { return max_depth_; }  // m, of the run so far, of an elastic contact
    // Whether the face may be crossed at depths between low and high.
    ARM3R_INLINE Mask may_cross(const T& low, const T& high) const {
        const T o(0.0);
        const Mask below = touching_ || embedded_;
        return (below && low <= o) || (!below && high > o);
    }
    // Whether the depth may have its greatest value of the run before the end of a step.
    ARM3R_INLINE Mask may_peak(const T& before_end, const T& end) const {
        return touching_ && before_end > max(max_depth_, end);
    }

    // Adds a step to t where `here`, with its mean depth and the depth at its end.
    ARM3R_INLINE void add_elastic(const Mask& here, const T& end, const T& mean, const T& h, const T& t) {
        update_peak(here, end, t, max_depth_);
        depth_time_ = depth_time_ + select(here, T(h * mean), T(0.0));
    }
    // The same of a step, or its part until a change, where `here`: `depth_time` is the integral of its depth. Where
    // `is_known`, its largest depth is `most`, at t; elsewhere it is not larger than the depths before.
    ARM3R_INLINE void add_part(const Mask& here, const Mask& is_known, const T& most, const T& t, const T& depth_time) {
        update_peak(is_known, most, t, max_depth_);
        depth_time_ = depth_time_ + select(here, depth_time, T(0.0));
    }
    // The same for a damped contact; a lane in which the force may have a maximum within the step is handled alone.
    ARM3R_INLINE void add_damped(const Mask& here, const Polynomial<T>& depth, const T& t0, const T& h, const T& t) {
        const T o(0.0);
        const std::array<T, 5> force = normal_forces(law_, depth, h, o, T(1.0));
        const Mask turns = here && range_of(through_five(force)).high > max(peak_, force[4]);
        const Mask rises = here && !turns;
        update_peak(rises, force[4], t, peak_);
        impulse_ = impulse_ + select(rises, T(h * mean_of_five(force)), o);
        if (!in_any_lane(turns)) return;
        for (int lane = 0; lane < lanes; ++lane) {
            if (!Lanes<T>::is(turns, lane)) continue;
            std::array<double, 5> alone;
            for (int i = 0; i < 5; ++i) alone[i] = Lanes<T>::get(force[i], lane);
            add_forces(lane, alone, Lanes<T>::get(t0, lane), Lanes<T>::get(h, lane));
        }
    }
    // The largest force and its time, and the impulse, where forces are summed.
    const T& peak() const { return peak_; }
    const T& peak_time() const { return peak_time_; }
    ARM3R_INLINE void set_peak(const Mask& here, const T& force, const T& t) {
        peak_ = select(here, force, peak_), peak_time_ = select(here, t, peak_time_);
    }
    void set_peak(int lane, const Peak& peak) {
        Lanes<T>::set(peak_, lane, peak.force), Lanes<T>::set(peak_time_, lane, peak.t);
    }
    ARM3R_INLINE void add_impulse(const T& impulse) { impulse_ = impulse_ + impulse; }
    // The first contact of a lane ceases to be transient, with this peak.
    void end_transient(int lane, const Peak& peak);
    // Adds a part of a step of one lane, in its present mode.
    void add(int lane, const Contact<double>& law, const Polynomial<double>& depth, const StepPart& part);

    // ---- the run so far

    const ContactTally& tally(int lane) const { return tally_[lane]; }
    Peak peak(int lane) const {
        const double force =
            is_elastic_ ? stiffness(lane) * Lanes<T>::get(max_depth_, lane) : Lanes<T>::get(peak_, lane);
        return {force, Lanes<T>::get(peak_time_, lane)};
    }
    double impulse(int lane) const {  // N s, normal
        return is_elastic_ ? stiffness(lane) * Lanes<T>::get(depth_time_, lane) : Lanes<T>::get(impulse_, lane);
    }

private:
    double stiffness(int lane) const { return Lanes<T>::get(law_.stiffness[0], lane); }
    // Adds five forces over a part of a step.
    void add_forces(int lane, const std::array<double, 5>& force, double t0, double duration);
    // Includes the largest depth or force of a part of a step in the peak.
    void include_peak(int lane, const Contact<double>& law, const Polynomial<double>& depth, const StepPart& part);
    void include_peak(int lane, const std::array<double, 5>& force, double t0, double duration);
    void store_transient(int lane);
    void update_peak(int lane, double value, double t, T& peak);
    // Updates `peak`, of the depth or of the force, and its time t, where `here`.
    ARM3R_INLINE void update_peak(const Mask& here, const T& value, const T& t, T& peak) {
        peak_time_ = select(here && value > peak, t, peak_time_);
        peak = max_where(here, peak, value);
    }

    Contact<T> law_;
    bool is_elastic_;
    std::array<ContactMode, lanes> mode_{};
    Mask touching_ = false, embedded_ = false, separated_ = false;  // touching_: in the mode `contact`
    bool any_touching_ = false, any_embedded_ = false;
    T max_depth_{0.0}, depth_time_{0.0};  // m, m s: where depths are summed
    T peak_{0.0}, impulse_{0.0};          // N, N s: where forces are
    T peak_time_{0.0};                    // s
    T transient_until_{infinite};         // s
    bool is_any_transient_ = false;
    std::array<ContactTally, lanes> tally_{};
};

}  // namespace arm3r

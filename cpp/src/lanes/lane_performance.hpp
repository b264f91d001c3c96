#pragma once
// The metrics of a controller's performance in every lane (8.10). A segment of a step is sampled on the number type; a
// lane in which it must be refined, or in which steps of one length have a change of contact, is handled alone in doubles.

#include "arm3r/numbers/widths.hpp"
#include "run/performance.hpp"

namespace arm3r {

// One instant of all lanes, as the metrics see it.
template <class T>
struct LaneInstant {
    const T& t;
    const Pose<T>& p;
    const WallState<T>& wall;
    const Indentation<T>& in;
    const Vec3<T>& tau;
};

template <class T>
class LanePerformance {
public:
    using Mask = typename Lanes<T>::Mask;

    // contact: its law in every mode.
    LanePerformance(const Setup& any_lane, const Plant<T>& plant, const Contact<T>& contact,
                    const Controller<T>& controller)
        : is_on_(any_lane.has_performance()),
          sums_work_(is_on_ && any_lane.metrics.wants(MetricGroup::work)),
          tracked_(tracked_quantities(any_lane)),
          plant_(plant),
          contact_(contact),
          controller_(controller) {}

    // Of an equal run: what it refers to stays.
    LanePerformance& operator=(const LanePerformance& other) {
        sums_ = other.sums_, segment_ = other.segment_, last_ = other.last_, continues_ = other.continues_;
        force_phase_ = other.force_phase_, tau_at_start_ = other.tau_at_start_;
        return *this;
    }

    bool is_on() const { return is_on_; }
    // Whether the works of the torques are needed, and whether more than these is.
    bool sums_work() const { return sums_work_; }
    bool samples() const { return is_on_ && tracked_.anything(); }
    ARM3R_INLINE const TrackedQuantities& tracked() const { return tracked_; }
    // At the start of the segment; a sampled controller holds it.
    ARM3R_INLINE const Vec3<T>& torque_at_start() const { return tau_at_start_; }
    ARM3R_INLINE const T& force_phase() const { return force_phase_; }

    // The run of the lane has no segments yet.
    void load_lane(int lane) {
        set_sums(lane, {});
        Lanes<T>::mark(continues_, lane, false);
    }

    // Starts a segment; contact, phase and a held torque are constant within it.
    void begin(const LaneInstant<T>& now, const Mask& touching, const T& force_phase);
    // Takes sample j of the segment.
    ARM3R_INLINE void sample(std::size_t j, const LaneInstant<T>& now) {
        PerformanceSample<T>& sample = segment_.samples[j];
        sample_motion(tracked_, plant_, contact_, controller_, now.t, now.p, now.wall, now.in, segment_.touching,
                      force_phase_, sample);
        sample_torque(now, sample);
    }
    // The segment ends now: adds it to the sums where `moved`, and sets the lanes in which it must be refined.
    template <const auto& rule>
    void end(const LaneInstant<T>& now, const T& duration, const Mask& moved, Mask& unresolved);
    // The next segment begins where this one ends, and `here` nothing jumps there: neither the contact nor a formula of
    // time.
    ARM3R_INLINE void continue_motion(const Mask& here) { continues_ = here; }
    // Adds the work of each torque in the segment, in J, where `moved`.
    ARM3R_INLINE void add_work(const Vec3<T>& work, const Mask& moved) {
        for (int i = 0; i < 3; ++i) sums_.work[i] = sums_.work[i] + select(moved, work[i], T(0.0));
    }

    // Adds a whole segment where `moved`, of which `sample_at(j, sample)` takes sample j; phase and a held torque are those
    // of the segment. Returns the lanes in which it must be refined.
    template <const auto& rule, class SampleAt>
    ARM3R_INLINE Mask add_whole(const T& start, const T& duration, const Mask& touching, const T& force_phase,
                                const Vec3<T>& held, const Mask& moved, SampleAt sample_at) {
        segment_.start = start, segment_.duration = duration, segment_.touching = touching;
        force_phase_ = force_phase, tau_at_start_ = held;
#pragma GCC unroll 1
        for (std::size_t j = 0; j < rule.node.size(); ++j) sample_at(j, segment_.samples[j]);
        return add_segment(tracked_, rule, moved, segment_, sums_);
    }
    const Controller<T>& controller() const { return controller_; }
    ARM3R_INLINE bool was_touching(int lane) const { return Lanes<T>::is(segment_.touching, lane); }

    // Adds the part of a lane's step from theta = a to b, without the works.
    template <std::size_t n>
    void add(int lane, const Rule<n>& rule, const StepView& view, double a, double b) {
        PerformanceSums<double> sums = this->sums(lane);
        add_whole_segment(rule, view.pressed, view, a, b, sums);
        set_sums(lane, sums);
    }
    // Refines a lane's last segment between its samples; it ends at theta = b of the step.
    template <std::size_t n>
    void refine(int lane, const Rule<n>& rule, const StepView& view, double b) {
        const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
        Segment<double> segment{get(segment_.start), get(segment_.duration), was_touching(lane), {}};
        for (std::size_t j = 0; j < n; ++j) {
            const PerformanceSample<T>& sample = segment_.samples[j];
            segment.samples[j] = {get(sample.force), get(sample.desired_force), get(sample.path_error_2),
                                  get(sample.saturated)};
        }
        PerformanceSums<double> sums = this->sums(lane);
        refine_segment(rule, segment, view, 0, b, sums);
        set_sums(lane, sums);
    }

    PerformanceSums<double> sums(int lane) const;

private:
    ARM3R_INLINE void sample_torque(const LaneInstant<T>& now, PerformanceSample<T>& sample) {
        sample_saturation(plant_.arm, plant_.holds_torque ? tau_at_start_ : now.tau, sample);
    }
    void set_sums(int lane, const PerformanceSums<double>& sums);

    const bool is_on_, sums_work_;
    const TrackedQuantities tracked_;
    const Plant<T>& plant_;
    const Contact<T>& contact_;
    const Controller<T>& controller_;

    PerformanceSums<T> sums_;
    Segment<T> segment_;
    PerformanceSample<T> last_;  // of the segment before
    Mask continues_ = false;
    T force_phase_{0.0};
    Vec3<T> tau_at_start_ = zero_vector<T>();  // N m
};

}  // namespace arm3r

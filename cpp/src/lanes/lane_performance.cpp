#include "lanes/lane_performance.hpp"

#include "arm3r/numbers/eigen_traits.hpp"

namespace arm3r {

template <class T>
void LanePerformance<T>::begin(const LaneInstant<T>& now, const Mask& touching, const T& force_phase) {
    Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA {
        segment_.start = now.t;
        segment_.touching = touching;
        const Mask continues = continues_ && force_phase == force_phase_;
        continues_ = false;
        force_phase_ = force_phase;
        tau_at_start_ = now.tau;
        PerformanceSample<T>& first = segment_.samples[0];
        if (!in_all_lanes(continues)) {
            sample(0, now);
            last_ = select_sample(continues, last_, first);
        }
        first = last_;
        sample_torque(now, first);
    });
}

template <class T>
template <const auto& rule>
void LanePerformance<T>::end(const LaneInstant<T>& now, const T& duration, const Mask& moved, Mask& unresolved) {
    Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA {
        segment_.duration = duration;
        const T t = slightly_before(now.t);
        constexpr std::size_t last = rule.node.size() - 1;
        sample(last, {t, now.p, now.wall, now.in, now.tau});
        last_ = segment_.samples[last];
        unresolved = add_segment(tracked_, rule, moved, segment_, sums_);
    });
}

template <class T>
PerformanceSums<double> LanePerformance<T>::sums(int lane) const {
    PerformanceSums<double> sums;
    each_sum([&](double& to, const T& from) { to = Lanes<T>::get(from, lane); }, sums, sums_);
    return sums;
}

template <class T>
void LanePerformance<T>::set_sums(int lane, const PerformanceSums<double>& sums) {
    each_sum([&](T& to, const double& from) { Lanes<T>::set(to, lane, from); }, sums_, sums);
}

// Each member by name: `template class` would also compile the functions that are inlined everywhere (ARM3R_INLINE).
#define ARM3R_LANE_PERFORMANCE_END(T, rule) \
    template void LanePerformance<T>::end<rule>(const LaneInstant<T>&, const T&, const Mask&, Mask&);
#define ARM3R_LANE_PERFORMANCE(T)                                                          \
    template void LanePerformance<T>::begin(const LaneInstant<T>&, const Mask&, const T&); \
    ARM3R_LANE_PERFORMANCE_END(T, trapezoid)                                               \
    ARM3R_LANE_PERFORMANCE_END(T, simpson)                                                 \
    ARM3R_LANE_PERFORMANCE_END(T, lobatto)                                                 \
    template PerformanceSums<double> LanePerformance<T>::sums(int) const;                  \
    template void LanePerformance<T>::set_sums(int, const PerformanceSums<double>&);
ARM3R_LANE_TYPES(ARM3R_LANE_PERFORMANCE)

}  // namespace arm3r

#include "lanes/lane_contact.hpp"

#include <algorithm>

#include "arm3r/lanes.hpp"

namespace arm3r {

template <class T>
void LaneContact<T>::load_lane(int lane, const Contact<double>& law, double start) {
    const auto set = [lane](T& x, double value) { Lanes<T>::set(x, lane, value); };
    each_contact_number(set, law_, law);
    for (T* zero : {&max_depth_, &depth_time_, &peak_, &impulse_}) set(*zero, 0.0);
    set(peak_time_, start);
    tally_[lane] = {};
    store_transient(lane);
}

template <class T>
void LaneContact<T>::set_mode(int lane, ContactMode mode) {
    mode_[lane] = mode;
    Lanes<T>::mark(touching_, lane, mode == ContactMode::contact);
    Lanes<T>::mark(embedded_, lane, mode == ContactMode::embedded);
    Lanes<T>::mark(separated_, lane, mode == ContactMode::separated);
    any_touching_ = std::ranges::count(mode_, ContactMode::contact) > 0;
    any_embedded_ = std::ranges::count(mode_, ContactMode::embedded) > 0;
}

template <class T>
void LaneContact<T>::begin(int lane, double t, double depth, double force) {
    tally_[lane].begin(t);
    Lanes<T>::set(max_depth_, lane, depth);
    Lanes<T>::set(peak_, lane, force);
    store_transient(lane);
}

template <class T>
bool LaneContact<T>::count(int lane, const ContactChange& change) {
    if (change.breaks()) tally_[lane].end_transient(peak(lane));
    tally_[lane].add(change);
    store_transient(lane);
    return tally_[lane].is_event_storm();
}

template <class T>
void LaneContact<T>::add(int lane, const Contact<double>& law, const Polynomial<double>& depth, const StepPart& part) {
    const auto& [t0, h, a, b] = part;
    if (const double until = tally_[lane].transient_until; t0 + h * b >= until) {
        include_peak(lane, law, depth, {t0, h, a, std::max((until - t0) / h, a)});
        end_transient(lane, peak(lane));
    }
    if (mode_[lane] != ContactMode::contact) return;
    if (!is_elastic_) return add_forces(lane, normal_forces(law, depth, h, a, b), t0 + h * a, h * (b - a));
    include_peak(lane, law, depth, part);
    Lanes<T>::set(depth_time_, lane, Lanes<T>::get(depth_time_, lane) + h * integral(depth, a, b));
}

template <class T>
void LaneContact<T>::include_peak(int lane, const Contact<double>& law, const Polynomial<double>& depth,
                                  const StepPart& part) {
    if (mode_[lane] != ContactMode::contact) return;
    const auto& [t0, h, a, b] = part;
    if (!is_elastic_) return include_peak(lane, normal_forces(law, depth, h, a, b), t0 + h * a, h * (b - a));
    if (!(range_of(depth).high > Lanes<T>::get(max_depth_, lane))) return;
    const Maximum most = maximum(depth, a, b);
    update_peak(lane, most.value, t0 + h * most.position, max_depth_);
}

template <class T>
void LaneContact<T>::include_peak(int lane, const std::array<double, 5>& force, double t0, double duration) {
    const Polynomial<double> over_time = through_five(force);
    if (!(range_of(over_time).high > Lanes<T>::get(peak_, lane))) return;
    const Maximum most = maximum(over_time, 0, 1);
    update_peak(lane, most.value, t0 + duration * most.position, peak_);
}

template <class T>
void LaneContact<T>::end_transient(int lane, const Peak& peak) {
    tally_[lane].end_transient(peak);
    store_transient(lane);
}

template <class T>
void LaneContact<T>::store_transient(int lane) {
    Lanes<T>::set(transient_until_, lane, tally_[lane].transient_until);
    is_any_transient_ = std::ranges::any_of(tally_, &ContactTally::is_transient);
}

template <class T>
void LaneContact<T>::add_forces(int lane, const std::array<double, 5>& force, double t0, double duration) {
    include_peak(lane, force, t0, duration);
    Lanes<T>::set(impulse_, lane, Lanes<T>::get(impulse_, lane) + duration * mean_of_five(force));
}

template <class T>
void LaneContact<T>::update_peak(int lane, double value, double t, T& peak) {
    if (!(value > Lanes<T>::get(peak, lane))) return;
    Lanes<T>::set(peak, lane, value);
    Lanes<T>::set(peak_time_, lane, t);
}

// Each member by name: `template class` would also compile the functions that are inlined everywhere (ARM3R_INLINE).
#define ARM3R_LANE_CONTACT(T)                                                                                   \
    template void LaneContact<T>::load_lane(int, const Contact<double>&, double);                               \
    template void LaneContact<T>::set_mode(int, ContactMode);                                                   \
    template void LaneContact<T>::end_transient(int, const Peak&);                                              \
    template void LaneContact<T>::begin(int, double, double, double);                                           \
    template bool LaneContact<T>::count(int, const ContactChange&);                                             \
    template void LaneContact<T>::add(int, const Contact<double>&, const Polynomial<double>&, const StepPart&); \
    template void LaneContact<T>::add_forces(int, const std::array<double, 5>&, double, double);
ARM3R_LANE_TYPES(ARM3R_LANE_CONTACT)

}  // namespace arm3r

#include "score.hpp"

#include <cmath>

#include "lane_access.hpp"

namespace arm3r {

template <class T>
void Score<T>::put(int lane) {
    for (T* zero : {&touching_time_, &miss_2_, &reached_, &largest_miss_, &overshoot_, &path_2_, &largest_path_2_,
                    &saturated_time_, &work_[0], &work_[1], &work_[2]})
        Lanes<T>::set(*zero, lane, 0.0);
    Lanes<T>::set(unsettled_until_, lane, never);
}

template <class T>
void Score<T>::tell(int lane, const Setup& setup, Metrics& m) const {
    const auto get = [&](const T& x) { return Lanes<T>::get(x, lane); };
    const Controller<double>& controller = setup.law();
    const double duration = m.t_end - setup.start, touching = get(touching_time_);
    if (wants_force(controller.type) && m.contacts > 0) {
        m.force_error_rms = touching > 0 ? std::sqrt(get(miss_2_) / touching) : m.force_error_rms;
        if (get(reached_) > 0) m.force_error_peak = get(largest_miss_);
        m.overshoot = get(overshoot_);
        const double unsettled_until = get(unsettled_until_);
        if (unsettled_until < m.t_end) m.settling_time = std::max(0.0, unsettled_until - m.first_contact);
    }
    if (wants_path(controller.type) && duration > 0) {
        m.path_error_rms = std::sqrt(get(path_2_) / duration);
        m.path_error_max = std::sqrt(get(largest_path_2_));
    }
    m.saturation_share = duration > 0 ? get(saturated_time_) / duration : 0;
    for (int i = 0; i < 3; ++i) m.work[std::size_t(i)] = get(work_[i]);
}

template class Score<double>;
#if !ARM3R_ONE_LANE
template class Score<Pack<2>>;
#endif
#if ARM3R_WIDE_PACKS
template class Score<Pack<4>>;
template class Score<Pack<8>>;
#endif

}  // namespace arm3r

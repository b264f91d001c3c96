#pragma once
// Groups of metrics of a controller's performance (8.10): those of a group come out of the same samples. A group that is not
// asked for is not computed.

#include <bitset>
#include <cstddef>

namespace arm3r {

enum class MetricGroup : std::size_t {
    others,          // of every run, at no cost
    force_error,     // its mean square
    force_extremes,  // overshoot and shortfall
    settling,
    path_error,  // its mean square
    path_maximum,
    saturation,
    work,  // of each torque
    count,
};

class MetricGroups {
public:
    static MetricGroups all() {
        MetricGroups groups;
        groups.wanted_.set();
        return groups;
    }
    void add(MetricGroup group) { wanted_.set(std::size_t(group)); }
    bool wants(MetricGroup group) const { return wanted_.test(std::size_t(group)); }
    // Whether anything of a controller's performance is wanted.
    bool want_performance() const { return (wanted_ >> 1).any(); }

private:
    std::bitset<std::size_t(MetricGroup::count)> wanted_;
};

}  // namespace arm3r

#pragma once
// Sets that contain all motions of an arm for some time, though a wall pushes it with a force that is known only in its
// impulse; docs/model.md (9.2). For torques that follow from the pose alone.

#include <optional>

#include "arm3r/plant.hpp"
#include "trust/interval.hpp"

namespace arm3r {

// Whether the torques of the setup's plant follow from the pose, and nothing but the wall touches the arm.
bool is_passive(const Plant<double>& plant);

// The states that the motion may have, and what they let be seen from the tip along a unit vector n.
struct Enclosure {
    Vec3<Interval> q, qd;
    Interval mobility_rate;  // 1/(kg s), of n J M^-1 J^T n
    Interval acceleration;   // m/s^2, of the tip along n, less what a force along n adds
    Vec3<Interval> tip_velocity;
};

struct Span {
    double time, impulse;  // s, N s
};

// From the state (q, qd) on for at most the given time, while forces along n give at most the impulse. Nothing where
// none is found: the time is too long.
std::optional<Enclosure> enclose(const Plant<double>& plant, const Vec3<double>& n, const Vec3<double>& q,
                                 const Vec3<double>& qd, const Span& span);

// The same of the state itself.
Enclosure at_instant(const Plant<double>& plant, const Vec3<double>& n, const Vec3<double>& q, const Vec3<double>& qd);

}  // namespace arm3r

#pragma once
// A mass that meets a spring with a damper, and how far a motion with nearly the same equation departs from it;
// docs/model.md (9.1), (9.3).

#include <optional>

namespace arm3r {

// m depth'' + c depth' + k depth = m g, from depth 0 at the speed v > 0, with c < 2 sqrt(k m).
struct LinearImpact {
    double m, k, c, v, g;  // kg, N/m, N s/m, m/s, m/s^2

    double force(double t) const;         // k depth + c depth', N
    double speed(double t) const;         // depth', m/s
    double time_of_peak() const;          // s
    double time_of_least_force() const;   // s, of the first minimum after the peak
    double time_of_fall(double f) const;  // s, when the force falls through f, which lies between minimum and peak
};

// The numbers of a contact, from its beginning until the depth is 0 again; and bounds of how far those of a motion
// depart whose equation differs.
struct ImpactNumbers {
    double peak_force, duration, impulse;  // N, s, N s
};

// Nothing where the tip does not come back.
std::optional<ImpactNumbers> numbers_of(const LinearImpact& impact);

// What the equation of a motion, depth'' = g + r(t) - w(t) f, has more than that of the impact, up to some time.
struct Disturbance {
    double acceleration;   // m/s^2, |r| at most
    double mobility_rate;  // 1/(kg s), |dw/dt| at most, from w = 1/m on
    double time;           // s
};

struct Departures {
    ImpactNumbers most;
    double end;  // s: the contact is over by then, and the bounds hold if the disturbance does up to then
};

// Nothing where the motion might depart beyond all bounds.
std::optional<Departures> departures(const LinearImpact& impact, const Disturbance& disturbance);

}  // namespace arm3r

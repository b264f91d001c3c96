#pragma once
// When the tip touches the wall and lets go of it, found on the solution within a step; docs/model.md (4.8), (5.3).

#include <array>
#include <optional>

#include "contact/contact_change.hpp"

namespace arm3r {

// The largest normal force so far.
struct Peak {
    double force = 0, t = 0;  // N, s

    void include(double force_here, double t_here) {
        if (force_here > force) *this = {force_here, t_here};
    }
};

class ContactWatch {
public:
    // `looks`: at how many places per step the depth is looked at, ends included.
    ContactWatch(const Plant<double>& plant, int looks) : plant_(plant), looks_(looks) {}

    Mode mode_at_start(double t, const FullState& y) const;

    // The first change of mode after `from`, or nothing. `peak` grows to the largest normal force that contact reaches
    // between the two.
    std::optional<Crossing> next(const Inside& inside, double from, Mode mode, Peak& peak) const;

    // Integral of the normal force of contact, N s, along the solution from place a to place b within the step.
    double impulse(const Inside& inside, double a, double b) const;

private:
    // Depth and the four distances inside the outline, m; then what tells when a damped law would pull (Push::release),
    // and the normal force, N. The rates have the right sign.
    struct Look {
        std::array<double, 7> value, rate;
    };
    struct Falling {
        int signal;
        double sign;  // the event is where sign*value falls below zero
        Mode next;
    };

    static bool has_fallen(const Falling& falling, const Look& here);
    static bool within_outline(const Look& here);
    Look look(const Inside& inside, double theta) const;
    std::optional<double> first_fall(const Inside& inside, const Falling& falling, double a, const Look& at_a, double b,
                                     const Look& at_b) const;
    double turning_point(const Inside& inside, const Falling& falling, double a, double b) const;
    // The largest normal force from a to b in contact joins the peak.
    void look_for_peak(const Inside& inside, double a, const Look& at_a, double b, const Look& at_b, Peak& peak) const;
    double root(const Inside& inside, const Falling& falling, double a, double b) const;

    const Plant<double>& plant_;
    int looks_;
};

}  // namespace arm3r

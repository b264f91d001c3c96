#pragma once
// Location of the instants at which contact begins and ends, on the dense output of a step; docs/model.md (4.8), (5.3).

#include <array>
#include <optional>

#include "contact/contact_change.hpp"

namespace arm3r {

class ContactSearch {
public:
    explicit ContactSearch(const Plant<double>& plant) : plant_(plant) {}

    // The first change of mode after `from`, if there is one. `peak` becomes the largest normal force in contact until
    // then.
    std::optional<Crossing> next(const DenseOutput& dense, double from, ContactMode mode, Peak& peak) const;

    // Includes the largest normal force in contact from theta = 0 to `end` in the peak; no change of mode lies between.
    void include_peak(const DenseOutput& dense, double end, Peak& peak) const;

    // Integral of the normal contact force, N s, along the solution from theta = a to b of the step. A force that is a
    // broken power of the depth is integrated in parts, which are the shorter the nearer the depth is to zero.
    double impulse(const DenseOutput& dense, double a, double b) const;

private:
    // The signals at an instant: the depth and the four distances inside the outline, m; the signal that is negative
    // where a damped law would pull (NormalForce::release); the normal force, N. The rates are by theta where a damped law
    // gives the signal, else by time.
    struct SignalSample {
        std::array<double, 7> value, rate;
    };
    struct ZeroCrossing {
        int signal;
        double sign;  // the event is where sign*value falls below zero
        ContactMode next;
    };

    static bool has_crossed(const ZeroCrossing& event, const SignalSample& here);
    static bool within_outline(const SignalSample& here);
    SignalSample sample(const DenseOutput& dense, double theta) const;
    std::optional<double> first_crossing(const DenseOutput& dense, const ZeroCrossing& event, double a,
                                         const SignalSample& at_a, double b, const SignalSample& at_b) const;
    double turning_point(const DenseOutput& dense, const ZeroCrossing& event, double a, double b) const;
    // A bound of a signal that turns between a and b.
    double turning_value(const DenseOutput& dense, int signal, double a, const SignalSample& at_a, double b,
                         const SignalSample& at_b) const;
    // Includes the largest normal force in contact from a to b in the peak.
    void update_peak(const DenseOutput& dense, double a, const SignalSample& at_a, double b, const SignalSample& at_b,
                     Peak& peak) const;
    // Halves a part in which the depth grows by much, at most so many times, unless all of it is below `least`, m.
    double impulse_in_parts(const DenseOutput& dense, double a, double depth_a, double b, double depth_b, double least,
                            int halvings) const;
    double depth(const DenseOutput& dense, double theta) const;  // m
    double root(const DenseOutput& dense, const ZeroCrossing& event, double a, double b) const;

    const Plant<double>& plant_;
};

}  // namespace arm3r

#pragma once
// Contact within one step, from polynomials in theta in [0, 1]: the depth of the tip and its place on the plate. These
// functions handle one lane; the callers detect for all lanes at once that nothing happens, which is the usual case.
// docs/model.md (4.8).

#include <optional>

#include "arm3r/numbers/polynomial.hpp"
#include "contact/contact_mode.hpp"
#include "integrate/dense_output.hpp"

namespace arm3r {

inline constexpr double event_time_tolerance = 1e-14;  // s

// The largest normal force so far.
struct Peak {
    double force = 0, t = 0;  // N, s

    void include(double force_here, double t_here) {
        if (force_here > force) *this = {force_here, t_here};
    }
};

struct Crossing {
    double theta;  // where in the step, in (from, 1]
    ContactMode next;
};

// A change of the contact mode: its instant, as theta and in seconds, and the energy that is lost or gained.
struct ContactChange {
    double theta, t;  // t: s
    // J: energy of the springs that is lost when contact ends; energy of the springs along the plate that are strained
    // at once
    double lost, gained;
    ContactMode from, to;

    bool makes() const { return !is_touching(from) && is_touching(to); }
    bool breaks() const { return is_touching(from) && !is_touching(to); }
    double lost_at_edge() const { return to == ContactMode::embedded ? lost : 0; }  // J
};

// The same for a tip with the indentation `in` at that instant.
ContactChange change_at(const Plant<double>& plant, const Indentation<double>& in, double theta, double t,
                        ContactMode from, ContactMode to);

template <class T>
struct ContactSignals {
    Polynomial<T> depth, across1, across2;  // m
};

// Whether contact depends on where on the plate the tip is.
inline bool depends_on_place(const Plant<double>& plant) {
    return plant.wall.has_outline || acts_along_plate(plant.contact.law);
}

template <class T>
struct Range {
    T low, high;
};

// Bounds of the polynomial on [0, 1].
template <class T>
ARM3R_INLINE Range<T> range_of(const Polynomial<T>& p) {
    Range<T> range{p.c[0], p.c[0]};
    for (int i = 1; i <= p.degree; ++i) {
        range.low = range.low + min(p.c[i], T(0.0));
        range.high = range.high + max(p.c[i], T(0.0));
    }
    return range;
}

// The first change of the contact mode after `from`, if there is one. resolution: in theta.
std::optional<Crossing> next_crossing(const Wall<double>& wall, const ContactSignals<double>& signals, double from,
                                      ContactMode mode, double resolution);

}  // namespace arm3r

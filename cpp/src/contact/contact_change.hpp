#pragma once
// Contact within one step, from polynomials of the step's share theta in [0, 1]: how deep the tip is, and where on the
// plate. One lane at a time here; what is usual, that nothing happens, is seen for all lanes at once. docs/model.md (4.8).

#include <optional>

#include "arm3r/numbers/polynomial.hpp"
#include "contact/contact_mode.hpp"
#include "integrate/dense_output.hpp"

namespace arm3r {

inline constexpr double finest_event = 1e-14;  // s

struct Crossing {
    double theta;  // where in the step, in (from, 1]
    Mode next;
};

// A crossing that has been made: where in the step, in seconds too, and what it cost or brought.
struct Change {
    double theta, t;      // t: s
    double lost, gained;  // J: held by the springs that let go; by those along the plate that are taut at once
    Mode from, to;

    bool makes() const { return !is_touching(from) && is_touching(to); }
    bool breaks() const { return is_touching(from) && !is_touching(to); }
    double lost_at_edge() const { return to == Mode::embedded ? lost : 0; }  // J
};

// The same for a tip that stands at `in` then.
Change change_at(const Plant<double>& plant, const Indentation<double>& in, double theta, double t, Mode from, Mode to);

template <class T>
struct ContactSignals {
    Polynomial<T> depth, across1, across2;  // m
};

template <class T>
struct Range {
    T low, high;
};

// Between these a polynomial lies on [0, 1].
template <class T>
ARM3R_INLINE Range<T> range_of(const Polynomial<T>& p) {
    Range<T> range{p.c[0], p.c[0]};
    for (int i = 1; i <= p.degree; ++i) {
        range.low = range.low + min(p.c[i], T(0.0));
        range.high = range.high + max(p.c[i], T(0.0));
    }
    return range;
}

// The first change of mode after `from`, if there is one. resolution: of theta.
std::optional<Crossing> next_crossing(const Wall<double>& wall, const ContactSignals<double>& signals, double from,
                                      Mode mode, double resolution);

}  // namespace arm3r

#pragma once
// The contacts of one run so far, for every method; docs/model.md (4.8).

#include <cmath>

#include "contact/contact_change.hpp"
#include "record/run_data.hpp"

namespace arm3r {

inline constexpr double max_events = 4096;
inline constexpr double longest_transient = 0.5;  // s: a contact that lasts longer is quasi-static then (ISO/TS 15066)

struct ContactTally {
    double contacts = 0;                                                           // that have begun
    double events = 0;                                                             // beginnings and ends
    double first_contact = Metrics::unknown, first_separation = Metrics::unknown;  // s
    double time_of_ended = 0;                                                      // s, in contacts that have ended
    double since = 0;                                                              // s, when the present contact began
    double lost_at_edges = 0;                             // J, by springs that lose the tip across an edge of the plate
    double transient_until = infinite;                    // s: the peak of the first contact is fixed then
    Peak first_peak{Metrics::unknown, Metrics::unknown};  // of the first contact, as long as it is transient

    void begin(double t) {
        if (contacts == 0) first_contact = t, transient_until = t + longest_transient;
        contacts += 1;
        events += 1;
        since = t;
    }
    void end(double t) {
        if (std::isnan(first_separation)) first_separation = t;
        events += 1;
        time_of_ended += t - since;
    }
    bool is_transient() const { return transient_until < infinite; }
    // `peak`: of the run so far.
    void end_transient(const Peak& peak) {
        if (!is_transient()) return;
        first_peak = peak;
        transient_until = infinite;
    }
    // The peak of the first contact in a run that has this peak so far.
    Peak peak_of_first(const Peak& peak) const { return is_transient() ? peak : first_peak; }
    // Before a change that breaks contact, end_transient() is called.
    void add(const ContactChange& change) {
        lost_at_edges += change.lost_at_edge();
        if (change.makes()) begin(change.t);
        if (change.breaks()) end(change.t);
    }
    bool is_event_storm() const { return events > max_events; }
    double contact_time(double t, bool is_touching) const {  // s, up to t
        return time_of_ended + (is_touching ? t - since : 0);
    }
};

}  // namespace arm3r

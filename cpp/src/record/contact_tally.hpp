#pragma once
// The contacts of one run so far, for every method; docs/model.md (4.8).

#include <cmath>

#include "contact/contact_change.hpp"
#include "record/run_data.hpp"

namespace arm3r {

inline constexpr double max_events = 4096;

struct ContactTally {
    double contacts = 0;                                                           // that have begun
    double events = 0;                                                             // beginnings and ends
    double first_contact = Metrics::unknown, first_separation = Metrics::unknown;  // s
    double time_of_ended = 0;                                                      // s, in contacts that have ended
    double since = 0;                                                              // s, when the present contact began
    double lost_at_edges = 0;  // J, by springs that lose the tip across an edge of the plate

    void begin(double t) {
        if (contacts == 0) first_contact = t;
        contacts += 1;
        events += 1;
        since = t;
    }
    void end(double t) {
        if (std::isnan(first_separation)) first_separation = t;
        events += 1;
        time_of_ended += t - since;
    }
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

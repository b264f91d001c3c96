#include "contact/contact_change.hpp"

namespace arm3r {
namespace {

// Distance from one edge: half - sign*across.
Polynomial<double> inside_edge(double half, double sign, Polynomial<double> across) {
    if (sign > 0) across = negative(across);
    across.c[0] += half;
    return across;
}

// A bound on |p| over [0, 1].
double max_abs(const Polynomial<double>& p) {
    double sum = 0;
    for (int i = 0; i <= p.degree; ++i) sum += abs(p.c[i]);
    return sum;
}

bool within_outline(const Wall<double>& wall, const ContactSignals<double>& signals, double theta) {
    if (!wall.has_outline) return true;
    return abs(value(signals.across1, theta)) <= wall.half1 && abs(value(signals.across2, theta)) <= wall.half2;
}

class EarliestCrossing {
public:
    EarliestCrossing(double from, double resolution) : from_(from), resolution_(resolution) {}

    void include(const Polynomial<double>& g, ContactMode next) {
        if (range_of(g).low > 0) return;
        const std::optional<double> theta = first_crossing(g, from_, resolution_);
        if (theta && (!found_ || *theta < found_->theta)) found_ = {*theta, next};
    }
    std::optional<Crossing> found() const { return found_; }

private:
    double from_, resolution_;
    std::optional<Crossing> found_;
};

}  // namespace

ContactChange change_at(const Plant<double>& plant, const Indentation<double>& in, double theta, double t,
                        ContactMode from, ContactMode to) {
    ContactChange change{theta, t, 0, 0, from, to};
    if (!plant.acts_on_arm) return change;
    const double tangential = stored_tangential(plant.contact, in);
    if (change.breaks()) change.lost = tangential + (in.depth > 0 ? normal_force_law(plant.contact, in).stored : 0);
    if (change.makes()) change.gained = tangential;
    return change;
}

std::optional<Crossing> next_crossing(const Wall<double>& wall, const ContactSignals<double>& signals, double from,
                                      ContactMode mode, double resolution) {
    EarliestCrossing earliest(from, resolution);
    if (mode == ContactMode::free) {
        earliest.include(negative(signals.depth), ContactMode::contact);
        std::optional<Crossing> crossing = earliest.found();
        if (crossing && !within_outline(wall, signals, crossing->theta)) crossing->next = ContactMode::embedded;
        return crossing;
    }
    earliest.include(signals.depth, ContactMode::free);
    if (mode != ContactMode::contact || !wall.has_outline) return earliest.found();
    const auto edges = [&](double half, const Polynomial<double>& across) {
        if (max_abs(across) < half) return;
        for (const double sign : {-1.0, 1.0}) earliest.include(inside_edge(half, sign, across), ContactMode::embedded);
    };
    edges(wall.half1, signals.across1);
    edges(wall.half2, signals.across2);
    return earliest.found();
}

}  // namespace arm3r

#include "contact/contact_change.hpp"

namespace arm3r {
namespace {

// Distance from one edge: half - sign*across.
Polynomial<double> inside_edge(double half, double sign, Polynomial<double> across) {
    if (sign > 0) across = negative(across);
    across.c[0] += half;
    return across;
}

// No value on [0, 1] is larger, either way.
double reach(const Polynomial<double>& p) {
    double sum = 0;
    for (int i = 0; i <= p.degree; ++i) sum += abs(p.c[i]);
    return sum;
}

bool within_outline(const Wall<double>& wall, const ContactSignals<double>& signals, double theta) {
    if (!wall.has_outline) return true;
    return abs(value(signals.across1, theta)) <= wall.half1 && abs(value(signals.across2, theta)) <= wall.half2;
}

class Earliest {
public:
    Earliest(double from, double resolution) : from_(from), resolution_(resolution) {}

    void fall_of(const Polynomial<double>& g, Mode next) {
        if (range_of(g).low > 0) return;
        const std::optional<double> theta = first_fall(g, from_, resolution_);
        if (theta && (!found_ || *theta < found_->theta)) found_ = {*theta, next};
    }
    std::optional<Crossing> found() const { return found_; }

private:
    double from_, resolution_;
    std::optional<Crossing> found_;
};

}  // namespace

Change change_at(const Plant<double>& plant, const Indentation<double>& in, double theta, double t, Mode from,
                 Mode to) {
    Change change{theta, t, 0, 0, from, to};
    if (!plant.acts_on_arm) return change;
    const double sideways = stored_sideways(plant.contact, in);
    if (change.breaks()) change.lost = sideways + (in.depth > 0 ? push(plant.contact, in).stored : 0);
    if (change.makes()) change.gained = sideways;
    return change;
}

std::optional<Crossing> next_crossing(const Wall<double>& wall, const ContactSignals<double>& signals, double from,
                                      Mode mode, double resolution) {
    Earliest earliest(from, resolution);
    if (mode == Mode::free) {
        earliest.fall_of(negative(signals.depth), Mode::contact);
        std::optional<Crossing> crossing = earliest.found();
        if (crossing && !within_outline(wall, signals, crossing->theta)) crossing->next = Mode::embedded;
        return crossing;
    }
    earliest.fall_of(signals.depth, Mode::free);
    if (mode != Mode::contact || !wall.has_outline) return earliest.found();
    const auto edges = [&](double half, const Polynomial<double>& across) {
        if (reach(across) < half) return;
        for (const double sign : {-1.0, 1.0}) earliest.fall_of(inside_edge(half, sign, across), Mode::embedded);
    };
    edges(wall.half1, signals.across1);
    edges(wall.half2, signals.across2);
    return earliest.found();
}

}  // namespace arm3r

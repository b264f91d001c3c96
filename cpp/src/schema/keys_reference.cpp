// The keys of the desired motion and of the desired force.

#include "schema/keys.hpp"

#include "arm3r/model/scalar_motion.hpp"
#include "schema/choice_words.hpp"
#include "schema/key_builders.hpp"

namespace arm3r {
namespace {

Words with_a_path() {
    return laws_that([](const LawProperties& law) { return law.follows_path; });
}

std::vector<Key> reference_keys() {
    std::vector<Key> keys;
    const auto in = [](std::vector<std::string> types, Key key) {
        return where("reference.type", std::move(types), std::move(key));
    };
    keys.push_back(choice("reference.type", words_of<Path>(), Source::ours,
                          "The desired motion of the arm: hold keeps it where it starts."));
    keys.push_back(
        in({"point", "line", "minimum_jerk"},
           derived("not given",
                   number("reference.tip", {unset, unset, unset}, Source::ours, any_position, "m",
                          "Desired position of the tip, base axes; for a line or minimum_jerk the one at its end."))));
    keys.push_back(
        in({"point", "line", "minimum_jerk"},
           derived("not given",
                   of_kind(Kind::angle, number("reference.q", {unset, unset, unset}, Source::ours, {-1e5, 1e5}, "rad",
                                               "Desired joint angles, in place of reference.tip.")))));
    keys.push_back(in({"line", "minimum_jerk", "circle", "sinusoid"},
                      number("reference.start", {0}, Source::ours, an_instant, "s", "When the motion begins.")));
    keys.push_back(in({"line", "minimum_jerk"},
                      number("reference.duration", {1}, Source::ours, {1e-9, 1e9}, "s", "How long the motion takes.")));
    keys.push_back(in({"circle"}, number("reference.radius", {0.1}, Source::ours, {0, 1e6}, "m",
                                         "Radius of a circle on the wall's face through the tip's start.")));
    keys.push_back(in({"circle"}, number("reference.period", {4}, Source::ours, {1e-9, 1e9}, "s",
                                         "Time of one turn of the circle.")));
    keys.push_back(
        in({"circle"}, number("reference.turns", {1}, Source::ours, {1e-3, 1e6}, "",
                              "Number of turns of the circle, which begin and end at rest by a minimum-jerk law.")));
    keys.push_back(
        in({"sinusoid"},
           derived("not given", number("reference.tip_amplitude", {unset, unset, unset}, Source::ours, any_position,
                                       "m", "Amplitude of the tip's sinusoid about its start, base axes."))));
    keys.push_back(in(
        {"sinusoid"},
        derived("not given",
                of_kind(Kind::angle,
                        number("reference.q_amplitude", {unset, unset, unset}, Source::ours, {-1e5, 1e5}, "rad",
                               "Amplitude of the joints' sinusoid about their start, in place of tip_amplitude.")))));
    keys.push_back(in({"sinusoid"}, number("reference.frequency", {0.5}, Source::ours, {0, 1e4}, "Hz",
                                           "Frequency of the sinusoid.")));
    const auto column = [&](const char* path, Bounds bounds, const char* unit, const char* doc) {
        keys.push_back(in({"table"}, table_column(of_the_file, number(path, {}, Source::ours, bounds, unit, doc))));
    };
    keys.push_back(in({"table"}, table_file("reference.file",
                                            "A CSV file with columns t, x, y and z in place of these lists, s and m; a "
                                            "relative name counts from the folder of the scenario.")));
    column("reference.t", an_instant, "s",
           "Instants of the table, increasing; before the first and after the last one the reference is at rest.");
    column("reference.x", any_position, "m",
           "Desired x of the tip at the instants reference.t, base axes; in between it moves with minimum jerk.");
    column("reference.y", any_position, "m",
           "Desired y of the tip at the instants reference.t, base axes; in between it moves with minimum jerk.");
    column("reference.z", any_position, "m",
           "Desired z of the tip at the instants reference.t, base axes; in between it moves with minimum jerk.");
    return keys;
}

std::vector<Key> force_reference_keys() {
    std::vector<Key> keys;
    const auto in = [](std::vector<std::string> types, Key key) {
        return where("reference.force.type", std::move(types), std::move(key));
    };
    keys.push_back(choice("reference.force.type", words_of<ForceProfile>(), Source::ours,
                          "The desired pressing force as a function of time, along the wall's normal."));
    keys.push_back(for_laws(
        of_force(), but({{"admittance", {0}}},
                        number("reference.force.value", {20}, Source::ours, {-1e9, 1e9}, "N",
                               "The desired force; for a step or ramp the one after it, for a sinusoid the mean."))));
    keys.push_back(in({"step", "ramp"}, number("reference.force.initial", {0}, Source::ours, {-1e9, 1e9}, "N",
                                               "The desired force before the step or ramp.")));
    keys.push_back(in({"step", "ramp"}, number("reference.force.start", {1}, Source::ours, an_instant, "s",
                                               "When the desired force begins to change.")));
    keys.push_back(in({"ramp"}, number("reference.force.duration", {1}, Source::ours, {1e-9, 1e9}, "s",
                                       "How long the ramp of the desired force takes.")));
    keys.push_back(in({"sinusoid"}, number("reference.force.amplitude", {2}, Source::ours, {-1e9, 1e9}, "N",
                                           "Amplitude of the desired force about its mean.")));
    keys.push_back(in({"sinusoid"}, number("reference.force.frequency", {2}, Source::ours, {0, 1e4}, "Hz",
                                           "Frequency of the desired force's sinusoid.")));
    return keys;
}

}  // namespace

void append_reference(std::vector<Key>& keys) {
    append_for_laws(keys, with_a_path(), reference_keys());
    append_for_laws(keys, of_force(), force_reference_keys());
}

}  // namespace arm3r

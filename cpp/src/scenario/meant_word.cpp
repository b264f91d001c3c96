#include "scenario/meant_word.hpp"

#include <algorithm>
#include <vector>

#include "base/text.hpp"
#include "files/paths.hpp"
#include "schema/suggest.hpp"

namespace arm3r {

namespace {

// Names that other programs use, as plain_word gives them, and the word here.
struct WordElsewhere {
    std::string_view choice;  // last name of the key
    std::vector<std::string> typed;
    std::string_view word;
    std::string_view note = {};  // how the two differ; "": they do not
};

// docs/from_simulink.md lists these pairs for people.
const std::vector<WordElsewhere>& words_elsewhere() {
    static const std::vector<WordElsewhere> table = {
        {"method", {"ode45", "rk45", "dopri", "dopri45", "dormandprince"}, "dopri5"},
        {"method", {"ode4", "rk", "rungekutta", "rungekutta4"}, "rk4"},
        {"method",
         {"ode1", "ode2", "ode3", "ode5", "euler", "heun", "midpoint", "fixed", "fixedstep", "fixedstepdiscrete",
          "discrete"},
         "rk4",
         "the method with a fixed step"},
        {"method",
         {"ode23", "rk23", "ode78", "ode89", "ode113", "dop853", "adams", "vode", "tsit5", "variablestep"},
         "dopri5",
         "the method of this kind with a variable step"},
        {"method",
         {"ode15s", "ode23s", "ode23t", "ode23tb", "radau", "bdf", "rosenbrock", "cvode", "stiff", "implicit"},
         "rodas4",
         "the method for stiff equations"},
        {"method", {"lsoda", "odeint"}, "auto", "it chooses between dopri5 and rodas4"},
        {"type", {"pid", "pd", "pdcontroller", "pidcontroller"}, "joint_pd", "it has no integral term"},
        {"type", {"inversedynamics", "feedbacklinearization", "ctc", "computedtorquecontrol"}, "computed_torque"},
        {"type", {"gravity", "gravitycompensator", "g", "gravcomp"}, "gravity_compensation"},
        {"type", {"impedancecontrol", "impedancecontroller"}, "impedance"},
        {"type", {"admittancecontrol", "admittancecontroller"}, "admittance"},
        {"type", {"hybridcontrol", "hybridforceposition", "hybridpositionforce", "forcecontrol"}, "hybrid"},
        {"type", {"osc", "khatib"}, "operational_space"},
        {"type",
         {"matlab", "matlabfunction", "python", "custom", "own", "function", "lqr", "mpc", "slidingmode"},
         "user",
         "a law of your own runs by --controller FILE or scenario.run(controller=f)"},
        {"type", {"sine", "sin", "sinewave"}, "sinusoid"},
        {"type", {"fromworkspace", "timeseries", "signalbuilder", "lookup", "spline"}, "table"},
        {"type", {"static", "rest", "still"}, "fixed"},
        {"type", {"quintic", "smooth"}, "ramp"},
        {"type", {"quintic", "minjerk", "trajectory"}, "minimum_jerk"},
        {"law", {"linear", "hooke", "elastic", "penalty"}, "spring"},
        {"law", {"springdamper", "kv", "linearspringdamper", "spatialcontactforce"}, "kelvin_voigt"},
        {"law",
         {"hertz", "hertzian", "hc", "nonlinear"},
         "hunt_crossley",
         "with exponent 1.5 its force without damping is that of Hertz"},
    };
    return table;
}

const WordElsewhere* elsewhere(const Key& key, std::string_view typed) {
    const auto found = std::find_if(words_elsewhere().begin(), words_elsewhere().end(), [&](const WordElsewhere& one) {
        return one.choice == last_name(key.path) && is_in(key.choices, one.word) && is_in(one.typed, plain_word(typed));
    });
    return found == words_elsewhere().end() ? nullptr : &*found;
}

}  // namespace

std::string word_meant(const Key& key, std::string_view typed) {
    for (const std::string& word : key.choices)
        if (!typed.empty() && plain_word(word) == plain_word(typed)) return word;
    const WordElsewhere* found = elsewhere(key, typed);
    return found ? std::string(found->word) : "";
}

std::string suggested_word(const Key& key, std::string_view typed) {
    const std::string meant = word_meant(key, typed);
    if (meant.empty()) return did_you_mean(typed, key.choices);
    const WordElsewhere* found = elsewhere(key, typed);
    const std::string note = found && !found->note.empty() ? " " + std::string(found->note) : "";
    return "did you mean " + meant + "?" + note;
}

}  // namespace arm3r

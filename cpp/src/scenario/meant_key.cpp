#include "scenario/meant_key.hpp"

#include <algorithm>

#include "base/text.hpp"
#include "files/paths.hpp"
#include "schema/suggest.hpp"

namespace arm3r {

namespace {

using Words = std::vector<std::string>;

bool is_digits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// Names that textbooks and other programs use, as plain_word gives them, and the last names of the keys with
// that meaning here. Which of these keys is meant, the section decides.
struct Synonyms {
    Words typed, names;
};

const std::vector<Synonyms>& synonyms() {
    static const std::vector<Synonyms> table = {
        {{"k", "kp", "p", "ke", "kn", "kenv", "stiffness", "jointstiffness", "positiongain"},
         {"joint_stiffness", "position_gain", "stiffness", "gain"}},
        {{"b", "c", "d", "kd", "kv", "de", "damping", "jointdamping", "velocitygain"},
         {"joint_damping", "velocity_gain", "damping", "force_damping"}},
        {{"i", "ki", "kif", "kfi"}, {"force_integral_gain", "inertia", "inertia_axial"}},
        {{"kf", "kpf", "kfp"}, {"force_gain"}},
        {{"m", "md", "forcemass"}, {"mass", "force_mass"}},
        {{"g"}, {"gravity"}},
        {{"gain", "gains"},
         {"joint_stiffness", "joint_damping", "position_gain", "velocity_gain", "stiffness", "damping", "force_gain",
          "gain"}},
        {{"ko"}, {"gain"}},
        {{"q0", "theta", "angles", "position"}, {"q"}},
        {{"qd0", "dq", "dq0", "qdot", "qdot0", "rates", "velocities"}, {"qd"}},
        {{"l", "len", "a"}, {"length"}},
        {{"rho"}, {"density"}},
        {{"lc", "cog", "centerofmass", "centreofmass"}, {"com"}},
        {{"mu"}, {"coefficient"}},
        {{"e", "cor"}, {"restitution"}},
        {{"v", "vel", "speed"}, {"velocity"}},
        {{"a", "amp"}, {"amplitude"}},
        {{"f", "freq"}, {"frequency"}},
        {{"phi"}, {"phase"}},
        {{"w", "omega"}, {"rate", "inner_bandwidth"}},
        {{"r"}, {"radius"}},
        {{"n"}, {"normal"}},
    };
    return table;
}

// Names of what another section holds.
struct Elsewhere {
    Words typed, sections, paths;
};

const std::vector<Elsewhere>& elsewhere() {
    static const Words of_time = {"", "time", "solver"}, of_control = {"", "controller", "reference"};
    static const std::vector<Elsewhere> table = {
        {{"tend", "tstop", "tfinal", "tmax", "tf", "end", "endtime", "stoptime", "duration"}, of_time, {"time.stop"}},
        {{"dt", "h", "step", "timestep", "stepsize", "fixedstep"}, of_time, {"solver.step", "time.log_every"}},
        {{"reltol", "rtol", "tol", "tolerance"}, of_time, {"solver.rtol"}},
        {{"abstol", "atol"}, of_time, {"solver.atol"}},
        {{"maxstep"}, of_time, {"solver.max_step"}},
        {{"solvertype", "integrator", "solvername", "ode"}, of_time, {"solver.method"}},
        {{"fd", "fdes", "fref", "desiredforce", "forceref", "setpoint"}, of_control, {"reference.force.value"}},
        {{"xd", "xdes", "xref", "target", "goal"}, of_control, {"reference.tip"}},
        {{"qd", "qdes", "qref"}, of_control, {"reference.q"}},
        {{"fs", "ts", "rate", "samplerate", "sampletime", "samplingtime", "period"}, of_control, {"sampling.rate"}},
        {{"taumax", "umax", "maxtorque"}, of_control, {"arm.torque_limit"}},
    };
    return table;
}

// Names of what other robots have: of a whole robot, and of one in the section of this arm.
const Words of_robots = {"dof",     "dofs",   "joint",     "joints",   "link",  "links",  "mjcf", "ndof",
                         "njoints", "nlinks", "numjoints", "numlinks", "robot", "robots", "urdf", "xacro"};
const Words of_other_arms = {"alpha", "dh",     "dhparameters", "dhtable", "jointtype", "mdh",
                             "model", "offset", "offsets",      "twist",   "type",      "xml"};

bool is_of_another_robot(std::string_view name, std::string_view section) {
    const bool is_arm = section == "arm" || section.starts_with("arm.") || section.starts_with("controller.model");
    if (!section.empty() && !is_arm) return false;
    const std::string word = plain_word(name), stem = word.substr(0, word.find_last_not_of("0123456789") + 1);
    const bool is_of_dh = (stem != word && is_in({"a", "d", "theta"}, stem)) || (word == "d" && section != "arm");
    return is_in(of_robots, stem) || (is_arm && (is_in(of_other_arms, stem) || is_of_dh));
}

// The keys of a section, or of the sections in it, whose last name is one of these.
std::vector<const Key*> keys_named(const Words& names, std::string_view section, bool directly) {
    std::vector<const Key*> found;
    const std::string prefix = join(section, "");
    for (const Key& key : schema()) {
        if (!key.path.starts_with(prefix) || key.path.starts_with(prefix + "model.")) continue;
        const bool is_direct = key.path.find('.', prefix.size()) == std::string::npos;
        if (is_direct == directly && is_in(names, last_name(key.path))) found.push_back(&key);
    }
    return found;
}

Words names_of(const std::vector<const Key*>& keys, std::string_view section) {
    Words names;
    for (const Key* key : keys) names.push_back(key->path.substr(section.size() + 1));
    return names;
}

// "`mass` belongs to type admittance" of a key that the choices do not let exist.
std::string owner_text(const Key& key, std::span<const double> params) {
    const Key& refused = key_refused(key, params);
    return "`" + last_name(key.path) + "` belongs to " + last_name(refused.when_key) + " " +
           listed(refused.when, " or ");
}

// "did you mean stiffness?" of the keys that the choices let exist; of others, to which choice they belong.
std::string meant(std::vector<const Key*> keys, std::string_view section, std::span<const double> params) {
    const std::vector<const Key*> all = keys;
    std::erase_if(keys, [&](const Key* key) { return !key_exists(*key, params); });
    if (!keys.empty()) return "did you mean " + listed(names_of(keys, section), " or ") + "?";
    return all.empty() ? "" : owner_text(*all.front(), params);
}

// Directly in the section, or in the sections in it.
std::string synonym_of(std::string_view name, std::string_view section, bool directly, std::span<const double> params) {
    for (const Synonyms& entry : synonyms())
        if (is_in(entry.typed, plain_word(name)) && !section.empty())
            if (const auto keys = keys_named(entry.names, section, directly); !keys.empty())
                return meant(keys, section, params);
    return "";
}

std::string synonym_elsewhere(std::string_view name, std::string_view section) {
    const std::string typed = plain_word(name);
    for (const Elsewhere& entry : elsewhere())
        if (is_in(entry.typed, typed) && is_in(entry.sections, section))
            return "did you mean " + listed(entry.paths, " or ") + "?";
    return "";
}

// The sections of the schema with a key of this name, except the copies in controller.model.
Words sections_of(std::string_view name) {
    Words sections;
    for (const Key& key : schema()) {
        for (std::size_t dot = key.path.find('.'); dot != std::string::npos; dot = key.path.find('.', dot + 1)) {
            const std::string_view below = std::string_view(key.path).substr(dot + 1);
            const std::string section = key.path.substr(0, dot);
            const bool is_here = below.substr(0, below.find('.')) == name;
            if (is_here && !section.starts_with("controller.model") && !is_in(sections, section))
                sections.push_back(section);
        }
    }
    return sections;
}

// "`wall` stands at the top level of a scenario", of a name that stands in a section by mistake.
std::string top_level_of(std::string_view name, std::string_view section) {
    const std::string outermost = visible(section.substr(0, section.find('.')));
    if (name == outermost) return "the keys of `" + outermost + "` stand directly under it";
    return "`" + visible(name) + "` stands at the top level of a scenario, beside `" + outermost + "`";
}

// "`velocity` belongs to wall.motion", of the sections within this one if there are such, else of the top level or of
// other sections; "" if nothing has this name.
std::string section_of(std::string_view name, std::string_view section) {
    const Words all = sections_of(name);
    Words inner = all;
    std::erase_if(inner, [&](const std::string& other) { return !other.starts_with(join(section, "")); });
    if (inner.empty() && !section.empty() && is_in(names_below(""), name)) return top_level_of(name, section);
    if (all.empty()) return "";
    return "`" + visible(name) + "` belongs to " + listed(section.empty() || inner.empty() ? all : inner, " or ");
}

// The paths of the keys whose last name is nearest to this one, except the copies in controller.model.
Words paths_like(const std::string& name) {
    Words names, paths;
    for (const Key& key : schema()) names.push_back(last_name(key.path));
    const std::string near = nearest(name, names);
    for (const Key& key : schema())
        if (last_name(key.path) == near && !key.path.starts_with("controller.model.")) paths.push_back(key.path);
    return paths;
}

}  // namespace

std::vector<std::string> names_there(std::string_view section, std::span<const double> params) {
    Words names = names_below(section);
    const std::string prefix = join(section, "");
    std::erase_if(names, [&](const std::string& name) {
        const std::string path = prefix + name;
        bool is_known = false, exists = false;
        for (const Key& key : schema()) {
            if (key.path != path && !key.path.starts_with(path + ".")) continue;
            is_known = true;
            exists = exists || key_exists(key, params);
        }
        return is_known && !exists;
    });
    return names;
}

// docs/faq.md says the same.
std::string not_of_this_arm(std::string_view name, std::string_view section) {
    if (!is_of_another_robot(name, section) || is_in(names_below(section), name)) return "";
    return "arm3r simulates arms with three joints, also yours from a URDF (`arm.urdf`); `arm3r verify` judges formulas of "
           "any serial chain of up to seven joints, from a URDF or a DH table";
}

std::string suggested_key(const std::string& name, std::string_view section, std::span<const double> params) {
    if (const std::string other = not_of_this_arm(name, section); !other.empty()) return other;
    const std::string deeper = synonym_of(name, section, false, params);
    const bool is_symbol = name.size() == 1;  // of a textbook, rather than a column of a table such as `v`
    for (const std::string& hint : {synonym_elsewhere(name, section), synonym_of(name, section, true, params),
                                    is_symbol ? deeper : "", section_of(name, section), deeper})
        if (!hint.empty()) return hint;
    if (const std::string here = did_you_mean(name, names_there(section, params)); !here.empty()) return here;
    if (const std::string other = nearest(name, names_below(section)); !other.empty())
        if (const Key* key = find_key(join(section, other)))
            return "did you mean " + other + "? " + owner_text(*key, params);
    const Words paths = paths_like(name);
    return paths.empty() ? "" : "did you mean " + listed(paths, " or ") + "?";
}

std::string suggested_key(const Node& map, const Node& node, std::string_view section, std::span<const double> params) {
    const Node* before = &node == &map.children.front() ? nullptr : &node - 1;
    if (before && node.type == Node::nothing && is_digits(node.key))
        return "use a point: " + before->text + "." + node.key;
    if (const std::size_t colon = node.key.find(':'); colon != std::string::npos && node.type == Node::nothing)
        return "a blank is needed after the colon: " + visible(node.key.substr(0, colon)) + ": " +
               visible(node.key.substr(colon + 1));
    return suggested_key(node.key, section, params);
}

std::string meant_instead(const Key& key, std::span<const double> params) {
    const std::string section = key.path.substr(0, key.path.rfind('.'));
    const std::string hint = synonym_of(last_name(key.path), section, true, params);
    return hint.starts_with("did you mean") ? hint : "";
}

}  // namespace arm3r

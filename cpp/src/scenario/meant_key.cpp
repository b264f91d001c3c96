#include "scenario/meant_key.hpp"

#include <algorithm>

#include "base/text.hpp"
#include "files/paths.hpp"
#include "schema/schema.hpp"
#include "schema/suggest.hpp"

namespace arm3r {

namespace {

using Words = std::vector<std::string>;

std::string last_name(std::string_view path) { return std::string(path.substr(path.rfind('.') + 1)); }

bool is_digits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_in(const Words& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

// Names that other programs use, in small letters without underscores, and the keys with that meaning here.
struct Synonyms {
    Words typed, keys;
};

const std::vector<Synonyms>& synonyms() {
    static const std::vector<Synonyms> table = {
        {{"kp", "k", "p"}, {"controller.joint_stiffness", "controller.position_gain", "controller.stiffness"}},
        {{"kd", "kv", "d", "b", "c"},
         {"controller.joint_damping", "controller.velocity_gain", "controller.damping", "controller.force_damping"}},
        {{"ki", "i"}, {"controller.force_integral_gain"}},
        {{"kf", "kpf"}, {"controller.force_gain"}},
        {{"m", "md"}, {"controller.mass", "controller.force_mass"}},
        {{"g"}, {"controller.gravity"}},
        {{"gain", "gains"},
         {"controller.joint_stiffness", "controller.joint_damping", "controller.position_gain",
          "controller.velocity_gain", "controller.stiffness", "controller.damping", "controller.force_gain"}},
        {{"tend", "tstop", "tfinal", "tmax", "tf", "end", "endtime", "stoptime", "duration"}, {"time.stop"}},
        {{"dt", "h", "step", "timestep", "stepsize"}, {"solver.step", "time.log_every"}},
    };
    return table;
}

std::string simplified(std::string_view name) {
    std::string out;
    for (const char c : name)
        if (c != '_') out += c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    return out;
}

// Keys of this section by their names; for names of time also whole paths.
Words synonyms_of(std::string_view name, std::string_view section, std::span<const double> params) {
    const Words there = names_there(section, params);
    const bool is_about_time = section.empty() || section == "time" || section == "solver";
    Words found;
    for (const Synonyms& synonym : synonyms()) {
        if (!is_in(synonym.typed, simplified(name))) continue;
        for (const std::string& path : synonym.keys) {
            const bool is_controller = path.starts_with("controller.");
            if (is_controller && section == "controller" && is_in(there, last_name(path)))
                found.push_back(last_name(path));
            if (!is_controller && is_about_time) found.push_back(path);
        }
    }
    return found;
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

std::string suggested_key(const Node& map, const Node& node, std::string_view section, std::span<const double> params) {
    const Node* before = &node == &map.children.front() ? nullptr : &node - 1;
    if (before && node.type == Node::nothing && is_digits(node.key))
        return "use a point: " + before->text + "." + node.key;
    if (const std::size_t colon = node.key.find(':'); colon != std::string::npos && node.type == Node::nothing)
        return "a blank is needed after the colon: " + visible(node.key.substr(0, colon)) + ": " +
               visible(node.key.substr(colon + 1));
    if (const Words meant = synonyms_of(node.key, section, params); !meant.empty())
        return "did you mean " + listed(meant, " or ") + "?";
    if (const Words elsewhere = sections_of(node.key); !elsewhere.empty())
        return "`" + visible(node.key) + "` belongs to " + listed(elsewhere, " or ");
    if (const std::string here = did_you_mean(node.key, names_below(section)); !here.empty()) return here;
    const Words paths = paths_like(node.key);
    return paths.empty() ? "" : "did you mean " + listed(paths, " or ") + "?";
}

}  // namespace arm3r

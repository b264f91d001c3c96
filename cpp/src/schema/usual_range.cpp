#include "schema/usual_range.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace arm3r {
namespace {

using Size = std::pair<std::string_view, double>;

// By the last name of a key, in its unit.
constexpr Size around_zero[] = {{"armature", 0.1},
                                {"bias", 5},
                                {"contact_off", 5},
                                {"contact_on", 5},
                                {"cutoff", 200},
                                {"damping", 2},
                                {"delay", 30},
                                {"face_offset", 0.3},
                                {"force", 20},
                                {"force_gain", 2},
                                {"force_integral_gain", 20},
                                {"friction", 2},
                                {"gravity", 10},
                                {"joint_damping", 20},
                                {"mass", 3},
                                {"noise", 2},
                                {"offset", 0.3},
                                {"phase", 3.141592653589793},
                                {"point", 2},
                                {"position_gain", 500},
                                {"qd", 3},
                                {"resolution", 0.5},
                                {"rise", 2},
                                {"seed", 50},
                                {"shoulder_offset", 0.3},
                                {"start", 5},
                                {"stiffness", 1000},
                                {"tip", 0.3},
                                {"tool_mass", 2},
                                {"velocity", 0.3},
                                {"velocity_gain", 50}};
constexpr Size factor[] = {{"duration", 10}, {"forgetting", 1.05}, {"length", 3}, {"period", 10},
                           {"radius", 5},    {"rate", 20},         {"stop", 3}};
constexpr std::string_view signed_numbers[] = {
    "amplitude",       "base_height", "bias",          "distance", "face_offset", "force",   "gravity",     "initial",
    "offset",          "phase",       "plane_point",   "point",    "position",    "q",       "q_amplitude", "qd",
    "shoulder_offset", "tip",         "tip_amplitude", "torque",   "value",       "velocity"};
constexpr std::string_view turns[] = {"q", "rotation"};

template <class Sizes>
double size_of(std::string_view name, const Sizes& sizes, double otherwise) {
    const auto* found = std::ranges::find(sizes, name, &Size::first);
    return found == std::end(sizes) ? otherwise : found->second;
}

template <class Names>
bool is_one_of(std::string_view name, const Names& names) {
    return std::ranges::find(names, name) != std::end(names);
}

}  // namespace

UsualRange usual_range(const Key& key) {
    const UsualRange other;
    const std::string_view name = std::string_view(key.path).substr(key.path.rfind('.') + 1);
    return {size_of(name, around_zero, other.around_zero), size_of(name, factor, other.factor),
            is_one_of(name, signed_numbers) && key.bounds.low < 0, is_one_of(name, turns)};
}

}  // namespace arm3r

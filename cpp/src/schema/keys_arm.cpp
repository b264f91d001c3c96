// The keys of the arm, and of a controller's copy of it.

#include "schema/keys.hpp"

#include "schema/key_builders.hpp"

namespace arm3r {
namespace {

constexpr Bounds a_mass{1e-9, 1e9}, a_density{1e-3, 1e6};

// The keys of a shape, for any link. The key of the shape itself comes before them.
void append_shape(std::vector<Key>& keys, const std::string& link) {
    const std::string shape = link + ".shape";
    keys.push_back(where(shape, {"brick"},
                         number(link + ".section", {0.01, 0.01}, Source::inferred, a_length, "m",
                                "Brick: height along y, width along z of the link's axes.")));
    keys.push_back(
        where(shape, {"cylinder"},
              needed(number(link + ".radius", {unset}, Source::ours, a_length, "m", "Radius of the cylinder."))));
    keys.push_back(where(shape, {"brick", "cylinder"},
                         number(link + ".density", {7850}, Source::inferred, a_density, "kg/m^3",
                                "Density; not used when the mass is given.")));
}

void append_link1(std::vector<Key>& keys, const std::string& link) {
    keys.push_back(choice(
        link + ".shape", {"explicit", "brick", "cylinder", "slender"}, Source::ours,
        "Shape of the column on joint 1, its length along z; explicit: mass, com and inertia_axial as they stand."));
    keys.push_back(
        where(link + ".shape", {"brick", "cylinder", "slender"},
              number(link + ".length", {1}, Source::inferred, a_length, "m", "Length along the joint-1 axis.")));
    append_shape(keys, link);
    keys.push_back(derived("from the shape", number(link + ".mass", {0.785}, Source::lecture, a_mass, "kg", "Mass.")));
    keys.push_back(derived("length/2", number(link + ".com", {0}, Source::inferred, any_position, "m",
                                              "Height of the centre of mass on the joint-1 axis.")));
    keys.push_back(derived("from the shape", number(link + ".inertia_axial", {1.3083333333333334e-5}, Source::inferred,
                                                    not_negative, "kg m^2", "Inertia about the joint-1 axis.")));
}

void append_link(std::vector<Key>& keys, const std::string& link) {
    keys.push_back(choice(link + ".shape", {"brick", "cylinder", "slender"}, Source::inferred,
                          "Gives mass, centre of mass and inertia; each of these given beside it replaces that one."));
    keys.push_back(
        number(link + ".length", {1}, Source::lecture, a_length, "m", "Length, from joint to joint (or tip)."));
    append_shape(keys, link);
    keys.push_back(derived("from the shape", number(link + ".mass", {unset}, Source::lecture, a_mass, "kg",
                                                    "Mass; the inertia of the shape scales with it.")));
    keys.push_back(derived("length/2", number(link + ".com", {unset}, Source::lecture, any_position, "m",
                                              "Centre of mass, along the link from its joint.")));
    keys.push_back(derived(
        "from the shape",
        number(
            link + ".inertia", {unset, unset, unset}, Source::inferred, not_negative, "kg m^2",
            "Principal inertias [Ix, Iy, Iz] about the centre of mass; x along the link, y in the arm's vertical plane, z along the joint.")));
}

}  // namespace

void append_arm(std::vector<Key>& keys, const std::string& arm) {
    keys.push_back(number(arm + ".base_height", {0}, Source::inferred, any_position, "m",
                          "Height of joint 2 above the base frame."));
    append_link1(keys, arm + ".link1");
    append_link(keys, arm + ".link2");
    append_link(keys, arm + ".link3");
    keys.push_back(number(arm + ".armature", {0, 0, 0}, Source::lecture, not_negative, "kg m^2",
                          "Rotor inertia seen at each joint."));
    keys.push_back(number(arm + ".damping", {0, 0, 0}, Source::lecture, not_negative, "N m s/rad",
                          "Viscous friction of each joint."));
    keys.push_back(number(arm + ".friction", {0, 0, 0}, Source::lecture, not_negative, "N m",
                          "Dry friction of each joint: friction*tanh(qd/friction_velocity)."));
    keys.push_back(number(arm + ".friction_velocity", {1e-3}, Source::ours, {1e-12, 1e6}, "rad/s",
                          "Rate at which dry friction sets in."));
    keys.push_back(or_infinite(number(arm + ".torque_limit", {infinite, infinite, infinite}, Source::lecture,
                                      not_negative, "N m", "Largest torque of each actuator, either way.")));
    keys.push_back(number(arm + ".payload.mass", {0}, Source::lecture, {0, 1e9}, "kg", "Point mass at the tip."));
}

void append_plant(std::vector<Key>& keys) {
    keys.push_back(choice(
        "arm.convention", {"simscape", "slide"}, Source::lecture,
        "Sign of joints 2 and 3. simscape: positive angles lower the arm (axes +y); slide: they raise it (axes -y)."));
    keys.push_back(number("arm.gravity", {0, 0, -9.80665}, Source::lecture, {-1e4, 1e4}, "m/s^2",
                          "What the plant feels, in the base frame."));
    append_arm(keys, "arm");
}

}  // namespace arm3r

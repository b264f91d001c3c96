// The keys of the arm, and of a controller's copy of it.

#include "schema/keys.hpp"

#include "schema/key_builders.hpp"

namespace arm3r {
namespace {

constexpr Bounds a_mass{1e-9, 1e9}, a_density{1e-3, 1e6}, either_way{-1e12, 1e12}, a_ratio{-1e6, 1e6};
constexpr const char* tensor = "kg m^2";

Key planar(Key key) { return where("arm.model", {"planar"}, std::move(key)); }
Key of_elbow(Key key) { return where("arm.model", {"elbow"}, std::move(key)); }

// A coordinate of the planar arm, a point of the elbow arm.
Key centre(const std::string& link, double fallback, std::string unset_means, Source source, const std::string& along) {
    return derived(
        std::move(unset_means),
        with_form(Form::number_or_vector, number(link + ".com", {fallback, unset, unset}, source, any_position, "m",
                                                 "Centre of mass: of a planar arm one number, " + along +
                                                     "; of an elbow arm [x, y, z] in the link's frame.")));
}

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
    keys.push_back(planar(choice(
        link + ".shape", {"explicit", "brick", "cylinder", "slender"}, Source::ours,
        "Shape of the column on joint 1, its length along z; explicit: mass, com and inertia_axial as they stand.")));
    keys.push_back(
        where(link + ".shape", {"brick", "cylinder", "slender"},
              number(link + ".length", {1}, Source::inferred, a_length, "m", "Length along the joint-1 axis.")));
    append_shape(keys, link);
    keys.push_back(
        derived("from the shape", number(link + ".mass", {0.785}, Source::lecture, {0, 1e9}, "kg", "Mass.")));
    keys.push_back(centre(link, 0, "length/2", Source::inferred, "its height on the joint-1 axis"));
    keys.push_back(
        planar(derived("from the shape", number(link + ".inertia_axial", {1.3083333333333334e-5}, Source::inferred,
                                                not_negative, "kg m^2", "Inertia about the joint-1 axis."))));
    keys.push_back(of_elbow(number(link + ".inertia", {0, 0, 0, 0, 0, 0}, Source::ours, either_way, tensor,
                                   "Inertia tensor about the centre of mass, [xx, yy, zz, xy, xz, yz], in the base's "
                                   "axes turned by q1.")));
}

void append_link(std::vector<Key>& keys, const std::string& link, bool has_tip) {
    keys.push_back(planar(choice(link + ".shape", {"brick", "cylinder", "slender"}, Source::inferred,
                                 "Gives mass, centre of mass and inertia; each of these given beside it replaces that "
                                 "one.")));
    Key length = number(link + ".length", {1}, Source::lecture, a_length, "m", "Length, from joint to joint (or tip).");
    keys.push_back(has_tip ? planar(std::move(length)) : std::move(length));
    if (has_tip)
        keys.push_back(of_elbow(needed(number(link + ".tip", {unset, unset, unset}, Source::ours, any_position, "m",
                                              "The tip in the frame of link 3."))));
    else
        keys.push_back(of_elbow(number(link + ".offset", {0}, Source::ours, any_position, "m",
                                       "Distance from link 2's frame to link 3's along the axis of joint 2.")));
    append_shape(keys, link);
    keys.push_back(derived("from the shape", number(link + ".mass", {unset}, Source::lecture, a_mass, "kg",
                                                    "Mass; the inertia of the shape scales with it.")));
    keys.push_back(centre(link, unset, "length/2", Source::lecture, "along the link from its joint"));
    keys.push_back(derived(
        "from the shape",
        list_of(3, 6,
                number(link + ".inertia", {unset}, Source::inferred, either_way, tensor,
                       "About the centre of mass. Planar arm: principal inertias [Ix, Iy, Iz]; x along the link, y in "
                       "the arm's vertical plane, z along the joint. Elbow arm: the tensor [xx, yy, zz, xy, xz, yz] in "
                       "the link's frame."))));
}

void append_rotor(std::vector<Key>& keys, const std::string& rotor, const std::string& carrier) {
    keys.push_back(of_elbow(number(rotor + ".inertia", {0}, Source::ours, not_negative, "kg m^2",
                                   "Inertia of the joint's rotor about its axis, without which the carrying link's "
                                   "tensor is given; ratio^2 times it adds to armature.")));
    keys.push_back(of_elbow(number(rotor + ".ratio", {1}, Source::ours, a_ratio, "",
                                   "Turns of the rotor, about its axis, per turn of the joint.")));
    keys.push_back(of_elbow(number(rotor + ".mass", {0}, Source::ours, {0, 1e9}, "kg",
                                   "Mass of the rotor, which " + carrier + " carries at the joint.")));
    keys.push_back(of_elbow(
        derived("along the joint's axis",
                number(rotor + ".axis", {unset, unset, unset}, Source::ours, {-1e6, 1e6}, "",
                       "Direction of the rotor's axis in the frame of " + carrier + "; its length does not matter."))));
}

}  // namespace

void append_arm(std::vector<Key>& keys, const std::string& arm) {
    keys.push_back(planar(number(arm + ".base_height", {0}, Source::inferred, any_position, "m",
                                 "Height of joint 2 above the base frame.")));
    keys.push_back(of_elbow(number(arm + ".base.position", {0, 0, 0}, Source::ours, any_position, "m",
                                   "The point of axis 1 at the height of joint 2.")));
    keys.push_back(
        of_elbow(of_kind(Kind::angle, number(arm + ".base.rotation", {0, 0, 0}, Source::ours, {-1e3, 1e3}, "rad",
                                             "Roll, pitch and yaw of the base: about the fixed axes "
                                             "x, y, z, one after the other."))));
    keys.push_back(of_elbow(number(arm + ".shoulder_offset", {0}, Source::ours, any_position, "m",
                                   "Distance of joint 2 from axis 1, along x of link 1.")));
    append_link1(keys, arm + ".link1");
    append_link(keys, arm + ".link2", false);
    append_link(keys, arm + ".link3", true);
    append_rotor(keys, arm + ".rotor1", "the base");
    append_rotor(keys, arm + ".rotor2", "link 1");
    append_rotor(keys, arm + ".rotor3", "link 2");
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
    keys.push_back(choice("arm.model", {"planar", "elbow"}, Source::lecture,
                          "planar: the links begin on axis 1 and lie in one plane with it. elbow: axes 2 and 3 are "
                          "parallel and across axis 1; offsets, tensors, rotors and base as they are."));
    const auto of_file = [&](const char* name, std::string unset_means, std::string doc) {
        keys.push_back(derived(std::move(unset_means),
                               of_kind(Kind::arm_file, number(std::string("arm.") + name, {unset}, Source::ours,
                                                              no_bounds, "", std::move(doc)))));
    };
    of_file("urdf", "the keys given here",
            "A URDF that has the arm, an elbow arm; each key given beside it replaces that of the file.");
    of_file("joints", "the first three that are not locked", "Names of the three joints that move, from base to tip.");
    of_file("lock", "none", "Joints on the way to the tip that are held, each with its angle.");
    of_file("tip", "the only link without a child", "The link whose frame is the tip.");
    of_file("axis_tolerance", "1.0e-6", "Angle in rad by which the axes may be off those of an elbow arm.");
    keys.push_back(
        choice("arm.convention", {"simscape", "slide", "urdf"}, Source::lecture,
               "Sign of joints 2 and 3. simscape: positive angles lower the arm (axes +y); slide: they raise "
               "it (axes -y); urdf: signs and zeros are joint_sign and joint_zero."));
    keys.push_back(where("arm.convention", {"urdf"},
                         number("arm.joint_sign", {1, 1, 1}, Source::ours, {-1, 1}, "",
                                "1 where the joint turns as in slide, -1 where it turns the other way.")));
    keys.push_back(where("arm.convention", {"urdf"},
                         of_kind(Kind::angle, number("arm.joint_zero", {0, 0, 0}, Source::ours, {-1e3, 1e3}, "rad",
                                                     "Angles of the joints, as slide counts them, where q is zero."))));
    keys.push_back(number("arm.gravity", {0, 0, -9.80665}, Source::lecture, {-1e4, 1e4}, "m/s^2",
                          "What the plant feels, in the base frame."));
    append_arm(keys, "arm");
}

}  // namespace arm3r

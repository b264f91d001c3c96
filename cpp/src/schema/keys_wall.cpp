// The keys of the wall: its place and motion, and the contact with it.

#include "schema/keys.hpp"

#include "schema/choice_words.hpp"
#include "schema/key_builders.hpp"
#include "schema/stiffness_presets.hpp"

namespace arm3r {
namespace {

// The motions of the wall that follow a curve given in points.
void append_paths(std::vector<Key>& keys) {
    const std::string type = "wall.motion.type";
    keys.push_back(where(
        type, {"ramp"},
        needed(number("wall.motion.distance", {unset}, Source::ours, {-1e3, 1e3}, "m", "How far the ramp goes."))));
    keys.push_back(where(type, {"ramp"},
                         number("wall.motion.start", {0}, Source::ours, an_instant, "s", "When the ramp begins.")));
    keys.push_back(
        where(type, {"ramp"},
              needed(number(
                  "wall.motion.duration", {unset}, Source::ours, {1e-6, 1e9}, "s",
                  "How long the ramp takes: a quintic without a jump of acceleration; the wall stays at its end."))));
    const auto column = [&](const char* path, const char* missing, Bounds bounds, const char* unit, const char* doc) {
        keys.push_back(
            where(type, {"table"}, table_column(missing, number(path, {}, Source::ours, bounds, unit, doc))));
    };
    keys.push_back(
        where(type, {"table"},
              table_file("wall.motion.file",
                         "A CSV file with columns t and s (s, m), and v and a where it has them, in place of "
                         "these lists; a relative name counts from the folder of the scenario.")));
    column("wall.motion.t", of_the_file, an_instant, "s",
           "Instants of the table, increasing; before and after them the wall stands still.");
    column("wall.motion.s", of_the_file, {-1e3, 1e3}, "m",
           "Position of the wall along its direction at the instants wall.motion.t; quintics in between.");
    column("wall.motion.v", "smoothest", {-1e4, 1e4}, "m/s",
           "Velocity of the wall at the instants wall.motion.t; without v and a the wall moves through s with minimum "
           "jerk, from rest to rest.");
    column("wall.motion.a", "smoothest", {-1e6, 1e6}, "m/s^2",
           "Acceleration of the wall at the instants wall.motion.t.");
    keys.push_back(where(
        type, {"sinusoid", "ramp", "table"},
        derived("the normal", number("wall.motion.direction", {unset, unset, unset}, Source::ours, any_position, "",
                                     "Which way the wall moves, in base axes; normalised on "
                                     "reading. Along the plate it slides under the tip."))));
}

void append_rotation(std::vector<Key>& keys) {
    const std::string type = "wall.rotation.type";
    keys.push_back(choice(type, words_of<Rotation>(), Source::ours,
                          "How the plate turns about the origin of its frame; at t = 0 it stands as `normal` says."));
    keys.push_back(where(type, {"constant", "sinusoid"},
                         needed(number("wall.rotation.axis", {unset, unset, unset}, Source::ours, any_position, "",
                                       "Axis about which the wall turns, in base axes; normalised on reading."))));
    keys.push_back(
        where(type, {"constant"},
              needed(of_kind(Kind::angle, number("wall.rotation.rate", {unset}, Source::ours, {-1e4, 1e4}, "rad/s",
                                                 "Angular rate of the wall; 10 deg means 10 deg/s.")))));
    keys.push_back(
        where(type, {"sinusoid"},
              needed(of_kind(Kind::angle, number("wall.rotation.amplitude", {unset}, Source::ours, {-100, 100}, "rad",
                                                 "Amplitude A of the angle A sin(2 pi f t + phase) - A "
                                                 "sin(phase).")))));
    keys.push_back(
        where(type, {"sinusoid"},
              needed(number("wall.rotation.frequency", {unset}, Source::ours, {0, 1e4, true}, "Hz", "Frequency f."))));
    keys.push_back(where(
        type, {"sinusoid"},
        of_kind(Kind::angle, number("wall.rotation.phase", {0}, Source::ours, {-1e4, 1e4}, "rad", "Phase at t = 0."))));
}

void append_contact(std::vector<Key>& keys) {
    const std::string law = "wall.contact.law";
    keys.push_back(
        choice(law, words_of<ContactLaw>(), Source::lecture,
               "The normal force at depth d: spring: k d; diagonal: a spring, and two more that tie the tip "
               "sideways to the plate's centre; kelvin_voigt: k d + c d'; hunt_crossley: k d^p (1 + beta d')."));
    std::vector<std::string> words = {"none"};
    for (const StiffnessPreset& preset : stiffness_presets) words.emplace_back(preset.name);
    keys.push_back(where(law, {"spring", "kelvin_voigt"},
                         choice("wall.contact.preset", words, Source::ours,
                                "A part of the body whose stiffness is the default of `stiffness`.")));
    keys.push_back(
        where(law, {"spring", "diagonal", "kelvin_voigt", "hunt_crossley"},
              needed(with_form(Form::by_choice,
                               number("wall.contact.stiffness", {1000, unset, unset}, Source::ours, {0, 1e15}, "N/m",
                                      "K_E: one number k, in N/m^p for hunt_crossley, or [kn, k1, k2] for diagonal."),
                               "diagonal"))));
    keys.push_back(where(law, {"kelvin_voigt"},
                         derived("from restitution", number("wall.contact.damping", {unset}, Source::ours, not_negative,
                                                            "N s/m", "c: force per rate of depth."))));
    keys.push_back(where(law, {"hunt_crossley"},
                         number("wall.contact.exponent", {1.5}, Source::ours, {1, 3}, "",
                                "p: 1.5 is a sphere on a half-space (Hertz).")));
    keys.push_back(where(law, {"hunt_crossley"},
                         derived("from restitution", number("wall.contact.dissipation", {unset}, Source::ours, {0, 1e6},
                                                            "s/m", "beta: damping per stiffness."))));
    keys.push_back(where(
        law, {"kelvin_voigt", "hunt_crossley"},
        derived("not asked for", number("wall.contact.restitution", {unset}, Source::ours, {0, 1, true}, "",
                                        "Instead of damping or dissipation: speed after over speed before an impact "
                                        "of the mass that the arm shows along the normal at the start."))));
    keys.push_back(
        where(law, {"hunt_crossley"},
              derived("not asked for", number("wall.contact.impact_speed", {unset}, Source::ours, {0, 1e4, true}, "m/s",
                                              "The speed at which `restitution` holds."))));
    keys.push_back(number("wall.contact.friction.coefficient", {0}, Source::lecture, {0, 1e3}, "",
                          "mu: friction along the plate is -mu f_n v_t/sqrt(v_t^2 + slip_velocity^2)."));
    keys.push_back(number("wall.contact.friction.slip_velocity", {1e-3}, Source::ours, {1e-9, 1e4}, "m/s",
                          "Sliding speed at which the friction of the wall sets in."));
}

}  // namespace

void append_wall(std::vector<Key>& keys) {
    keys.push_back(of_kind(Kind::section, number("wall", {0}, Source::lecture, no_bounds, "",
                                                 "The moving plate. Absent: no wall; `wall: {}` is the lecture's.")));
    keys.push_back(number("wall.point", {2, 0, 0}, Source::lecture, any_position, "m",
                          "Origin of the plate's frame, its centre, at t = 0."));
    keys.push_back(number("wall.normal", {-1, 0, 0}, Source::lecture, any_position, "",
                          "From the wall towards the arm; normalised on reading."));
    keys.push_back(
        with_form(Form::vector_or_word,
                  number("wall.size", {1, 1}, Source::lecture, a_length, "m", "Extent along e1 and e2, or infinite."),
                  "infinite"));
    keys.push_back(number("wall.face_offset", {0}, Source::lecture, any_position, "m",
                          "How far the contact face lies in front of the frame."));
    keys.push_back(choice("wall.motion.type", words_of<Motion>(), Source::lecture,
                          "How the wall moves: its point is wall.point + s(t) direction, but for constant."));
    keys.push_back(where(
        "wall.motion.type", {"constant"},
        with_form(
            Form::number_or_vector,
            number(
                "wall.motion.velocity", {0.05, unset, unset}, Source::lecture, {-1e4, 1e4}, "m/s",
                "Velocity of the wall: a number along its normal, positive towards the arm, or a vector in base axes."))));
    keys.push_back(where("wall.motion.type", {"sinusoid"},
                         needed(number("wall.motion.amplitude", {unset}, Source::ours, {-1e3, 1e3}, "m",
                                       "Amplitude A of s = A sin(2 pi f t + phase) - A sin(phase)."))));
    keys.push_back(
        where("wall.motion.type", {"sinusoid"},
              needed(number("wall.motion.frequency", {unset}, Source::ours, {0, 1e4, true}, "Hz", "Frequency f."))));
    keys.push_back(where(
        "wall.motion.type", {"sinusoid"},
        of_kind(Kind::angle, number("wall.motion.phase", {0}, Source::ours, {-1e4, 1e4}, "rad", "Phase at t = 0."))));
    append_paths(keys);
    append_rotation(keys);
    append_contact(keys);
    keys.push_back(of_kind(
        Kind::flag, number("wall.acts_on_arm", {0}, Source::lecture, no_bounds, "",
                           "false: the force is only measured, as in the lecture; true: the arm feels f_on_tip.")));
}

}  // namespace arm3r

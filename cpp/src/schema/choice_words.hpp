#pragma once
// The words of the choices, and what each of them means in the program: the schema takes the words from here, and
// make_setup() the values. The order is that of the documentation; the first is the default.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "arm3r/plant.hpp"
#include "schema/solver_method.hpp"

namespace arm3r {

template <class Enum>
struct ChoiceWord {
    Enum value;
    std::string_view word;
};

template <class Enum>
inline constexpr int choice_words = 0;  // specialised for each choice

template <>
inline constexpr std::array choice_words<Motion> = std::to_array<ChoiceWord<Motion>>({{Motion::constant, "constant"},
                                                                                      {Motion::fixed, "fixed"},
                                                                                      {Motion::sinusoid, "sinusoid"},
                                                                                      {Motion::ramp, "ramp"},
                                                                                      {Motion::table, "table"}});
template <>
inline constexpr std::array choice_words<Rotation> = std::to_array<ChoiceWord<Rotation>>(
    {{Rotation::none, "none"}, {Rotation::constant, "constant"}, {Rotation::sinusoid, "sinusoid"}});
template <>
inline constexpr std::array choice_words<ContactLaw> = [] {
    std::array<ChoiceWord<ContactLaw>, contact_law_table.size()> words;
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = {contact_law_table[i].law, contact_law_table[i].word};
    return words;
}();
template <>
inline constexpr std::array choice_words<ControllerType> = [] {
    std::array<ChoiceWord<ControllerType>, law_table.size()> words;
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = {law_table[i].type, law_table[i].word};
    return words;
}();
template <>
inline constexpr std::array choice_words<Algorithm> = std::to_array<ChoiceWord<Algorithm>>(
    {{Algorithm::closed_form, "closed_form"}, {Algorithm::recursion, "recursion"}});
template <>
inline constexpr std::array choice_words<Variant> =
    std::to_array<ChoiceWord<Variant>>({{Variant::dynamic, "dynamic"},
                                        {Variant::jacobian_transpose, "jacobian_transpose"},
                                        {Variant::projected, "projected"},
                                        {Variant::raibert_craig, "raibert_craig"}});
template <>
inline constexpr std::array choice_words<ForceTerm> = std::to_array<ChoiceWord<ForceTerm>>(
    {{ForceTerm::cancelled, "cancelled"}, {ForceTerm::feedforward, "feedforward"}});
template <>
inline constexpr std::array choice_words<AntiWindup> =
    std::to_array<ChoiceWord<AntiWindup>>({{AntiWindup::none, "none"},
                                           {AntiWindup::conditional, "conditional"},
                                           {AntiWindup::back_calculation, "back_calculation"}});
template <>
inline constexpr std::array choice_words<Switching> = std::to_array<ChoiceWord<Switching>>(
    {{Switching::in_contact, "in_contact"}, {Switching::latched, "latched"}, {Switching::always, "always"}});
template <>
inline constexpr std::array choice_words<Inner> = std::to_array<ChoiceWord<Inner>>(
    {{Inner::exact, "exact"}, {Inner::position, "position"}, {Inner::joint_pd, "joint_pd"}});
template <>
inline constexpr std::array choice_words<Adaptation> =
    std::to_array<ChoiceWord<Adaptation>>({{Adaptation::integral, "integral"}, {Adaptation::indirect, "indirect"}});
template <>
inline constexpr std::array choice_words<Saturation> =
    std::to_array<ChoiceWord<Saturation>>({{Saturation::clamp, "clamp"}, {Saturation::scale, "scale"}});
template <>
inline constexpr std::array choice_words<Path> = std::to_array<ChoiceWord<Path>>({{Path::hold, "hold"},
                                                                                  {Path::point, "point"},
                                                                                  {Path::line, "line"},
                                                                                  {Path::minimum_jerk, "minimum_jerk"},
                                                                                  {Path::circle, "circle"},
                                                                                  {Path::sinusoid, "sinusoid"},
                                                                                  {Path::table, "table"}});
template <>
inline constexpr std::array choice_words<ForceProfile> =
    std::to_array<ChoiceWord<ForceProfile>>({{ForceProfile::constant, "constant"},
                                             {ForceProfile::step, "step"},
                                             {ForceProfile::ramp, "ramp"},
                                             {ForceProfile::sinusoid, "sinusoid"}});
template <>
inline constexpr std::array choice_words<VelocityEstimate> =
    std::to_array<ChoiceWord<VelocityEstimate>>({{VelocityEstimate::exact, "exact"},
                                                 {VelocityEstimate::difference, "difference"},
                                                 {VelocityEstimate::filtered, "filtered"}});
template <>
inline constexpr std::array choice_words<Reaction> =
    std::to_array<ChoiceWord<Reaction>>({{Reaction::ignore, "ignore"},
                                         {Reaction::stop, "stop"},
                                         {Reaction::floating, "float"},
                                         {Reaction::reflex, "reflex"},
                                         {Reaction::retreat, "retreat"}});
template <>
inline constexpr std::array choice_words<StepEvents> =
    std::to_array<ChoiceWord<StepEvents>>({{StepEvents::grid, "grid"}, {StepEvents::located, "located"}});
template <>
inline constexpr std::array choice_words<SolverMethod> =
    std::to_array<ChoiceWord<SolverMethod>>({{SolverMethod::dopri5, "dopri5"},
                                             {SolverMethod::rk4, "rk4"},
                                             {SolverMethod::taylor, "taylor"},
                                             {SolverMethod::rodas4, "rodas4"},
                                             {SolverMethod::automatic, "auto"}});

template <class Enum>
std::vector<std::string> words_of() {
    std::vector<std::string> words;
    for (const ChoiceWord<Enum>& choice : choice_words<Enum>) words.emplace_back(choice.word);
    return words;
}

template <class Enum>
constexpr std::string_view word_of(Enum value) {
    for (const ChoiceWord<Enum>& choice : choice_words<Enum>)
        if (choice.value == value) return choice.word;
    return "";
}

}  // namespace arm3r

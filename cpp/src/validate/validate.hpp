#pragma once
// The rules that parameters must keep, with messages; and for many arrays that differ in a few numbers without.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/problem_list.hpp"
#include "schema/schema.hpp"
#include "setup/setup.hpp"

namespace arm3r {

struct Validation {
    std::vector<Problem> problems;
    std::optional<Setup> setup;  // where there are no problems
};

// Every rule that one key alone can break (range, shape, word), and those between keys.
Validation validate(std::span<const double> params);

// The range of one of the `count` numbers of a key, and that it is whole where it must be.
void check_number(const Key& key, double value, std::size_t item, std::size_t count, ProblemList& problem_list);

// The setup of parameters that keep every rule; else throws Error ARM3R_E_SCENARIO with every problem.
Setup valid_setup(std::span<const double> params);

// Keys whose numbers are to be looked at: those of the plant's arm, all others, and those of the controller's copy of the
// arm, which are the first again as with_model() (setup.hpp) puts them.
struct NumberKeys {
    std::vector<const Key*> arm, others, model;
};

// Throws Error ARM3R_E_SCENARIO if a number that represents a choice is none of its words.
void refuse_unknown_choices(std::span<const double> params);

class Checker {
public:
    // The arrays will differ from `params` in the numbers `varied` only, none of them a choice, a flag or a section.
    Checker(std::span<const double> params, std::span<const std::size_t> varied);

    // The setup of parameters; empty where they break a rule. The second form makes it in place, of what this Checker left
    // there before: what cannot differ stays.
    std::optional<Setup> operator()(std::span<const double> params) const;
    void operator()(std::span<const double> params, std::optional<Setup>& setup) const;

private:
    bool readable_;    // the choices are words
    NumberKeys keys_;  // what varies, and what is wrong in all
    bool only_start_and_contact_vary_ = false;
};

}  // namespace arm3r

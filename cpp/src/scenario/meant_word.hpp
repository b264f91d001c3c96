#pragma once
// Suggests which word of a choice an unknown word stands for: names of solvers, controllers and contact laws that other
// programs and textbooks use.

#include <string>
#include <string_view>

#include "schema/schema.hpp"

namespace arm3r {

// The word of a choice that is meant: the word itself, in other letters, or by another name; "" where none is known.
std::string word_meant(const Key& key, std::string_view typed);

// A sentence for a word that is none of the choice's; "" where none is near.
std::string suggested_word(const Key& key, std::string_view typed);

}  // namespace arm3r

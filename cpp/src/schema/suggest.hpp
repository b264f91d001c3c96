#pragma once
// Did you mean ...?

#include <string>
#include <string_view>
#include <vector>

namespace arm3r {

// Levenshtein distance with transpositions; the nearest of `words` within 2 (1 for three letters or fewer; a third of the length for long words), or "".
std::string nearest(std::string_view word, const std::vector<std::string>& words);

// Its letters and digits, in small letters: "Kelvin-Voigt" and "kelvin_voigt" are "kelvinvoigt".
std::string plain_word(std::string_view word);

}  // namespace arm3r

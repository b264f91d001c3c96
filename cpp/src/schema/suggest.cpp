#include <algorithm>
#include <numeric>

#include "schema/suggest.hpp"

namespace arm3r {

namespace {

constexpr std::size_t longest = 64;  // no key is longer, so nothing longer is near one

// Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), 0);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

std::size_t common_head(std::string_view a, std::string_view b) {
    return static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& words) {
    if (word.empty() || word.size() > longest) return {};
    std::size_t best = std::max<std::size_t>(word.size() > 3 ? 2 : 1, word.size() / 3) + 1;
    std::string found;
    for (const std::string& candidate : words) {
        const std::size_t d = distance(word, candidate);
        const bool nearer =
            d < best || (d == best && !found.empty() && common_head(word, candidate) > common_head(word, found));
        if (nearer && d < word.size()) {
            best = d;
            found = candidate;
        }
    }
    return found;
}

std::string plain_word(std::string_view word) {
    std::string out;
    for (const char c : word)
        if (c >= 'A' && c <= 'Z') out += static_cast<char>(c + 32);
        else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) out += c;
    return out;
}

}  // namespace arm3r

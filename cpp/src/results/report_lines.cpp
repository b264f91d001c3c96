#include "results/report_lines.hpp"

#include <algorithm>
#include <charconv>

#include "base/text.hpp"

namespace arm3r {

std::string fixed(double value, int decimals) {
    char text[400];
    return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr};
}

std::string line(const std::string& label, const std::string& text) {
    return "  " + label + std::string(label.size() < 16 ? 16 - label.size() : 1, ' ') + text + "\n";
}

// Lines of cells, each column as wide as its widest cell.
std::string aligned(const std::vector<std::vector<std::string>>& lines) {
    std::vector<std::size_t> width;
    for (const auto& cells : lines)
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (i == width.size()) width.push_back(0);
            width[i] = std::max(width[i], count_characters(cells[i]));
        }
    std::string out;
    for (const auto& cells : lines) {
        for (std::size_t i = 0; i < cells.size(); ++i) {
            out += "  " + cells[i];
            if (i + 1 < cells.size()) out += std::string(width[i] - count_characters(cells[i]), ' ');
        }
        out += "\n";
    }
    return out;
}

}  // namespace arm3r

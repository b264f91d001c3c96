#include <array>
#include <bit>
#include <cstring>

#include "base/number_text.hpp"
#include "results/csv.hpp"
#include "schema/columns.hpp"

namespace arm3r {

namespace {

constexpr std::size_t piece = 256 << 10, longest_number = 24;  // -2.2250738585072014e-308
constexpr std::uint64_t fnv_start = 0xCBF29CE484222325, fnv_prime = 0x100000001B3;

std::string header(const Run& run) {
    std::string line;
    for (const std::size_t column : run.columns) (line += line.empty() ? "" : ",") += column_table[column].name;
    return line += '\n';
}

// One line of text and where each of its cells begins. Most cells repeat the line before: their text is copied.
class Line {
public:
    explicit Line(std::size_t columns) : text_(columns * (longest_number + 1) + number_room), begin_(columns + 1) {}

    std::string_view text() const { return {text_.data(), begin_.back()}; }

    void write(const Run& run, std::size_t row, const Line* before) {
        const std::size_t columns = begin_.size() - 1;
        char* out = text_.data();
        for (std::size_t i = 0; i < columns;) {
            const std::size_t same_end = before ? end_of_repeats(run, row, i) : i;
            if (same_end > i) {
                const std::size_t size = before->begin_[same_end] - before->begin_[i];
                std::memcpy(out, before->text_.data() + before->begin_[i], size);
                const std::size_t at = static_cast<std::size_t>(out - text_.data());
                for (std::size_t j = i; j < same_end; ++j) begin_[j] = at + before->begin_[j] - before->begin_[i];
                out += size;
                i = same_end;
            } else {
                begin_[i] = static_cast<std::size_t>(out - text_.data());
                out = write_shortest(out, value(run, i, row));
                *out++ = ++i == columns ? '\n' : ',';
            }
        }
        begin_[columns] = static_cast<std::size_t>(out - text_.data());
    }

private:
    static double value(const Run& run, std::size_t column, std::size_t row) {
        return run.data[column * run.capacity + row];
    }

    std::size_t end_of_repeats(const Run& run, std::size_t row, std::size_t i) const {
        const auto bits = [&](std::size_t r) { return std::bit_cast<std::uint64_t>(value(run, i, r)); };
        while (i + 1 < begin_.size() && bits(row) == bits(row - 1)) ++i;
        return i;
    }

    std::vector<char> text_;
    std::vector<std::size_t> begin_;
};

}  // namespace

bool write_csv(const Run& run, const std::function<bool(std::string_view)>& sink) {
    Line lines[2] = {Line(run.columns.size()), Line(run.columns.size())};
    std::string buffer = header(run);
    buffer.reserve(piece + run.columns.size() * (longest_number + 1));
    for (std::size_t row = 0; row < run.rows; ++row) {
        lines[row % 2].write(run, row, row ? &lines[(row + 1) % 2] : nullptr);
        buffer += lines[row % 2].text();
        if (buffer.size() < piece) continue;
        if (!sink(buffer)) return false;
        buffer.clear();
    }
    return sink(buffer);
}

std::uint64_t fnv1a64(const Run& run) {
    constexpr auto powers = [] {  // a zero byte only multiplies; doubles have many of them at their low end
        std::array<std::uint64_t, 9> powers{1};
        for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = powers[i - 1] * fnv_prime;
        return powers;
    }();
    std::uint64_t hash = fnv_start;
    for (std::size_t i = 0; i < run.columns.size(); ++i) {
        for (const double value : run.column(i)) {
            const auto bits = std::bit_cast<std::uint64_t>(value);
            const int zeros = std::countr_zero(bits) / 8;
            hash *= powers[static_cast<std::size_t>(zeros)];
            for (int shift = 8 * zeros; shift < 64; shift += 8) hash = (hash ^ (bits >> shift & 0xFF)) * fnv_prime;
        }
    }
    return hash;
}

}  // namespace arm3r

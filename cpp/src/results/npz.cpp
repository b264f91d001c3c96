#include "results/npz.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <string>

#include "schema/columns.hpp"

namespace arm3r {
namespace {

// Eight tables: the CRC of a byte followed by 0 to 7 zero bytes, so that eight bytes are taken at once.
constexpr auto crc_tables = [] {
    std::array<std::array<std::uint32_t, 256>, 8> tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t crc = byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320u : 0);
        tables[0][byte] = crc;
    }
    for (std::size_t zeros = 1; zeros < 8; ++zeros)
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint32_t before = tables[zeros - 1][byte];
            tables[zeros][byte] = before >> 8 ^ tables[0][before & 0xFF];
        }
    return tables;
}();

// CRC-32 of ZIP and Ethernet, of the bytes so far.
class Crc32 {
public:
    void add(std::string_view bytes) {
        for (; bytes.size() >= 8; bytes.remove_prefix(8)) {
            std::uint64_t word;
            std::memcpy(&word, bytes.data(), 8);
            word ^= crc_;
            crc_ = 0;
            for (std::size_t i = 0; i < 8; ++i) crc_ ^= crc_tables[7 - i][word >> (8 * i) & 0xFF];
        }
        for (const char byte : bytes)
            crc_ = crc_ >> 8 ^ crc_tables[0][(crc_ ^ static_cast<unsigned char>(byte)) & 0xFF];
    }
    std::uint32_t value() const { return ~crc_; }

private:
    std::uint32_t crc_ = 0xFFFFFFFF;
};

// Numbers of 2 and 4 bytes, the lowest first.
void put(std::string& out, std::initializer_list<std::uint16_t> halves) {
    for (const std::uint16_t half : halves) (out += static_cast<char>(half & 0xFF)) += static_cast<char>(half >> 8);
}
void put_word(std::string& out, std::size_t word) {
    put(out, {static_cast<std::uint16_t>(word & 0xFFFF), static_cast<std::uint16_t>(word >> 16 & 0xFFFF)});
}

constexpr std::uint16_t version = 20, stored = 0, midnight = 0, first_of_january_1980 = 0x21;

class ZipWriter {
public:
    explicit ZipWriter(const std::function<void(std::string_view)>& sink) : sink_(sink) {}

    // A member of two pieces, of which the second may be long.
    void add(std::string_view name, std::string_view head, std::string_view body) {
        Crc32 crc;
        crc.add(head);
        crc.add(body);
        std::string about;
        put(about, {version, 0, stored, midnight, first_of_january_1980});
        put_word(about, crc.value());
        put_word(about, head.size() + body.size());
        put_word(about, head.size() + body.size());
        put(about, {static_cast<std::uint16_t>(name.size()), 0});
        const std::size_t begin = written_;
        write(std::string("PK\x03\x04") + about + std::string(name));
        write(head);
        write(body);
        directory_ += "PK\x01\x02";
        put(directory_, {version});
        directory_ += about;
        put(directory_, {0, 0, 0, 0, 0});
        put_word(directory_, begin);
        directory_ += name;
        members_ += 1;
    }

    void finish() {
        const std::size_t begin = written_;
        std::string end = "PK\x05\x06";
        put(end, {0, 0, members_, members_});
        put_word(end, directory_.size());
        put_word(end, begin);
        put(end, {0});
        write(directory_);
        write(end);
    }

private:
    void write(std::string_view bytes) {
        sink_(bytes);
        written_ += bytes.size();
    }

    const std::function<void(std::string_view)>& sink_;
    std::string directory_;
    std::size_t written_ = 0;
    std::uint16_t members_ = 0;
};

// The head of a .npy file: little-endian doubles, one dimension; padded so that the numbers begin at a multiple of 64.
std::string npy_head(std::size_t rows) {
    std::string about = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(rows) + ",), }";
    constexpr std::size_t before = 10;  // what stands before `about`
    about.resize((before + about.size() + 1 + 63) / 64 * 64 - before - 1, ' ');
    about += '\n';
    std::string head("\x93NUMPY\x01\x00", 8);
    put(head, {static_cast<std::uint16_t>(about.size())});
    return head + about;
}

}  // namespace

void write_npz(const Run& run, const std::function<std::string_view()>& summary,
               const std::function<void(std::string_view)>& sink) {
    static_assert(std::endian::native == std::endian::little);
    ZipWriter zip(sink);
    const std::string head = npy_head(run.rows);
    for (std::size_t i = 0; i < run.columns.size(); ++i) {
        const std::span<const double> values = run.column(i);
        const std::string name = std::string(column_table[run.columns[i]].name) + ".npy";
        zip.add(name, head, {reinterpret_cast<const char*>(values.data()), values.size_bytes()});
    }
    zip.add("summary.json", summary(), {});
    zip.finish();
}

}  // namespace arm3r

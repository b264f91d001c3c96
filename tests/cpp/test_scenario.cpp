// The parts of the text face that live in the core: numbers, suggestions, messages. The reader as a whole is judged
// by tests/python/attacks/test_attacks_scenario.py, through the executable and the library.

#include <bit>
#include <cfloat>
#include <charconv>
#include <cmath>
#include <random>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "check.hpp"
#include "schema/schema.hpp"
#include "schema/suggest.hpp"

TEST_SUITE(scenario)

using namespace arm3r;

static std::optional<double> read(std::string_view text, NumberRules rules = {}) {
    NumberFault fault;
    return read_number(text, rules, fault);
}

static NumberFault refused(std::string_view text, NumberRules rules = {}) {
    NumberFault fault;
    CHECK(!read_number(text, rules, fault).has_value(), text);
    return fault;
}

TEST_CASE(every_legal_form_reads) {
    for (const char* half : {"0.5", ".5", "+.5", "5e-1", "50e-02", "+0.5e+0", "0.05e1"})
        CHECK(read(half).value() == 0.5, half);
    CHECK(read("1e-05").value() == 1e-5);
    CHECK(read("0").value() == 0);
    CHECK(read("0e999999999999").value() == 0);
}

TEST_CASE(random_doubles_read_back_to_the_same_bits) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 100'000; ++i) {
        const auto value = std::bit_cast<double>(random());
        if (!std::isnormal(value)) continue;
        REQUIRE(std::bit_cast<std::uint64_t>(read(shortest(value)).value()) == std::bit_cast<std::uint64_t>(value));
    }
}

// Of std::to_chars, digit by digit, whatever the way by which they were found.
static void check_shortest(double value) {
    char text[number_room];
    const std::string_view expected(text, std::to_chars(text, text + sizeof text, value).ptr - text);
    REQUIRE(shortest(value) == expected);
}

TEST_CASE(the_shortest_digits_are_those_of_the_standard_library) {
    std::mt19937_64 random(2);
    constexpr std::uint64_t sign_and_fraction = ~(std::uint64_t{0x7FF} << 52);
    for (int i = 0; i < 200'000; ++i) {  // from 2^-210 to 2^60: a little more than shortest_decimal() takes
        const std::uint64_t exponent = 1023 - 210 + random() % 270;
        check_shortest(std::bit_cast<double>((random() & sign_and_fraction) | exponent << 52));
    }
    for (int exponent = -215; exponent < 60; ++exponent) {
        const double power = std::ldexp(1.0, exponent);
        for (const double value : {power, std::nextafter(power, 0.0), std::nextafter(power, 2 * power)}) {
            check_shortest(value);
            check_shortest(-value);
        }
    }
    for (int i = 1; i < 20'000; ++i)
        for (const double unit : {1e-9, 0.001, 0.01, 0.125, 1.0, 1000.0, 1e9, 1e-30}) check_shortest(i * unit);
}

TEST_CASE(degrees_are_one_product_and_one_quotient) {
    CHECK(read("-30 deg", {.degrees = true}).value() == -30.0 * 3.14159265358979323846 / 180);
    CHECK(refused("-30 deg").hint.find("degrees") != std::string::npos);
    CHECK(refused("-30deg", {.degrees = true}).hint == "write -30 deg");
}

TEST_CASE(zero_has_no_sign) {
    for (const char* zero : {"-0", "-0.0", "-.0e5"}) CHECK(!std::signbit(read(zero).value()), zero);
    CHECK(shortest(-0.0) == "0");
}

TEST_CASE(the_ends_of_the_range) {
    CHECK(read("1.7976931348623157e308").value() == DBL_MAX);
    CHECK(read("2.2250738585072014e-308").value() == DBL_MIN);
    for (const char* large : {"1.7976931348623159e308", "-1e309", "1e99999999999999999999"})
        CHECK(refused(large).message == "out of double range", large);
    for (const char* small : {"2.2250738585072009e-308", "4.9e-324", "-1e-999", "1e-99999999999999999999"})
        CHECK(refused(small).message == "underflows: too small for a double", small);
    CHECK(refused("0." + std::string(400, '0') + "1").message == "underflows: too small for a double");
    CHECK(refused("1" + std::string(400, '0')).message == "out of double range");
    CHECK(read("1" + std::string(400, '0') + "e-400").value() == 1);
}

TEST_CASE(what_only_looks_like_a_number_is_refused) {
    for (const char* text :
         {"",     "+",   ".",   "-.",   "e5",  "1e", "1e+", "1.",  "1.e5", "1E5", "0x10", "0b1",   "1_000",   "1,5",
          "1:30", "nan", "inf", ".inf", "1 2", " 1", "1 ",  "--1", "+-1",  "1f",  "010",  "-01.5", "\u22121", "\u0661"})
        refused(text);
    CHECK(refused("010").hint == "write 10");
    CHECK(refused("-0x10").hint == "only decimal numbers: this would be -16");
    CHECK(refused("35 cm").hint == "numbers are plain SI: write 0.35 (m)");
    CHECK(refused("5 cm/s").hint == "numbers are plain SI: write 0.05 (m/s)");
    CHECK(refused("5 furlong").hint == "numbers are plain SI, without their unit");
    for (const char* text : {"1e", "1e+", "1.5 2.5", "1..2"}) CHECK(refused(text).hint == "", text);
}

TEST_CASE(infinity_and_whole_numbers_only_by_rule) {
    CHECK(read("inf", {.infinity = true}).value() == HUGE_VAL);
    CHECK(read("12", {.whole = true}).value() == 12);
    for (const char* text : {"1.0", "1e3", ".5"}) CHECK(refused(text, {.whole = true}).code == "number.whole", text);
}

TEST_CASE(the_nearest_word_is_within_two_slips) {
    const std::vector<std::string> words = {"stiffness", "law", "length", "type"};
    CHECK(nearest("stifness", words) == "stiffness");
    CHECK(nearest("lenght", words) == "length");
    CHECK(nearest("tpye", words) == "type");
    CHECK(nearest("damping", words) == "");
    CHECK(nearest("brake", {"make", "break"}) == "break");
    CHECK(nearest("brake", {"break", "make"}) == "break");
    CHECK(nearest("x", words) == "");
    CHECK(nearest(std::string(100'000, 'x'), words) == "");
}

TEST_CASE(a_problem_is_one_line_and_harmless) {
    const Problem problem{.code = "c",
                          .path = "a.b",
                          .message = "wrong\n",
                          .got = "\x1b[31m" + std::string(500, 'x'),
                          .allowed = "1",
                          .hint = "h",
                          .file = "f.yaml",
                          .line = 3,
                          .column = 7};
    const std::string text = describe(problem);
    CHECK(text.starts_with("f.yaml:3:7: error[c]: a.b: wrong\\n, got \\u001b[31m"));
    CHECK(text.ends_with(", allowed 1; h"));
    CHECK(text.find('\x1b') == std::string::npos);
    CHECK(text.size() < 200u);
}

TEST_CASE(an_error_shows_20_problems_at_most) {
    const Error error(ARM3R_E_SCENARIO, std::vector<Problem>(50, Problem{"c", "p", "m", "", "", ""}));
    CHECK(error.problems().size() == 20u);
}

TEST_CASE(one_is_not_several) {
    CHECK(counted(0, "item") == "0 items");
    CHECK(counted(1, "make event") == "1 make event");
    CHECK(counted(2, "item") == "2 items");
}

TEST_CASE(bytes_that_are_not_utf8_are_found) {
    for (const char* good : {"", "a", "\u00e9", "\u20ac", "\U0001F600"}) CHECK(is_utf8(good));
    for (const char* bad : {"\xff", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "\x80"})
        CHECK(!is_utf8(bad));
    CHECK(count_characters("a\u20acb") == 3u);
    CHECK(json_string("a\"\\\n\x01") == "\"a\\\"\\\\\\n\\u0001\"");
}

TEST_SUITE_END()

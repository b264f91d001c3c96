#pragma once
// Test cases and assertions of Boost.Test. What Boost's own macros compile anew at each place is compiled once, in
// check.cpp: a place of use is a call.
//
//     CHECK(a <= b);             counts as an assertion; where it fails, both values are printed, and the test goes on
//     CHECK(a <= b, "at " << t)  prints the message as well
//     REQUIRE(a <= b)            ends the test case where it fails
//
// The two sides are numbers, texts, or rows of numbers. A condition of any other kind is one truth value, in parentheses
// if it has an operator: CHECK((a == b && c < d)).

#include <compare>
#include <concepts>
#include <ostream>
#include <source_location>
#include <span>
#include <sstream>
#include <string>
#include <string_view>

namespace arm3r::checks {

// A number of any type, by value.
class Number {
public:
    template <std::same_as<bool> Truth>
    Number(Truth x) : kind_(Kind::truth), integer_(x) {}
    Number(double x) : kind_(Kind::real), real_(x) {}
    Number(int x) : Number(static_cast<long long>(x)) {}
    Number(long x) : Number(static_cast<long long>(x)) {}
    Number(long long x) : kind_(Kind::integer), integer_(x) {}
    Number(unsigned x) : Number(static_cast<unsigned long long>(x)) {}
    Number(unsigned long x) : Number(static_cast<unsigned long long>(x)) {}
    Number(unsigned long long x) : kind_(Kind::natural), natural_(x) {}

    friend std::partial_ordering order(const Number& a, const Number& b);
    friend std::ostream& operator<<(std::ostream& out, const Number& x);
    bool is_true() const;

private:
    enum class Kind { truth, integer, natural, real };
    Kind kind_;
    union {
        long long integer_;
        unsigned long long natural_;
        double real_;
    };
    double as_real() const;
};

// A text that lives as long as the assertion.
struct Text {
    std::string_view text;
    Text(const char* from) : text(from) {}
    Text(const std::string& from) : text(from) {}
    Text(std::string_view from) : text(from) {}
};

// Numbers in a row: of a vector, or a list.
struct Numbers {
    std::span<const double> numbers;
    template <class Row>
        requires requires(const Row& row) { std::span<const double>(row.data(), row.data() + row.size()); }
    Numbers(const Row& row) : numbers(row.data(), row.data() + row.size()) {}
};

enum class Comparison { equal, unequal, less, at_most, greater, at_least };

// Whether a condition holds. The values of one that does not are kept for the report, which follows.
struct [[nodiscard]] Outcome {
    bool holds;

    template <class T>
    void operator&&(const T&) const = delete;  // put the condition into parentheses
    template <class T>
    void operator||(const T&) const = delete;
};

Outcome truth(const Number& condition);
Outcome compare(const Number& left, Comparison comparison, const Number& right);
Outcome compare(const Text& left, Comparison comparison, const Text& right);
Outcome compare(const Numbers& left, Comparison comparison, const Numbers& right);

template <class Side>
struct Left {
    Side side;

    Outcome operator==(const Side& right) const { return compare(side, Comparison::equal, right); }
    Outcome operator!=(const Side& right) const { return compare(side, Comparison::unequal, right); }
    Outcome operator<(const Side& right) const { return compare(side, Comparison::less, right); }
    Outcome operator<=(const Side& right) const { return compare(side, Comparison::at_most, right); }
    Outcome operator>(const Side& right) const { return compare(side, Comparison::greater, right); }
    Outcome operator>=(const Side& right) const { return compare(side, Comparison::at_least, right); }
    template <class T>
    void operator&&(const T&) const = delete;  // put the condition into parentheses
    template <class T>
    void operator||(const T&) const = delete;
    operator Outcome() const
        requires std::same_as<Side, Number>
    {
        return truth(side);
    }
};

// Takes a condition apart: << binds tighter than a comparison, and weaker than arithmetic.
struct Start {
    Left<Number> operator<<(const Number& x) const { return {x}; }
    Left<Text> operator<<(const Text& x) const { return {x}; }
    Left<Numbers> operator<<(const Numbers& x) const { return {x}; }
};

// Equal up to a part of either number.
Outcome close(double a, double b, double tolerance);

enum class Level { check, require };

// Counts an assertion, and reports a failure, unless report_failure() is called next, after its message was written.
bool passes(Outcome outcome, const char* condition, Level level, bool has_message,
            std::source_location place = std::source_location::current());
std::ostream& message();
void report_failure();

// A test case, and the suite of the cases between its begin and its end.
struct Case {
    Case(const char* name, void (*run)(), std::source_location place = std::source_location::current());
};
struct SuiteBegin {
    explicit SuiteBegin(const char* name, std::source_location place = std::source_location::current());
};
struct SuiteEnd {
    SuiteEnd();
};

// What the failures of a block add to their text.
class Context {
public:
    explicit Context(const std::string& text);
    ~Context();
    Context(const Context&) = delete;

private:
    int id_;
};

void log_message(const std::string& text, std::source_location place = std::source_location::current());

}  // namespace arm3r::checks

#define TEST_SUITE(name) \
    namespace name {     \
    static const ::arm3r::checks::SuiteBegin suite_begin(#name);
#define TEST_SUITE_END()                              \
    static const ::arm3r::checks::SuiteEnd suite_end; \
    }
#define TEST_CASE(name)                                          \
    static void name();                                          \
    static const ::arm3r::checks::Case name##_case(#name, name); \
    static void name()

#define ARM3R_ASSERT(level, outcome, condition, ...)                                                                  \
    do {                                                                                                              \
        if (!::arm3r::checks::passes(outcome, condition, ::arm3r::checks::Level::level, false __VA_OPT__(|| true))) { \
            __VA_OPT__(::arm3r::checks::message() << __VA_ARGS__; ::arm3r::checks::report_failure();)                 \
        }                                                                                                             \
    } while (false)
#define CHECK(condition, ...) \
    ARM3R_ASSERT(check, ::arm3r::checks::Start() << condition, #condition __VA_OPT__(, ) __VA_ARGS__)
#define REQUIRE(condition, ...) \
    ARM3R_ASSERT(require, ::arm3r::checks::Start() << condition, #condition __VA_OPT__(, ) __VA_ARGS__)
#define CHECK_CLOSE(a, b, tolerance) ARM3R_ASSERT(check, ::arm3r::checks::close(a, b, tolerance), #a " is close to " #b)

// The statement throws an Error, and, if so is said, one of which the condition is true.
#define CHECK_THROWS(statement, Error, ...)                                                 \
    do {                                                                                    \
        try {                                                                               \
            statement;                                                                      \
            CHECK(false, "exception " #Error " is expected");                               \
        } catch (const Error& error) {                                                      \
            CHECK((__VA_OPT__(__VA_ARGS__(error) &&) true), "incorrect exception " #Error); \
        }                                                                                   \
    } while (false)

#define CONTEXT(text) if (const ::arm3r::checks::Context context((std::ostringstream() << text).str()); true)
#define LOG_MESSAGE(text) ::arm3r::checks::log_message((std::ostringstream() << text).str())

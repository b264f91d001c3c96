#define BOOST_TEST_MODULE arm3r
#include "check.hpp"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <iomanip>

namespace arm3r::checks {

using boost::test_tools::assertion_result;
namespace details = boost::test_tools::tt_detail;

// ---- values

double Number::as_real() const {
    return kind_ == Kind::real ? real_ : kind_ == Kind::natural ? double(natural_) : double(integer_);
}

bool Number::is_true() const { return as_real() != 0; }

// As numbers: -1 is less than any unsigned integer.
std::partial_ordering order(const Number& a, const Number& b) {
    using Kind = Number::Kind;
    if (a.kind_ == Kind::real || b.kind_ == Kind::real) return a.as_real() <=> b.as_real();
    const bool a_natural = a.kind_ == Kind::natural, b_natural = b.kind_ == Kind::natural;
    if (a_natural && b_natural) return a.natural_ <=> b.natural_;
    if (a_natural) return b.integer_ < 0 ? std::partial_ordering::greater : order(a, Number(b.natural_));
    if (b_natural) return a.integer_ < 0 ? std::partial_ordering::less : order(Number(a.natural_), b);
    return a.integer_ <=> b.integer_;
}

std::ostream& operator<<(std::ostream& out, const Number& x) {
    switch (x.kind_) {
        case Number::Kind::truth: return out << (x.integer_ ? "true" : "false");
        case Number::Kind::integer: return out << x.integer_;
        case Number::Kind::natural: return out << x.natural_;
        default: return out << std::setprecision(17) << x.real_;
    }
}

static std::partial_ordering order(const Text& a, const Text& b) { return a.text <=> b.text; }
static std::ostream& operator<<(std::ostream& out, const Text& x) { return out << x.text; }

static std::partial_ordering order(const Numbers& a, const Numbers& b) {
    return std::lexicographical_compare_three_way(a.numbers.begin(), a.numbers.end(), b.numbers.begin(),
                                                  b.numbers.end());
}
static std::ostream& operator<<(std::ostream& out, const Numbers& row) {
    for (const double& x : row.numbers) out << (&x == row.numbers.data() ? "" : " ") << Number(x);
    return out;
}

static bool has(std::partial_ordering order, Comparison comparison) {
    switch (comparison) {
        case Comparison::equal: return order == 0;
        case Comparison::unequal: return order != 0;
        case Comparison::less: return order < 0;
        case Comparison::at_most: return order <= 0;
        case Comparison::greater: return order > 0;
        default: return order >= 0;
    }
}

static const char* opposite(Comparison comparison) {
    switch (comparison) {
        case Comparison::equal: return " != ";
        case Comparison::unequal: return " == ";
        case Comparison::less: return " >= ";
        case Comparison::at_most: return " > ";
        case Comparison::greater: return " <= ";
        default: return " < ";
    }
}

// ---- assertions

// The failure that is being reported.
struct Failure {
    std::string values;
    const char* condition = nullptr;
    Level level = Level::check;
    std::source_location place;
    std::ostringstream message;
};
static Failure failure;

Outcome truth(const Number& condition) {
    if (!condition.is_true()) failure.values.clear();
    return {condition.is_true()};
}

template <class Side>
static Outcome compare_sides(const Side& left, Comparison comparison, const Side& right) {
    if (has(order(left, right), comparison)) return {true};
    std::ostringstream values;
    values << left << opposite(comparison) << right;
    failure.values = values.str();
    return {false};
}
Outcome compare(const Number& left, Comparison comparison, const Number& right) {
    return compare_sides(left, comparison, right);
}
Outcome compare(const Text& left, Comparison comparison, const Text& right) {
    return compare_sides(left, comparison, right);
}
Outcome compare(const Numbers& left, Comparison comparison, const Numbers& right) {
    return compare_sides(left, comparison, right);
}

Outcome close(double a, double b, double tolerance) {
    const double apart = std::abs(a - b);
    if (apart == 0 || (apart / std::abs(a) <= tolerance && apart / std::abs(b) <= tolerance)) return {true};
    std::ostringstream values;
    values << Number(a) << " and " << Number(b) << " differ by more than " << tolerance;
    failure.values = values.str();
    return {false};
}

bool passes(Outcome outcome, const char* condition, Level level, bool has_message, std::source_location place) {
    boost::unit_test::unit_test_log.set_checkpoint(place.file_name(), place.line());
    if (outcome.holds) {
        details::report_assertion(true, BOOST_TEST_LAZY_MSG(condition), place.file_name(), place.line(), details::CHECK,
                                  details::CHECK_BUILT_ASSERTION, 0);
        return true;
    }
    failure.condition = condition;
    failure.level = level;
    failure.place = place;
    failure.message.str("");
    if (!has_message) report_failure();
    return false;
}

std::ostream& message() { return failure.message; }

void report_failure() {
    assertion_result result(false);
    if (!failure.values.empty()) result.message() << " [" << failure.values << "]";
    const std::string text = failure.message.str();
    if (!text.empty()) result.message() << ": " << text;
    details::report_assertion(result, BOOST_TEST_LAZY_MSG(failure.condition), failure.place.file_name(),
                              failure.place.line(), failure.level == Level::require ? details::REQUIRE : details::CHECK,
                              details::CHECK_BUILT_ASSERTION, 0);
}

// ---- test cases and what stands around them

using Registrar = boost::unit_test::ut_detail::auto_test_unit_registrar;

Case::Case(const char* name, void (*run)(), std::source_location place) {
    Registrar(boost::unit_test::make_test_case(run, name, place.file_name(), place.line()),
              boost::unit_test::decorator::collector_t::instance());
}

SuiteBegin::SuiteBegin(const char* name, std::source_location place) {
    Registrar(name, place.file_name(), place.line(), boost::unit_test::decorator::collector_t::instance());
}
SuiteEnd::SuiteEnd() { Registrar(1); }

Context::Context(const std::string& text)
    : id_(boost::unit_test::framework::add_context(BOOST_TEST_LAZY_MSG(text), true)) {}
Context::~Context() { boost::unit_test::framework::clear_context(id_); }

void log_message(const std::string& text, std::source_location place) {
    boost::unit_test::unit_test_log << boost::unit_test::log::begin(place.file_name(), place.line())
                                    << boost::unit_test::log_messages << text << boost::unit_test::log::end();
}

}  // namespace arm3r::checks

#pragma once
// Arms, states and scenarios for the tests. They avoid what hides mistakes: q1 = 0, q3 = -2 q2, equal lengths, equal
// masses, zero rates.

#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arm3r/numbers/eigen_traits.hpp"
#include "batch/simulation.hpp"
#include "record/run_data.hpp"
#include "schema/columns.hpp"
#include "schema/schema.hpp"
#include "setup/setup.hpp"
#include "validate/validate.hpp"

namespace arm3r {

inline bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

class Random {
public:
    explicit Random(unsigned seed);
    double in(double low, double high);
    Vec3<double> vector(double low, double high);

private:
    std::mt19937_64 generator_;
};

// The flat parameters, set by name.
class Params {
public:
    Params();
    Params(const Params& from);
    Params& operator=(const Params& from);
    ~Params();

    Params& set(std::string_view name, double value);
    Params& set(std::string_view path, std::initializer_list<double> values);
    Params& set(std::string_view path, const Vec3<double>& v);
    Params& choose(std::string_view path, std::string_view word);
    operator std::span<const double>() const;
    Arm<double> arm() const;
    Run run(const RunOptions& options = {}) const;

private:
    std::vector<double> numbers_;
};

std::vector<Problem> problems_of(std::span<const double> params);

// A link whose every number differs from that of any other.
void randomise_link(Params& params, const std::string& link, Random& random);

// All that an arm can have: armature, damping, dry friction, payload, base height, oblique gravity.
Params random_params(Random& random);

// All that an elbow arm can have: offsets, tensors, rotors that spin across their joints, a base anywhere.
Params random_elbow_params(Random& random);

// An unequal arm that nothing disturbs; the wall, once set, is infinite.
Params unequal_params();

std::span<const double> column(const Run& run, std::string_view name);
double last(const Run& run, std::string_view name);

// A vector that moves: its value at an instant, and its rate as slope.
Vec3<Dual<1>> moving(const Vec3<double>& v, const Vec3<double>& rate);
Vec3<Dual<3>> variables(const Vec3<double>& v);

double distance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

}  // namespace arm3r

#include "fixtures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

namespace arm3r {

Random::Random(unsigned seed) : generator_(seed) {}

double Random::in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }

Vec3<double> Random::vector(double low, double high) {
    const double x = in(low, high), y = in(low, high);
    return {x, y, in(low, high)};
}

Params::Params() : numbers_(param_defaults()) {}
Params::Params(const Params& from) = default;
Params& Params::operator=(const Params& from) = default;
Params::~Params() = default;

Params& Params::set(std::string_view name, double value) {
    numbers_[param_index(name)] = value;
    return *this;
}

Params& Params::set(std::string_view path, std::initializer_list<double> values) {
    std::copy(values.begin(), values.end(), numbers_.begin() + std::ptrdiff_t(find_key(path)->offset));
    return *this;
}

Params& Params::set(std::string_view path, const Vec3<double>& v) { return set(path, {v[0], v[1], v[2]}); }

Params& Params::choose(std::string_view path, std::string_view word) {
    const Key& key = *find_key(path);
    const auto place = std::find(key.choices.begin(), key.choices.end(), word);
    if (place == key.choices.end()) throw std::invalid_argument("no such choice: " + std::string(word));
    numbers_[key.offset] = double(place - key.choices.begin());
    return *this;
}

Params::operator std::span<const double>() const { return numbers_; }
Arm<double> Params::arm() const { return make_arm(numbers_); }
Run Params::run(const RunOptions& options) const { return simulate(valid_setup(numbers_), options); }

std::vector<Problem> problems_of(std::span<const double> params) { return validate(params).problems; }

void randomise_link(Params& params, const std::string& link, Random& random) {
    const double length = random.in(0.3, 1.2);
    const Vec3<double> part = random.vector(0.005, 0.05);
    params.set(link + ".length", length)
        .set(link + ".mass", random.in(0.3, 3))
        .set(link + ".com", length * random.in(0.1, 0.9));
    params.set(link + ".inertia", {part[1] + part[2], part[0] + part[2], part[0] + part[1]});
}

Params random_params(Random& random) {
    Params params;
    params.choose("arm.convention", "slide")
        .set("arm.base_height", random.in(-1, 1))
        .set("arm.gravity", random.vector(-10, 10));
    params.set("arm.link1.mass", random.in(0.3, 3))
        .set("arm.link1.com", random.in(-0.5, 0.5))
        .set("arm.link1.inertia_axial", random.in(0.1, 0.5));
    randomise_link(params, "arm.link2", random);
    randomise_link(params, "arm.link3", random);
    params.set("arm.payload.mass", random.in(0, 2)).set("arm.armature", random.vector(0, 0.1));
    params.set("arm.damping", random.vector(0, 0.5))
        .set("arm.friction", random.vector(0, 0.5))
        .set("arm.friction_velocity", 0.1);
    return params;
}

Params random_elbow_params(Random& random) {
    Params params = random_params(random);
    params.choose("arm.model", "elbow").set("arm.link2.offset", random.in(-0.3, 0.3));
    params.set("arm.base.position", random.vector(-1, 1)).set("arm.base.rotation", random.vector(-3, 3));
    params.set("arm.shoulder_offset", random.in(-0.4, 0.4)).set("arm.link3.tip", random.vector(0.2, 0.8));
    for (const std::string link : {"arm.link1", "arm.link2", "arm.link3"}) {
        const Vec3<double> principal = Vec3<double>(1, 1, 1) + random.vector(0, 0.9);  // of a body
        const Eigen::Matrix3d turn = Eigen::Quaterniond(random.in(-1, 1), random.in(-1, 1), random.in(-1, 1), 1.0)
                                         .normalized()
                                         .toRotationMatrix();
        const Eigen::Matrix3d tensor = 0.1 * turn * principal.asDiagonal() * turn.transpose();
        params.set(link + ".com", random.vector(-0.5, 0.5));
        params.set(link + ".inertia",
                   {tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(0, 2), tensor(1, 2)});
    }
    for (const std::string rotor : {"arm.rotor1", "arm.rotor2", "arm.rotor3"})
        params.set(rotor + ".inertia", random.in(0, 1e-3))
            .set(rotor + ".ratio", random.in(-30, 30))
            .set(rotor + ".mass", random.in(0, 1))
            .set(rotor + ".axis", random.vector(0.1, 1));
    return params;
}

Params unequal_params() {
    Params params;
    params.choose("arm.convention", "slide").set("arm.base_height", 0.3);
    params.set("arm.link1.inertia_axial", 0.02).set("arm.link2.length", 0.8).set("arm.link2.mass", 1.3);
    params.set("arm.link3.length", 0.6)
        .set("arm.link3.mass", 0.7)
        .set("initial.q", {0.4, 0.7, -0.9})
        .set("initial.qd", {0, 0, 0});
    params.set("wall.size", {HUGE_VAL, HUGE_VAL});
    return params;
}

std::span<const double> column(const Run& run, std::string_view name) {
    for (std::size_t i = 0; i < run.columns.size(); ++i)
        if (column_table[run.columns[i]].name == name) return run.column(i);
    throw std::invalid_argument("no column " + std::string(name));
}

double last(const Run& run, std::string_view name) { return column(run, name).back(); }

Vec3<Dual<1>> moving(const Vec3<double>& v, const Vec3<double>& rate) {
    return {Dual<1>(v[0], {rate[0]}), Dual<1>(v[1], {rate[1]}), Dual<1>(v[2], {rate[2]})};
}

Vec3<Dual<3>> variables(const Vec3<double>& v) {
    return {Dual<3>::variable(v[0], 0), Dual<3>::variable(v[1], 1), Dual<3>::variable(v[2], 2)};
}

double distance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return (a - b).cwiseAbs().maxCoeff(); }

}  // namespace arm3r

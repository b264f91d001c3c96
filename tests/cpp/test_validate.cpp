#include <cstring>
#include <functional>

#include "arm3r/lanes.hpp"
#include "check.hpp"
#include "fixtures.hpp"
#include "schema/param_access.hpp"
#include "validate/validate.hpp"

namespace arm3r {

TEST_SUITE(validating)

using Numbers = std::vector<double>;

static Numbers numbers_of(const Params& params) {
    const std::span<const double> all = params;
    return {all.begin(), all.end()};
}

static std::size_t place(std::string_view path, std::size_t item = 0) { return find_key(path)->offset + item; }

static bool is_number(const Key& key) {
    return key.kind == Kind::number || key.kind == Kind::angle || key.kind == Kind::integer;
}

// One scenario for each thing that decides which keys exist.
static std::vector<Params> bases() {
    const Params compensated = unequal_params().choose("controller.type", "gravity_compensation").set("wall", 1);
    const Params constant = unequal_params().choose("controller.type", "constant").set("controller.torque", {1, 2, 3});
    return {
        unequal_params(),
        compensated,
        constant,
        Params(compensated).set("controller.model.link3.mass", 0.9).set("controller.model.armature", {0, 0.1, 0}),
        Params(compensated)
            .choose("controller.model.link2.shape", "cylinder")
            .set("controller.model.link2.radius", 0.1),
        Params(compensated).choose("controller.model.link1.shape", "slender").set("controller.model.link1.length", 1),
        Params(compensated).choose("solver.method", "taylor").set("wall.acts_on_arm", 1),
        Params(constant).choose("solver.method", "rk4").set("wall", 1).choose("wall.motion.type", "fixed"),
        Params().set("wall", 1).choose("wall.contact.law", "diagonal").set("wall.contact.stiffness", {1e3, 10, 20}),
        Params()
            .set("wall", 1)
            .choose("wall.motion.type", "sinusoid")
            .set("wall.motion.amplitude", 0.1)
            .set("wall.motion.frequency", 2),
        Params()
            .set("wall", 1)
            .choose("wall.motion.type", "table")
            .set("wall.motion.t", {0, 1, 2})
            .set("wall.motion.s", {0, 0.1, 0})
            .set("wall.motion.v", {0, 0, 0})
            .set("wall.motion.a", {0, 0, 0})
            .choose("wall.rotation.type", "constant")
            .set("wall.rotation.axis", {1, 2, 3})
            .set("wall.rotation.rate", 1)
            .choose("wall.contact.law", "hunt_crossley")
            .set("wall.contact.stiffness", 1e6)
            .set("wall.contact.dissipation", 1),
        Params()
            .set("wall", 1)
            .choose("wall.motion.type", "ramp")
            .set("wall.motion.distance", 0.1)
            .set("wall.motion.duration", 2)
            .choose("wall.contact.law", "kelvin_voigt")
            .set("wall.contact.restitution", 0.5),
        Params().choose("arm.link1.shape", "slender").set("arm.link1.length", 0.4).set("arm.link1.mass", 3),
        Params().choose("arm.link3.shape", "slender"),
        Params().set("arm.link2.density", -1),
        Params(compensated).set("controller.model.link3.inertia", {0.1, 0.2, 0.31}),
    };
}

// Numbers as a user might type them, and those that only an attack would hold.
static double hostile(const Key& key, Random& random) {
    const double kind = random.in(0, 1), within = random.in(0, 1);
    if (kind < 0.05) return std::nan("");
    if (kind < 0.08) return random.in(-1, 1) < 0 ? -HUGE_VAL : HUGE_VAL;
    if (kind < 0.12) return key.bounds.low;
    if (kind < 0.16) return key.bounds.high;
    if (kind < 0.18) return std::nextafter(key.bounds.low, -HUGE_VAL);
    if (kind < 0.20) return std::nextafter(key.bounds.high, HUGE_VAL);
    if (kind < 0.25) return 0;
    if (kind < 0.30) return -within;
    if (key.kind == Kind::angle) return 6 * within - 3;
    return key.kind == Kind::integer ? std::floor(100 * within) + 1 : within;
}

struct Varied {
    const Key* key;
    std::size_t number;
};

static std::vector<Varied> some_numbers(double share, Random& random) {
    std::vector<Varied> varied;
    for (const Key& key : schema())
        for (std::size_t i = 0; is_number(key) && i < key.size; ++i)
            if (random.in(0, 1) < share) varied.push_back({&key, key.offset + i});
    return varied;
}

static std::vector<std::size_t> places(const std::vector<Varied>& varied) {
    std::vector<std::size_t> numbers;
    for (const Varied& v : varied) numbers.push_back(v.number);
    return numbers;
}

TEST_CASE(the_quick_verdict_is_that_of_validate_for_any_numbers) {
    Random random(31);
    std::size_t valid = 0, invalid = 0;
    for (const Params& base : bases()) {
        for (int i = 0; i < 60; ++i) {
            const std::vector<Varied> varied = some_numbers(random.in(0, 1) < 0.7 ? 0.04 : 0.4, random);
            const Checker is_valid(base, places(varied));
            for (int j = 0; j < 20; ++j) {
                Numbers params = numbers_of(base);
                for (const Varied& v : varied)
                    if (random.in(0, 1) < 0.4) params[v.number] = hostile(*v.key, random);
                const std::vector<Problem> problems = problems_of(params);
                (problems.empty() ? valid : invalid) += 1;
                REQUIRE(is_valid(params).has_value() == problems.empty(),
                        (problems.empty() ? "valid, yet refused" : describe(problems.front())));
            }
        }
    }
    CHECK(valid > 3000u);
    CHECK(invalid > 3000u);
}

// The numbers of a setup that a variation may change, and the choices that follow from them.
static Numbers numbers_of(const Setup& setup) {
    Numbers numbers{double(setup.plant.contact.has_friction), setup.start, setup.stop};
    each_number([&](double x) { numbers.push_back(x); }, setup.plant);
    for (const Vec3<double>& v : {setup.q, setup.qd}) numbers.insert(numbers.end(), v.data(), v.data() + 3);
    return numbers;
}

static bool same_bits(const Numbers& a, const Numbers& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST_CASE(a_setup_made_of_the_one_before_is_that_made_anew) {
    Random random(32);
    const auto is_of_start = [](const Varied& v) {
        return v.key->path.starts_with("initial.") || v.key->path.starts_with("wall.contact.");
    };
    std::size_t made = 0, refused = 0;
    for (const Params& base : bases()) {
        std::vector<std::vector<Varied>> variations{some_numbers(0.1, random)};
        for (const Varied& v : some_numbers(1, random)) variations.push_back({v});
        for (int i = 0; i < 20; ++i)
            std::erase_if(variations.emplace_back(some_numbers(0.7, random)), std::not_fn(is_of_start));
        for (const std::vector<Varied>& varied : variations) {
            const Checker check(base, places(varied));
            std::optional<Setup> setup;
            for (int j = 0; j < 8; ++j) {
                Numbers params = numbers_of(base);
                for (const Varied& v : varied)
                    if (random.in(0, 1) < 0.5) params[v.number] = hostile(*v.key, random);
                const std::optional<Setup> anew = check(params);
                check(params, setup);
                (anew ? made : refused) += 1;
                REQUIRE(setup.has_value() == anew.has_value(), varied.front().key->path);
                if (anew) REQUIRE(same_bits(numbers_of(*setup), numbers_of(*anew)), varied.front().key->path);
            }
        }
    }
    CHECK(made > 10000u);
    CHECK(refused > 3000u);
}

// Each rule once: a number that breaks it, and the key whose rule it is.
struct Breach {
    Params base;
    std::size_t number;
    double fine, broken;
    std::string code;
};

static std::vector<Breach> breaches() {
    const Params compensated = unequal_params().choose("controller.type", "gravity_compensation").set("wall", 1);
    const Params near = Params(compensated).set("wall.point", {1.08, 0, 0});
    const Params flat = unequal_params().choose("arm.link2.shape", "slender").choose("arm.link3.shape", "slender");
    const Params inertia = unequal_params().set("arm.link3.inertia", {0.1, 0.2, 0.3});
    const Params model = Params(compensated).set("controller.model.link2.inertia", {0.1, 0.2, 0.3});
    const Params taylor = Params(compensated).choose("solver.method", "taylor");
    return {
        {compensated, place("wall.contact.stiffness"), 1e7, -1, "scenario.range"},
        {compensated, place("wall.contact.stiffness"), 1e7, std::nan(""), "scenario.missing_key"},
        {compensated, place("controller.gravity", 1), std::nan(""), 1, "scenario.missing_key"},
        {compensated, place("solver.max_steps"), 10, 10.5, "scenario.type"},
        {compensated, place("arm.link3.com"), std::nan(""), HUGE_VAL, "scenario.range"},
        {compensated, place("controller.model.link3.length"), 0.4, 1e-7, "scenario.range"},
        {compensated, place("wall.point"), 2, 0.9, "scenario.starts_inside_wall"},
        {near, place("initial.q"), 0.4, 0, "scenario.starts_inside_wall"},
        {compensated, place("wall.normal"), -2, 0, "scenario.range"},
        {flat, place("arm.link1.inertia_axial"), 2e-9, 0, "scenario.singular_mass_matrix"},
        {flat, place("arm.link2.mass"), 1, std::nan(""), "scenario.missing_key"},
        {inertia, place("arm.link3.inertia", 2), 0.29, 0.31, "scenario.inertia"},
        {model, place("controller.model.link2.inertia", 2), 0.29, 0.31, "scenario.inertia"},
        {taylor, place("arm.torque_limit", 1), HUGE_VAL, 10, "scenario.corner"},
        {taylor, place("solver.tol"), 1e-12, 1e-16, "scenario.range"},
    };
}

TEST_CASE(each_rule_is_seen_through_the_number_that_breaks_it) {
    for (const Breach& breach : breaches()) {
        CONTEXT(param_name(breach.number) << " = " << breach.broken) {
            Numbers fine = numbers_of(breach.base), broken = fine;
            fine[breach.number] = breach.fine;
            broken[breach.number] = breach.broken;
            CHECK(problems_of(fine).empty());
            REQUIRE(!problems_of(broken).empty());
            CHECK(problems_of(broken).front().code == breach.code);
            for (const Numbers& base : {fine, broken}) {
                const Checker is_valid(base, std::array{breach.number});
                CHECK(is_valid(fine).has_value());
                CHECK(!is_valid(broken).has_value());
            }
        }
    }
}

TEST_CASE(what_is_wrong_in_the_base_and_never_varied_is_wrong_in_all) {
    const std::array varied{place("initial.q")};
    for (const Params& base :
         {Params().set("arm.payload.mass", -1), Params().set("solver.rtol", 1),
          Params().set("solver.method", double(known_key("solver.method").choices.size())),
          Params().choose("arm.link3.shape", "slender"), Params().set("arm.link2.inertia", {1, 0, 0}),
          Params().choose("controller.type", "gravity_compensation").set("controller.model.payload.mass", -1),
          Params().choose("controller.type", "gravity_compensation").set("controller.model.link1.shape", -1)})
        CHECK(!Checker(base, varied)(base).has_value());
    CHECK(Checker(Params(), varied)(Params()).has_value());
    const Numbers short_of_one(param_count() - 1);
    CHECK(!Checker(short_of_one, varied)(short_of_one).has_value());
}

TEST_CASE(what_the_controller_does_not_use_is_no_matter) {
    const Params base = Params().set("controller.model.link2.inertia", {1, 0, 0});
    CHECK(Checker(base, std::array{place("controller.model.link2.inertia")})(base).has_value());
}

// ---- names that the compiler knows

TEST_CASE(a_name_that_the_compiler_knows_reads_what_the_schema_says) {
    const Params params = unequal_params().choose("solver.method", "rk4");
    CHECK(at<"initial.q">(params, 2) == param(params, "initial.q", 2));
    CHECK((at<Name("arm.link2") + ".length">(params)) == 0.8);
    CHECK(vector_at<"initial.q">(params)[1] == 0.7);
    CHECK((is<"solver.method", "rk4">(params)));
    CHECK((!is<"solver.method", "taylor">(params)));
}

TEST_CASE(a_name_that_is_not_in_the_schema_is_a_bug_that_is_named) {
    const Params params;
    const auto names = [](const char* part) {
        return [part](const Error& error) { return std::string(error.what()).find(part) != std::string::npos; };
    };
    CHECK_THROWS(at<"wall.pointe">(params), Error, names("wall.pointe"));
    CHECK_THROWS((is<"solver.method", "rk5">(params)), Error, names("rk5"));
}

TEST_SUITE_END()

}  // namespace arm3r

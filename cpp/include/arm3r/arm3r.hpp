#pragma once
// arm3r for C++20: the handles of arm3r.h as objects that free themselves, its failures as exceptions. Units, frames and
// layouts are those of arm3r.h, joint vectors in the arm's convention.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "arm3r/arm3r.h"

namespace arm3r::api {

// ---- errors, one class for each way in which a caller can react

class Error : public std::runtime_error {
public:
    Error(int status, const std::string& message, std::string json)
        : std::runtime_error(message), status_(status), json_(std::move(json)) {}

    int status() const { return status_; }  // of arm3r_status
    // {"status", "code", "message", "problems": [...]}, as arm3r_error_json writes it.
    const std::string& json() const { return json_; }

private:
    int status_;
    std::string json_;
};

// An argument is not usable, or a file cannot be read.
struct UsageError : Error {
    using Error::Error;
};
// The scenario is not valid: what() names every place.
struct ScenarioError : Error {
    using Error::Error;
};
// The rows, steps or memory allowed are not enough.
struct BudgetError : Error {
    using Error::Error;
};
// A result cannot be written.
struct OutputError : Error {
    using Error::Error;
};
// A function of the caller's asked to stop.
struct CallbackError : Error {
    using Error::Error;
};
// Header, library or scenario format are of different versions.
struct IncompatibleError : Error {
    using Error::Error;
};

// Throws the last failure of this thread where `status` is one.
inline void check(std::int32_t status) {
    if (status == ARM3R_OK) return;
    const std::string message = arm3r_error_message(), json = arm3r_error_json();
    switch (-status / 100) {
        case 1: throw UsageError(status, message, json);
        case 2: throw ScenarioError(status, message, json);
        case 4: throw BudgetError(status, message, json);
        case 5: throw OutputError(status, message, json);
        case 6: throw CallbackError(status, message, json);
        case 7: throw IncompatibleError(status, message, json);
        default: throw Error(status, message, json);
    }
}

// ---- handles

// Owns what a function of the C interface made.
template <class T, void (*free)(T*)>
class Handle {
public:
    Handle() = default;
    // make: called with the place to write the handle to, and returns a status.
    template <class Make>
    explicit Handle(Make make) {
        T* made = nullptr;
        check(make(&made));
        owned_.reset(made);
    }
    T* get() const { return owned_.get(); }

private:
    struct Free {
        void operator()(T* owned) const { free(owned); }
    };
    std::unique_ptr<T, Free> owned_;
};

using Vector = std::array<double, 3>;
using Matrix = std::array<double, 9>;  // row-major

// ---- the arm

class Arm {
public:
    // params: as Scenario::params() has them.
    explicit Arm(std::span<const double> params)
        : arm_([&](arm3r_arm** arm) { return arm3r_arm_create(params.data(), params.size(), arm); }) {}

    Vector tip_position(const Vector& q) const { return of<Vector>(arm3r_arm_tip_position, q); }  // m
    Matrix jacobian(const Vector& q) const { return of<Matrix>(arm3r_arm_jacobian, q); }          // m
    Matrix mass_matrix(const Vector& q) const { return of<Matrix>(arm3r_arm_mass_matrix, q); }    // kg m^2
    Vector gravity_torque(const Vector& q) const {
        return of<Vector>(arm3r_arm_gravity_torque, q);
    }  // N m: holds the arm
    Vector velocity_product(const Vector& q, const Vector& qd) const {  // N m: C qd
        return of<Vector>(arm3r_arm_velocity_product, q, qd);
    }
    Vector forward_dynamics(const Vector& q, const Vector& qd, const Vector& tau, const Vector& f_on_tip = {}) const {
        return of<Vector>(arm3r_arm_forward_dynamics, q, qd, tau, f_on_tip);  // rad/s^2
    }
    Vector inverse_dynamics(const Vector& q, const Vector& qd, const Vector& qdd, const Vector& f_on_tip = {}) const {
        return of<Vector>(arm3r_arm_inverse_dynamics, q, qd, qdd, f_on_tip);  // N m
    }
    // The joint angles that put the tip at a point, rad; nothing where it is out of reach. front: joint 1 faces the point;
    // elbow_up: the elbow lies above the line from shoulder to tip.
    std::optional<Vector> inverse_kinematics(const Vector& tip, bool front = true, bool elbow_up = true) const {
        Vector q;
        const std::int32_t status =
            arm3r_arm_inverse_kinematics(get(), 1, tip.data(), front, elbow_up, q.data(), nullptr);
        if (status == ARM3R_E_REACH) return {};
        check(status);
        return q;
    }

    const arm3r_arm* get() const { return arm_.get(); }  // for the functions of arm3r.h that are not here

private:
    template <class Result, class Function, class... In>
    Result of(Function function, const In&... in) const {
        Result out;
        check(function(get(), 1, in.data()..., out.data()));
        return out;
    }

    Handle<arm3r_arm, arm3r_arm_free> arm_;
};

// ---- a run

class Run {
public:
    template <class Make>
        requires std::invocable<Make, arm3r_run**>
    explicit Run(Make make) : run_(make) {}

    arm3r_outcome outcome() const {
        std::int32_t outcome;
        check(arm3r_run_outcome(get(), &outcome));
        return static_cast<arm3r_outcome>(outcome);
    }
    std::size_t rows() const { return shape().first; }
    std::vector<std::string> columns() const {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < shape().second; ++i) names.emplace_back(column_at(i).first);
        return names;
    }
    // A number for each row, as long as this run lives. Throws std::out_of_range where there is no such column.
    std::span<const double> column(std::string_view name) const {
        for (std::size_t i = 0; i < shape().second; ++i)
            if (const auto [own, values] = column_at(i); own == name) return values;
        throw std::out_of_range("the run has no column " + std::string(name));
    }
    std::vector<arm3r_event> events() const {
        std::size_t count;
        check(arm3r_run_event_count(get(), &count));
        std::vector<arm3r_event> events(count);
        for (std::size_t i = 0; i < count; ++i) check(arm3r_run_event(get(), i, &events[i]));
        return events;
    }
    struct Checks {
        std::size_t count, failed;
    };
    Checks checks() const {
        Checks checks;
        check(arm3r_run_checks(get(), &checks.count, &checks.failed));
        return checks;
    }
    std::string summary() const { return text(arm3r_run_summary); }  // JSON
    std::string report() const { return text(arm3r_run_report); }    // for people
    std::string warnings() const { return text(arm3r_run_warnings); }
    // Writes PATH, .csv or .npz, and the summary beside it.
    void save(std::string_view path) const { check(arm3r_run_save(get(), path.data(), path.size())); }

    const arm3r_run* get() const { return run_.get(); }

private:
    std::pair<std::size_t, std::size_t> shape() const {
        std::size_t rows, columns;
        check(arm3r_run_shape(get(), &rows, &columns));
        return {rows, columns};
    }
    std::pair<std::string_view, std::span<const double>> column_at(std::size_t index) const {
        const char *name, *unit;
        const double* data;
        check(arm3r_run_column(get(), index, &name, &unit, &data));
        return {name, {data, rows()}};
    }
    std::string text(std::int32_t (*function)(const arm3r_run*, const char**)) const {
        const char* text;
        check(function(get(), &text));
        return text;
    }

    Handle<arm3r_run, arm3r_run_free> run_;
};

// ---- scenarios

// A law of your own: the torques, N m, that are held from this sample to the next.
using Law = std::function<Vector(const arm3r_law_state&)>;

class Scenario {
public:
    // file: what messages call the text.
    explicit Scenario(std::string_view text, std::string_view file = "scenario.yaml")
        : scenario_([&](arm3r_scenario** made) {
              return arm3r_scenario_create(text.data(), text.size(), file.data(), file.size(), made);
          }) {}
    Scenario(const Scenario& other)
        : scenario_([&](arm3r_scenario** made) { return arm3r_scenario_copy(other.get(), made); }) {}
    Scenario(Scenario&&) = default;
    Scenario& operator=(Scenario other) {
        scenario_ = std::move(other.scenario_);
        return *this;
    }
    static Scenario load(std::string_view path) { return Scenario(FromFile{path}); }

    // Puts a value, as YAML writes it, in place of what stands at a dotted path: set("wall.contact.stiffness", "2e3").
    // origin: what messages call the place that it comes from.
    Scenario& set(std::string_view path, std::string_view value, std::string_view origin = "set") {
        check(arm3r_scenario_set_from(scenario_.get(), path.data(), path.size(), value.data(), value.size(),
                                      origin.data(), origin.size()));
        return *this;
    }
    // The value at a path as JSON, defaults included.
    std::string at(std::string_view path) const {
        const char* json;
        check(arm3r_scenario_get(get(), path.data(), path.size(), &json));
        return json;
    }
    void validate() const { check(arm3r_scenario_validate(get())); }
    std::string name() const { return text(arm3r_scenario_name); }
    std::string warnings() const { return text(arm3r_scenario_warnings); }
    // The whole scenario with all defaults; annotate: each value with its origin in a comment.
    std::string yaml(bool annotate = false) const {
        const char* yaml;
        check(arm3r_scenario_yaml(get(), annotate, &yaml));
        return yaml;
    }
    std::vector<double> params() const {
        std::size_t count;
        check(arm3r_scenario_param_count(get(), &count));
        std::vector<double> params(count);
        check(arm3r_scenario_params(get(), params.data(), params.size()));
        return params;
    }
    Arm arm() const { return Arm(params()); }

    Run run(const arm3r_run_options* options = nullptr) const {
        return Run([&](arm3r_run** run) { return arm3r_scenario_run(get(), options, run); });
    }
    // With a law, for a scenario with controller.type: user. What the law throws comes out of this call.
    Run run(const Law& law, const arm3r_run_options* options = nullptr) const {
        struct Call {
            const Law& law;
            std::exception_ptr thrown = {};
        } call{law};
        const auto function = [](void* user, const arm3r_law_state* state, double* tau) -> std::int32_t {
            auto& [law, thrown] = *static_cast<Call*>(user);
            try {
                std::ranges::copy(law(*state), tau);
                return 0;
            } catch (...) {
                thrown = std::current_exception();
                return -1;
            }
        };
        Run run([&](arm3r_run** made) { return arm3r_scenario_control(get(), function, &call, options, made); });
        if (call.thrown) std::rethrow_exception(call.thrown);
        return run;
    }

    const arm3r_scenario* get() const { return scenario_.get(); }

private:
    struct FromFile {
        std::string_view path;
    };
    explicit Scenario(FromFile file)
        : scenario_(
              [&](arm3r_scenario** made) { return arm3r_scenario_load(file.path.data(), file.path.size(), made); }) {}
    std::string text(std::int32_t (*function)(const arm3r_scenario*, const char**)) const {
        const char* text;
        check(function(get(), &text));
        return text;
    }

    Handle<arm3r_scenario, arm3r_scenario_free> scenario_;
};

// ---- a run that you step yourself

// Waits at each sample of a scenario with controller.type: user until step() gives it torques.
class Simulation {
public:
    explicit Simulation(const Scenario& scenario)
        : simulation_([&](arm3r_simulation** made) { return arm3r_simulation_create(scenario.get(), made); }) {}
    // A copy goes on as the original would, bit for bit.
    Simulation(const Simulation& other)
        : simulation_([&](arm3r_simulation** made) { return arm3r_simulation_copy(other.get(), made); }) {}
    Simulation(Simulation&&) = default;
    Simulation& operator=(Simulation other) {
        simulation_ = std::move(other.simulation_);
        return *this;
    }

    bool is_over() const {
        std::int32_t is_over;
        check(arm3r_simulation_is_over(get(), &is_over));
        return is_over != 0;
    }
    // What the controller sees at the present sample.
    arm3r_law_state state() const {
        arm3r_law_state state{};
        state.struct_size = sizeof state;
        check(arm3r_simulation_state(get(), &state));
        return state;
    }
    // Applies torques, N m, from this sample to the next.
    void step(const Vector& tau) { check(arm3r_simulation_step(simulation_.get(), tau.data())); }
    // The rows so far; the outcome is `stopped` where it is not over.
    Run run() const {
        return Run([&](arm3r_run** run) { return arm3r_simulation_run(get(), run); });
    }

    const arm3r_simulation* get() const { return simulation_.get(); }

private:
    Handle<arm3r_simulation, arm3r_simulation_free> simulation_;
};

// ---- many runs

// The summaries of many runs of a scenario.
class Batch {
public:
    // Run i has the scenario's numbers, but values[j][i] in the place of the number varied[j], "wall.contact.stiffness" or
    // "initial.q[1]". Throws std::invalid_argument where the columns of values differ in length.
    Batch(const Scenario& scenario, const std::vector<std::string>& varied,
          const std::vector<std::vector<double>>& values, const arm3r_batch_options* options = nullptr) {
        if (varied.size() != values.size() || values.empty())
            throw std::invalid_argument("a batch needs a list of values for each number that varies");
        runs_ = values.front().size();
        std::vector<double> flat;
        for (const std::vector<double>& column : values) {
            if (column.size() != runs_) throw std::invalid_argument("the lists of values differ in length");
            flat.insert(flat.end(), column.begin(), column.end());
        }
        std::vector<std::size_t> places(varied.size());
        for (std::size_t j = 0; j < varied.size(); ++j)
            check(arm3r_param_index(varied[j].data(), varied[j].size(), &places[j]));
        const std::vector<double> params = scenario.params();
        results_.resize(runs_ * arm3r_summary_count());
        check(arm3r_batch_run(params.data(), params.size(), places.data(), places.size(), flat.data(), runs_, options,
                              results_.data()));
    }

    std::size_t size() const { return runs_; }
    // A number of each run: "peak_force", "contacts", ... Throws std::out_of_range where there is none of this name.
    std::span<const double> operator[](std::string_view name) const {
        for (std::size_t i = 0; i < arm3r_summary_count(); ++i) {
            const char *own, *unit, *meaning;
            check(arm3r_summary_column(i, &own, &unit, &meaning));
            if (own == name) return {results_.data() + i * runs_, runs_};
        }
        throw std::out_of_range("a summary has no number " + std::string(name));
    }

private:
    std::size_t runs_ = 0;
    std::vector<double> results_;
};

}  // namespace arm3r::api

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "batch_runs.hpp"
#include "check.hpp"

namespace arm3r {

// Controllers in a batch are what they are alone, bit for bit, all summary numbers included: for every law, sensor and
// wall, every width, number of threads and order.
TEST_SUITE(batch_controllers)

static constexpr int run_count = 9;  // no multiple of a width: lanes are refilled, and run empty

namespace {

// An unequal arm whose tip a wall comes to within the first tenth of a second; every run has numbers of its own.
struct Controlled : Runs {
    Random random{41};

    explicit Controlled(std::string_view type, std::string_view method = "rk4") {
        base = unequal_params();
        base.choose("solver.method", method).set("solver.step", 0.001).choose("controller.type", type);
        base.set("initial.qd", {0.1, -0.05, 0.08}).set("time.log_every", 0.1);
        base.set("sensors", 1).set("wall", 1).set("wall.acts_on_arm", 1).set("wall.point", {1.112, 0, 0.5});
        base.set("wall.motion.velocity", 0.06);
        vary("initial.q[0]", 0.39, 0.41).vary("initial.q[1]", 0.69, 0.71).vary("initial.q[2]", -0.91, -0.89);
        vary("initial.qd[1]", -0.2, 0.2).vary("time.stop", 0.25, 0.35);
        vary("wall.contact.stiffness", 500, 3000).vary("wall.normal[1]", -0.2, 0.2);
        vary("arm.link3.mass", 0.5, 0.9).vary("controller.model.link3.mass", 0.5, 0.9);
        vary("controller.gravity", 9.7, 9.9);
    }

    Controlled& vary(const std::string& name, double low, double high) {
        return vary(name, spread(random, low, high, run_count));
    }
    Controlled& vary(const std::string& name, std::vector<double> its) {
        const auto place = std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
        if (place == names.size()) names.push_back(name), values.emplace_back();
        values[place] = std::move(its);
        return *this;
    }
    Controlled& choose(std::string_view path, std::string_view word) { return base.choose(path, word), *this; }
    Controlled& set(std::string_view name, double value) { return base.set(name, value), *this; }
    Controlled& set(std::string_view path, std::initializer_list<double> all) { return base.set(path, all), *this; }

    // Rates of their own too: some runs are sampled at every step, others at every second.
    Controlled& sampled() {
        constexpr double rates[] = {1000, 500, 1000};
        std::vector<double> its;
        for (int i = 0; i < run_count; ++i) its.push_back(rates[i % 3]);
        return set("sampling", 1).vary("sampling.rate", its);
    }
    Controlled& controls_force() {
        vary("reference.force.value", 4, 9).vary("controller.force_gain", 0.3, 0.7);
        return vary("controller.force_integral_gain", 3, 9);
    }

    double sum(const std::vector<double>& table, std::string_view name) const {
        double sum = 0;
        for (std::size_t i = 0; i < count(); ++i) sum += number(table, name, i);
        return sum;
    }

    Runs in_order(const std::vector<std::size_t>& order) const {
        Runs other = *this;
        for (std::size_t j = 0; j < values.size(); ++j)
            for (std::size_t i = 0; i < order.size(); ++i) other.values[j][i] = values[j][order[i]];
        return other;
    }
};

void check_order(const Controlled& runs, const std::vector<double>& table) {
    std::vector<std::size_t> order(runs.count());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937_64(42));
    const std::vector<double> shuffled = runs.in_order(order).together({.threads = 2});
    for (std::size_t c = 0; c < summary_table().size(); ++c)
        for (std::size_t i = 0; i < order.size(); ++i)
            CHECK(same(shuffled[c * order.size() + i], table[c * order.size() + order[i]]),
                  summary_table()[c].name << " in run " << order[i]);
}

// The table of runs, most of which end well; `contacts` where the wall is to be met by some of them.
std::vector<double> check(const Controlled& runs, bool contacts = true) {
    const std::vector<double> table = check_widths_and_threads(runs);
    check_against_single_runs(runs, table);
    check_order(runs, table);
    int ended_well = 0;
    for (std::size_t i = 0; i < runs.count(); ++i) ended_well += int(runs.number(table, "outcome", i)) == ARM3R_RUN_OK;
    CHECK(ended_well > 0.6 * run_count);
    if (contacts) CHECK(runs.sum(table, "contacts") > 0.2 * run_count);
    return table;
}

struct Case {
    std::string name;
    std::string type;
    std::function<void(Controlled&)> prepare;
};

void nothing(Controlled&) {}

const std::vector<Case>& laws() {
    const auto force = [](Controlled& runs) { runs.controls_force(); };
    const auto chosen = [](const char* path, const char* word, bool controls_force = false) {
        return [=](Controlled& runs) {
            runs.choose(path, word);
            if (controls_force) runs.controls_force();
        };
    };
    const auto sought = [](Controlled& runs) {
        runs.vary("reference.force.value", 4, 9).vary("controller.reference_gain", 0.01, 0.03);
    };
    static const std::vector<Case> all = {
        {"gravity compensation", "gravity_compensation", nothing},
        {"by the recursion", "gravity_compensation", chosen("controller.algorithm", "recursion")},
        {"joint PD", "joint_pd", [](Controlled& runs) { runs.vary("controller.joint_stiffness[1]", 100, 300); }},
        {"computed torque", "computed_torque", [](Controlled& runs) { runs.set("controller.cancel_force", 1); }},
        {"resolved acceleration", "resolved_acceleration",
         [](Controlled& runs) {
             runs.choose("reference.type", "sinusoid").set("reference.tip_amplitude", {0.02, 0.03, -0.01});
             runs.vary("reference.frequency", 0.5, 2);
         }},
        {"stiffness", "stiffness", [](Controlled& runs) { runs.vary("controller.stiffness[0]", 200, 900); }},
        {"joint stiffness", "joint_stiffness", nothing},
        {"impedance", "impedance",
         [](Controlled& runs) {
             runs.choose("reference.type", "minimum_jerk").set("reference.tip", {1.2, 0.45, 0.66});
             runs.vary("reference.duration", 0.2, 0.5);
         }},
        {"shaped impedance", "shaped_impedance",
         [](Controlled& runs) { runs.set("controller.mass", {2, 2, 2}).vary("controller.mass[1]", 1, 3); }},
        {"operational space", "operational_space", force},
        {"operational space, fed forward", "operational_space", chosen("controller.force_term", "feedforward", true)},
        {"hybrid", "hybrid", force},
        {"hybrid by statics", "hybrid", chosen("controller.variant", "jacobian_transpose", true)},
        {"hybrid, projected", "hybrid", chosen("controller.variant", "projected", true)},
        {"hybrid of Raibert and Craig", "hybrid", chosen("controller.variant", "raibert_craig", true)},
        {"hybrid, latched, along a circle", "hybrid",
         [](Controlled& runs) {
             runs.controls_force().choose("controller.switching", "latched");
             runs.choose("reference.type", "circle").vary("reference.radius", 0.05, 0.1);
         }},
        {"parallel", "parallel", force},
        {"parallel from the start, a force that swings", "parallel",
         [](Controlled& runs) {
             runs.controls_force().choose("controller.switching", "always");
             runs.choose("reference.force.type", "sinusoid").vary("reference.force.frequency", 1, 4);
         }},
        {"admittance", "admittance", nothing},
        {"admittance about a position loop", "admittance", chosen("controller.inner", "position")},
        {"admittance about joint PD", "admittance", chosen("controller.inner", "joint_pd")},
        {"adaptive reference", "adaptive_reference", sought},
        {"adaptive reference, indirect", "adaptive_reference",
         [](Controlled& runs) {
             runs.choose("controller.adaptation", "indirect").vary("controller.assumed_stiffness", 800, 1500);
         }},
        {"energy tank", "energy_tank", [](Controlled& runs) { runs.vary("controller.tank_energy", 0.02, 0.06); }},
        {"energy tank that is none", "energy_tank", [](Controlled& runs) { runs.set("controller.tank", 0); }},
        {"virtual wall", "virtual_wall",
         [](Controlled& runs) {
             runs.set("controller.plane_point", {1.11, 0, 0}).vary("controller.plane_point[0]", 1.09, 1.12);
         }},
    };
    return all;
}

}  // namespace

TEST_CASE(every_law_that_computes_continuously) {
    for (const Case& law : laws()) {
        CONTEXT(law.name) {
            Controlled runs(law.type);
            law.prepare(runs);
            check(runs);
        }
    }
}

TEST_CASE(every_law_that_computes_at_samples) {
    for (const char* method : {"rk4", "taylor"}) {
        for (const Case& law : laws()) {
            CONTEXT(law.name << " by " << method) {
                Controlled runs(law.type, method);
                law.prepare(runs);
                check(runs.sampled());
            }
        }
    }
}

// Sensors, sampling, observer and so on, each of it alone: it changes the motion, and lanes and threads agree.
namespace {

struct Effect {
    std::string name;
    std::function<void(Controlled&)> add;
    bool by_taylor = true, changes_the_motion = true;
};

std::vector<double> counts(double least) {
    std::vector<double> its;
    for (int i = 0; i < run_count; ++i) its.push_back(least + 511 * i);
    return its;
}

const std::vector<Effect>& effects() {
    const auto reaction = [](const char* word) {
        return [word](Controlled& runs) {
            runs.set("observer", 1).choose("observer.reaction", word);
            runs.set("observer.gain", {50, 50, 50}).set("observer.threshold", {1, 1, 1});
            runs.vary("observer.threshold[1]", 0.5, 2)
                .vary("observer.gain[2]", 30, 80)
                .vary("observer.hold", 0.005, 0.03);
        };
    };
    const auto limited = [](const char* saturation, const char* anti_windup) {
        return [=](Controlled& runs) {
            runs.choose("controller.saturation", saturation).choose("controller.anti_windup", anti_windup);
            runs.set("arm.torque_limit", {6, 17, 5}).vary("arm.torque_limit[1]", 15, 18);
            runs.vary("controller.tracking_time", 0.05, 0.2);
        };
    };
    static const std::vector<Effect> all = {
        {"encoder", [](Controlled& runs) { runs.vary("sensors.encoder.counts", counts(2000)); }},
        {"rates from differences", [](Controlled& runs) { runs.choose("sensors.velocity.estimate", "difference"); }},
        {"rates from differences of an encoder behind a filter",
         [](Controlled& runs) {
             runs.choose("sensors.velocity.estimate", "filtered").vary("sensors.velocity.cutoff", 40, 90);
             runs.vary("sensors.encoder.counts", counts(20000));
         }},
        {"noise of each run's own",
         [](Controlled& runs) {
             std::vector<double> seeds;
             for (int i = 0; i < run_count; ++i) seeds.push_back(100 + i);
             runs.vary("sampling.seed", seeds).vary("sensors.force.noise", 0.05, 0.2);
         }},
        {"bias",
         [](Controlled& runs) {
             runs.set("sensors.force.bias", {0.3, 0.1, -0.2}).vary("sensors.force.bias[0]", 0.5, 1);
         }},
        {"resolution", [](Controlled& runs) { runs.vary("sensors.force.resolution", 0.1, 0.5); }},
        {"analog filter", [](Controlled& runs) { runs.vary("sensors.force.analog_cutoff", 30, 90); }, false},
        {"digital filter", [](Controlled& runs) { runs.vary("sensors.force.cutoff", 30, 90); }},
        {"force that comes later",
         [](Controlled& runs) {
             std::vector<double> delays;
             for (int i = 0; i < run_count; ++i) delays.push_back(1 + 0.35 * (i % 4));
             runs.vary("sensors.force.delay", delays);
         }},
        {"tool", [](Controlled& runs) { runs.vary("sensors.force.tool_mass", 0.02, 0.1); }},
        {"torque that comes whole samples later",
         [](Controlled& runs) {
             std::vector<double> delays;
             for (int i = 0; i < run_count; ++i) delays.push_back(1 + i % 3);
             runs.vary("sampling.delay", delays);
         }},
        {"torque that comes between samples",
         [](Controlled& runs) {  // on a step of rk4
             std::vector<double> delays;
             for (int i = 0; i < run_count; ++i) delays.push_back(0.5 * (1 + i % 4));
             runs.set("solver.step", 0.0005).vary("sampling.delay", delays);
         }},
        {"limit, each joint for itself", limited("clamp", "none"), false},
        {"limit, conditional integration", limited("clamp", "conditional"), false},
        {"limit, back-calculation", limited("clamp", "back_calculation"), false},
        {"limit by one factor", limited("scale", "none"), false},
        {"limit by one factor, conditional integration", limited("scale", "conditional"), false},
        {"limit by one factor, back-calculation", limited("scale", "back_calculation"), false},
        {"observer", reaction("ignore"), true, false},
        {"observer that stops", reaction("stop")},
        {"observer with reaction float", reaction("float")},
        {"observer with a reflex", reaction("reflex")},
        {"observer that retreats", reaction("retreat")},
        {"estimator",
         [](Controlled& runs) {
             // Its samples are the controller's: elsewhere a step of taylor would be cut in two.
             runs.set("estimator", 1).vary("estimator.forgetting", 0.98, 1);
         },
         true, false},
        {"estimator of a wall that stands",
         [](Controlled& runs) {
             runs.set("estimator", 1).choose("estimator.wall", "fixed").vary("estimator.largest_condition", 1e6, 1e8);
         },
         true, false},
    };
    return all;
}

// Whether some run of the two tables moved otherwise.
bool differs(const Controlled& runs, const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < runs.count(); ++i)
        if (!same(runs.number(a, "q2", i), runs.number(b, "q2", i))) return true;
    return false;
}

}  // namespace

TEST_CASE(every_sensor_and_reaction) {
    for (const char* method : {"rk4", "taylor"}) {
        Controlled plain("hybrid", method);
        plain.controls_force().sampled();
        const std::vector<double> ideal = plain.together({.threads = 1, .lanes = 1});
        for (const Effect& effect : effects()) {
            if (!effect.by_taylor && std::string_view(method) == "taylor") continue;
            CONTEXT(effect.name << " by " << method) {
                Controlled runs = plain;
                effect.add(runs);
                CHECK(differs(runs, check(runs), ideal) == effect.changes_the_motion);
            }
        }
    }
}

TEST_CASE(all_of_it_at_once) {
    for (const char* method : {"rk4", "taylor", "dopri5"}) {
        CONTEXT(method) {
            const bool is_taylor = std::string_view(method) == "taylor";
            Controlled runs("hybrid", method);
            runs.controls_force().sampled();
            for (const Effect& effect : effects())
                if (effect.by_taylor || !is_taylor) effect.add(runs);
            runs.set("solver.step", 0.0005).choose("observer.reaction", "retreat");
            runs.vary("observer.threshold[1]", 15, 30).set("observer.threshold", {20, 20, 20});
            const std::vector<double> table = check(runs);
            if (!is_taylor) CHECK(runs.sum(table, "saturation_share") > 0);
        }
    }
}

TEST_CASE(a_virtual_wall_that_is_kept_passive) {
    for (const char* method : {"rk4", "taylor", "dopri5"}) {
        CONTEXT(method) {
            Controlled runs("virtual_wall", method);
            runs.sampled().set("controller.plane_point", {1.11, 0, 0}).vary("controller.plane_point[0]", 1.09, 1.11);
            runs.vary("controller.stiffness[0]", 5e3, 3e4).set("wall.point[0]", 2).set("initial.qd", {0.1, -0.4, 0.3});
            const std::vector<double> let_go = check(runs, false);
            runs.set("controller.passivity_control", 1);
            CHECK(differs(runs, check(runs, false), let_go));
        }
    }
}

// The assumed stiffness becomes the estimate: only in runs in contact, from an instant of each run's own.
TEST_CASE(an_estimate_that_a_law_goes_by) {
    for (const char* method : {"rk4", "taylor", "dopri5"}) {
        CONTEXT(method) {
            Controlled runs("adaptive_reference", method);
            runs.sampled().choose("controller.adaptation", "indirect").vary("controller.assumed_stiffness", 800, 1500);
            const std::vector<double> assumed = check(runs);
            runs.set("estimator", 1).vary("estimator.start", 0, 0.05).vary("estimator.largest_condition", 1e6, 1e9);
            const std::vector<double> table = check(runs);
            CHECK(differs(runs, table, assumed));
            int told = 0;
            for (std::size_t i = 0; i < runs.count(); ++i) told += runs.number(table, "stiffness_estimate", i) > 0;
            CHECK(told > 0.4 * run_count);
        }
    }
}

TEST_CASE(a_continuous_controller_with_bias_filter_observer_and_limits) {
    for (const char* saturation : {"clamp", "scale"}) {
        for (const char* anti_windup : {"none", "conditional", "back_calculation"}) {
            CONTEXT(saturation << ", " << anti_windup) {
                Controlled runs("parallel");
                runs.controls_force().vary("sensors.force.bias[1]", 0.1, 0.4);
                runs.vary("sensors.force.analog_cutoff", 30, 90)
                    .set("observer", 1)
                    .set("observer.gain", {50, 50, 50})
                    .vary("observer.gain[0]", 30, 80);
                runs.choose("controller.saturation", saturation).choose("controller.anti_windup", anti_windup);
                runs.set("arm.torque_limit", {6, 17, 5}).vary("arm.torque_limit[1]", 15, 18);
                CHECK(runs.sum(check(runs), "saturation_share") > 0);
            }
        }
    }
}

TEST_CASE(walls_that_damp_rub_and_turn) {
    const auto kelvin_voigt = [](Controlled& runs) {
        runs.choose("wall.contact.law", "kelvin_voigt").vary("wall.contact.damping", 1, 9);
    };
    const auto hunt_crossley = [](Controlled& runs) {
        runs.choose("wall.contact.law", "hunt_crossley").vary("wall.contact.stiffness", 1e4, 5e4);
        runs.vary("wall.contact.exponent", 1.2, 1.8).vary("wall.contact.dissipation", 0.1, 3);
    };
    const auto rubs = [](Controlled& runs) {
        runs.vary("wall.contact.friction.coefficient", 0.1, 0.5)
            .vary("wall.contact.friction.slip_velocity", 0.01, 0.02);
    };
    const auto turns = [](Controlled& runs) {
        runs.choose("wall.rotation.type", "sinusoid").set("wall.rotation.axis", {0.3, -0.8, 0.5});
        runs.vary("wall.rotation.amplitude", -0.05, 0.05).vary("wall.rotation.frequency", 0.3, 2);
        runs.vary("wall.rotation.phase", -1, 1).set("wall.size", {3, 3}).vary("wall.size[0]", 2.5, 4);
    };
    for (const char* type : {"hybrid", "stiffness", "parallel"}) {
        for (const bool is_sampled : {false, true}) {
            const auto prepared = [&](const char* method) {
                Controlled runs(type, method);
                if (std::string_view(type) != "stiffness") runs.controls_force();
                if (is_sampled) runs.sampled();
                return runs;
            };
            for (const char* method : {"rk4", "dopri5"}) {
                for (int wall = 0; wall < 4; ++wall) {
                    CONTEXT(type << (is_sampled ? " at samples" : "") << " by " << method << ", wall " << wall) {
                        Controlled runs = prepared(method);
                        if (wall == 0) kelvin_voigt(runs);
                        if (wall == 1) hunt_crossley(runs);
                        if (wall == 2) kelvin_voigt(runs), rubs(runs), turns(runs);
                        if (wall == 3) hunt_crossley(runs), rubs(runs), turns(runs);
                        check(runs);
                    }
                }
            }
        }
    }
}

TEST_CASE(a_push_from_outside) {
    for (const char* type : {"gravity_compensation", "impedance"}) {
        for (const char* method : {"rk4", "dopri5"}) {
            CONTEXT(type << " by " << method) {
                Controlled runs(type, method);
                runs.set("push", 1).set("push.force", {5, -3, 2}).vary("push.force[0]", 3, 9);
                runs.vary("push.start", 0.02, 0.1).vary("push.rise", 0.01, 0.05).vary("push.duration", 0.05, 0.3);
                check(runs);
            }
        }
    }
}

// Structures of which lanes can hold only one at a time: runs of others wait for lanes of their own.
TEST_CASE(runs_some_of_which_have_noise_delays_or_an_encoder) {
    for (const char* method : {"rk4", "taylor"}) {
        CONTEXT(method) {
            Controlled runs("hybrid", method);
            runs.controls_force().sampled();
            const auto only = [&](const char* name, int every, double value) {
                std::vector<double> its(run_count, 0.0);
                for (int i = every - 1; i < run_count; i += every) its[std::size_t(i)] = value;
                runs.vary(name, its);
            };
            only("sensors.force.noise", 2, 0.1), only("sampling.delay", 3, 2), only("sensors.encoder.counts", 5, 5000);
            check(runs);
        }
    }
}

TEST_SUITE_END()

}  // namespace arm3r

// The text half of the C interface: scenarios, results, reference.

#include <algorithm>
#include <memory>

#include "api/c_api.hpp"
#include "base/callback.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "batch/simulation.hpp"
#include "files/input_file.hpp"
#include "files/yaml_json.hpp"
#include "results/csv.hpp"
#include "results/report.hpp"
#include "results/run_file.hpp"
#include "scenario/arm_file.hpp"
#include "scenario/json_schema.hpp"
#include "scenario/reference_docs.hpp"
#include "scenario/sweep.hpp"
#include "schema/columns.hpp"
#include "schema/schema.hpp"
#include "schema/suggest.hpp"
#include "setup/setup.hpp"
#include "validate/size_limits.hpp"
#include "validate/warnings.hpp"

using namespace arm3r;

namespace {

constexpr std::size_t any_size = SIZE_MAX;           // the reader has its own limit, and its own words for it
constexpr std::size_t enough = most_yaml_bytes + 1;  // of a text that is longer than the reader takes

// What arm3r_yaml_json or arm3r_sweep_read, and arm3r_output_summary returned last: it stays until this thread asks
// again.
thread_local std::string last_json, last_summary;

Results results_of(const arm3r_run& run) {
    return {run.run, run.name, run.scenario, run.checks, run.setup, run.horizon};
}

arm3r_scenario* new_scenario(Scenario scenario) {
    auto handle = std::make_unique<arm3r_scenario>();
    handle->scenario = std::move(scenario);
    return handle.release();
}

const char* summary_of(const arm3r_run& run) {
    return run.texts.get("summary", [&] { return summary_json(results_of(run)); });
}

void set(arm3r_scenario* scenario, const std::string& path, const std::string& value, const std::string& origin) {
    Scenario edited = scenario->scenario;
    arm3r::set(edited, path, value, origin);
    scenario->scenario = std::move(edited);
    scenario->changed();
}

// A text that is made once for the whole process; "" where there is no memory for it.
template <std::string (*make)()>
const char* made_once() noexcept {
    const char* text = "";
    guard([&] {
        static const std::string made = make();
        text = made.c_str();
    });
    return text;
}

}  // namespace

void arm3r::describe(arm3r_run& handle, const Resolved& resolved, const char* yaml) {
    handle.name = resolved.name;
    handle.scenario = yaml;
    handle.run.warnings.insert(handle.run.warnings.begin(), resolved.warnings.begin(), resolved.warnings.end());
    handle.setup = resolved.setup;
    handle.checks = evaluate(resolved.checks, handle.run, resolved.params);
}

const Resolved& arm3r_scenario::resolved() const {
    const std::lock_guard lock(mutex_);
    if (!resolved_) resolved_ = resolve(scenario);
    return *resolved_;
}

const char* arm3r_scenario::yaml() const {
    const Resolved& resolved = this->resolved();
    return texts.get("yaml", [&] { return to_yaml(resolved.tree, false); });
}

void arm3r_scenario::changed() {
    resolved_.reset();
    texts.clear();
}

// ---- scenarios

int32_t arm3r_nearest_word(const char* word, const char* const* words, size_t n_words, int64_t* place) {
    return guard([&] {
        need(word, "word");
        need(words, "words");
        need(place, "place");
        for (std::size_t i = 0; i < n_words; ++i) need(words[i], "words");
        const std::vector<std::string> all(words, words + n_words);
        const auto found = std::ranges::find(all, nearest(word, all));
        *place = found == all.end() ? -1 : found - all.begin();
    });
}

int32_t arm3r_set_arm_reader(arm3r_arm_reader reader, void* user) {
    return guard([&] {
        need(reinterpret_cast<const void*>(reader), "reader");
        set_arm_reader(reader, user);
    });
}

int32_t arm3r_scenario_create(const char* text, size_t text_size, const char* file, size_t file_size,
                              arm3r_scenario** scenario) {
    return guard([&] {
        need(text, "text");
        need(scenario, "scenario");
        const std::string name = text_in(file, file_size, "file");
        *scenario = new_scenario(read_scenario(std::string(text, std::min(text_size, enough)), name));
    });
}

int32_t arm3r_scenario_load(const char* path, size_t path_size, arm3r_scenario** scenario) {
    return guard([&] {
        need(scenario, "scenario");
        const std::string file = text_in(path, path_size, "path");
        *scenario = new_scenario(read_scenario(read_input(file, enough), file == "-" ? "<stdin>" : file));
    });
}

void arm3r_scenario_free(arm3r_scenario* scenario) { delete scenario; }

int32_t arm3r_scenario_copy(const arm3r_scenario* scenario, arm3r_scenario** copy) {
    return guard([&] {
        need(scenario, "scenario");
        need(copy, "copy");
        *copy = new_scenario(scenario->scenario);
    });
}

int32_t arm3r_scenario_set(arm3r_scenario* scenario, const char* path, size_t path_size, const char* value,
                           size_t value_size) {
    return guard([&] {
        need(scenario, "scenario");
        set(scenario, text_in(path, path_size, "path"), text_in(value, value_size, "value", any_size), "set");
    });
}

int32_t arm3r_scenario_set_from(arm3r_scenario* scenario, const char* path, size_t path_size, const char* value,
                                size_t value_size, const char* file, size_t file_size) {
    return guard([&] {
        need(scenario, "scenario");
        set(scenario, text_in(path, path_size, "path"), text_in(value, value_size, "value", any_size),
            text_in(file, file_size, "file"));
    });
}

int32_t arm3r_scenario_validate(const arm3r_scenario* scenario) {
    return guard([&] {
        need(scenario, "scenario");
        const Setup& setup = scenario->resolved().setup;
        with_locations(scenario->scenario, [&] { refuse_too_large(setup); });
    });
}

int32_t arm3r_scenario_get(const arm3r_scenario* scenario, const char* path, size_t path_size, const char** json) {
    return guard([&] {
        need(scenario, "scenario");
        need(json, "json");
        const std::string at = text_in(path, path_size, "path");
        const Resolved& resolved = scenario->resolved();
        *json = scenario->texts.get("get " + at, [&] { return json_at(resolved, at); });
    });
}

int32_t arm3r_scenario_name(const arm3r_scenario* scenario, const char** name) {
    return guard([&] {
        need(scenario, "scenario");
        need(name, "name");
        *name = scenario->resolved().name.c_str();
    });
}

int32_t arm3r_scenario_yaml(const arm3r_scenario* scenario, int32_t annotate, const char** yaml) {
    return guard([&] {
        need(scenario, "scenario");
        need(yaml, "yaml");
        const Resolved& resolved = scenario->resolved();
        *yaml = annotate ? scenario->texts.get("annotated", [&] { return to_yaml(resolved.tree, true); })
                         : scenario->yaml();
    });
}

int32_t arm3r_scenario_warnings(const arm3r_scenario* scenario, const char** text) {
    return guard([&] {
        need(scenario, "scenario");
        need(text, "text");
        const Resolved& resolved = scenario->resolved();
        *text = scenario->texts.get("warnings", [&] {
            const std::string place = visible(scenario->scenario.file, 4096) + ": warning: ";
            std::string lines;
            for (const std::string& slip : resolved.warnings) lines += place + slip + "\n";
            for (const std::string& slip : scenario_warnings(resolved.setup)) lines += place + slip + "\n";
            return lines;
        });
    });
}

int32_t arm3r_scenario_param_count(const arm3r_scenario* scenario, size_t* count) {
    return guard([&] {
        need(scenario, "scenario");
        need(count, "count");
        *count = scenario->resolved().params.size();
    });
}

int32_t arm3r_scenario_params(const arm3r_scenario* scenario, double* params, size_t count) {
    return guard([&] {
        need(scenario, "scenario");
        need(params, "params");
        const Resolved& resolved = scenario->resolved();
        if (count != resolved.params.size())
            throw Error(ARM3R_E_SIZE, "`count` is " + std::to_string(count) + ", there are " +
                                          std::to_string(resolved.params.size()) + " parameters");
        std::copy(resolved.params.begin(), resolved.params.end(), params);
    });
}

int32_t arm3r_scenario_run(const arm3r_scenario* scenario, const arm3r_run_options* options, arm3r_run** run) {
    return guard([&] {
        need(scenario, "scenario");
        need(run, "run");
        const Resolved& resolved = scenario->resolved();
        auto handle = std::make_unique<arm3r_run>();
        with_locations(scenario->scenario,
                       [&] { run_in(*handle, resolved.setup, options, columns_in(resolved.checks)); });
        describe(*handle, resolved, scenario->yaml());
        *run = handle.release();
    });
}

int32_t arm3r_yaml_json(const char* text, size_t text_size, const char* file, size_t file_size, const char** json) {
    return guard([&] {
        need(text, "text");
        need(json, "json");
        const std::string name = text_in(file, file_size, "file");
        last_json = yaml_json(std::string(text, std::min(text_size, enough)), name);
        *json = last_json.c_str();
    });
}

int32_t arm3r_sweep_read(const char* text, size_t text_size, const char* file, size_t file_size, const char** json,
                         arm3r_scenario** scenario) {
    return guard([&] {
        need(text, "text");
        need(json, "json");
        need(scenario, "scenario");
        Scenario base;
        const std::string name = text_in(file, file_size, "file");
        last_json = read_sweep(std::string(text, std::min(text_size, enough)), name, base);
        *json = last_json.c_str();
        *scenario = new_scenario(std::move(base));
    });
}

// ---- results

int32_t arm3r_run_summary(const arm3r_run* run, const char** json) {
    return guard([&] {
        need(run, "run");
        need(json, "json");
        *json = summary_of(*run);
    });
}

int32_t arm3r_run_report(const arm3r_run* run, const char** text) {
    return guard([&] {
        need(run, "run");
        need(text, "text");
        *text = run->texts.get("report", [&] { return report(results_of(*run)); });
    });
}

int32_t arm3r_run_warnings(const arm3r_run* run, const char** text) {
    return guard([&] {
        need(run, "run");
        need(text, "text");
        *text = run->texts.get("warnings", [&] {
            std::string lines;
            for (const std::string& warning : run->run.warnings) lines += warning + "\n";
            return lines;
        });
    });
}

int32_t arm3r_run_checks(const arm3r_run* run, size_t* count, size_t* failed) {
    return guard([&] {
        need(run, "run");
        need(count, "count");
        need(failed, "failed");
        *count = run->checks.size();
        *failed = 0;
        for (const CheckResult& check : run->checks) *failed += !check.passed;
    });
}

int32_t arm3r_run_block(const arm3r_run* run, const double** data, size_t* stride, const char** names) {
    return guard([&] {
        need(run, "run");
        need(data, "data");
        need(stride, "stride");
        need(names, "names");
        *data = run->run.data.get();
        *stride = run->run.capacity;
        *names = run->texts.get("names", [&] {
            std::vector<std::string> all;
            for (const std::size_t column : run->run.columns) all.emplace_back(column_table[column].name);
            return listed(all, ",");
        });
    });
}

int32_t arm3r_run_csv(const arm3r_run* run, arm3r_sink sink, void* user) {
    return guard([&] {
        need(run, "run");
        need(reinterpret_cast<const void*>(sink), "sink");
        if (!write_csv(run->run,
                       [&](std::string_view piece) { return call_back(sink, user, piece.data(), piece.size()) == 0; }))
            throw Error(ARM3R_E_OUTPUT, "the sink did not take all of the CSV");
    });
}

int32_t arm3r_run_save(const arm3r_run* run, const char* path, size_t path_size) {
    return guard([&] {
        need(run, "run");
        save_run(run->run, [run] { return summary_of(*run); }, text_in(path, path_size, "path"));
    });
}

int32_t arm3r_output_probe(const char* path, size_t path_size) {
    return guard([&] { probe_run_file(text_in(path, path_size, "path")); });
}

int32_t arm3r_output_summary(const char* path, size_t path_size, const char** summary) {
    return guard([&] {
        need(summary, "summary");
        last_summary = summary_path(text_in(path, path_size, "path"));
        *summary = last_summary.c_str();
    });
}

// ---- reference

const char* arm3r_schema_json(void) { return made_once<schema_json>(); }
const char* arm3r_sweep_schema_json(void) { return made_once<sweep_schema_json>(); }
const char* arm3r_schema_markdown(void) { return made_once<schema_markdown>(); }
const char* arm3r_columns_text(void) { return made_once<columns_text>(); }
const char* arm3r_columns_markdown(void) { return made_once<columns_markdown>(); }
const char* arm3r_template(void) { return made_once<scenario_template>(); }

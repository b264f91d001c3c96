// Many runs through the C interface.

#include <limits>

#include "api/c_api.hpp"
#include "batch/batch.hpp"
#include "batch/simulation.hpp"
#include "record/metrics.hpp"
#include "schema/param_access.hpp"
#include "schema/schema.hpp"

using namespace arm3r;

namespace {

BatchOptions batch_options_in(const arm3r_batch_options* given) {
    if (!given) return {};
    const char* const name = "arm3r_batch_options";
    const arm3r_batch_options options = struct_in(given, name);
    const auto refuse = [&](const char* field, int32_t value, const char* allowed) {
        throw Error(ARM3R_E_VALUE,
                    std::string(name) + ": " + field + " is " + std::to_string(value) + "; " + allowed + " is needed");
    };
    if (options.threads < 0) refuse("threads", options.threads, "0 or more");
    if (options.lanes < 0 || options.lanes > 8 || (options.lanes & (options.lanes - 1)))
        refuse("lanes", options.lanes, "0, 1, 2, 4 or 8");
    return {options.stop, options.progress, options.user, options.threads, options.lanes};
}

BatchLaw batch_law_in(const arm3r_batch_law& given) {
    const arm3r_batch_law law = struct_in(&given, "arm3r_batch_law");
    need(reinterpret_cast<const void*>(law.function), "law.function");
    if (law.reentrant != 0 && law.reentrant != 1)
        throw Error(ARM3R_E_VALUE,
                    "arm3r_batch_law: reentrant is " + std::to_string(law.reentrant) + "; 0 or 1 is needed");
    return {law.function, law.user, law.user_stride, law.reentrant == 1};
}

Variation variation_in(const double* params, std::size_t count, const std::size_t* varied, std::size_t varied_count,
                       const double* values, std::size_t runs) {
    need(varied, "varied");
    check_pointer(values, "values");
    const std::size_t most = std::numeric_limits<std::size_t>::max() / sizeof(double);
    for (const std::size_t width : {varied_count, summary_table().size()})
        if (runs > 0 && width > most / runs)
            throw Error(ARM3R_E_SIZE, "runs is " + std::to_string(runs) + ": no array is as long");
    return {params_in(params, count), {varied, varied_count}, {values, varied_count * runs}, runs};
}

}  // namespace

size_t arm3r_summary_count(void) { return summary_table().size(); }

int32_t arm3r_summary_column(size_t index, const char** name, const char** unit, const char** meaning) {
    return guard([&] {
        need(name, "name");
        need(unit, "unit");
        need(meaning, "meaning");
        check_index(index, summary_table().size(), "column");
        const SummaryNumber& number = summary_table()[index];
        *name = number.name.data();
        *unit = number.unit.data();
        *meaning = number.meaning.data();
    });
}

int32_t arm3r_batch_run(const double* params, size_t count, const size_t* varied, size_t varied_count,
                        const double* values, size_t runs, const arm3r_batch_options* options, double* results) {
    return guard([&] {
        const Variation variation = variation_in(params, count, varied, varied_count, values, runs);
        check_pointer(results, "results");
        if (is<"controller.type", "user">(variation.params)) refuse_missing_law();
        run_batch(variation, batch_options_in(options), results);
    });
}

int32_t arm3r_batch_control(const double* params, size_t count, const size_t* varied, size_t varied_count,
                            const double* values, size_t runs, const arm3r_batch_law* law,
                            const arm3r_batch_options* options, double* results) {
    return guard([&] {
        const Variation variation = variation_in(params, count, varied, varied_count, values, runs);
        check_pointer(results, "results");
        need(law, "law");
        refuse_other_controllers(variation.params);
        BatchOptions chosen = batch_options_in(options);
        chosen.law = batch_law_in(*law);
        run_batch(variation, chosen, results);
    });
}

// Many runs through the C interface.

#include <limits>
#include <optional>

#include "api/c_api.hpp"
#include "batch/batch.hpp"
#include "batch/simulation.hpp"
#include "record/metrics.hpp"
#include "schema/columns.hpp"
#include "schema/param_access.hpp"
#include "schema/schema.hpp"

using namespace arm3r;

namespace {

constexpr std::size_t most_doubles = std::numeric_limits<std::size_t>::max() / sizeof(double);

// Throws Error ARM3R_E_SIZE: no array holds so many numbers for each run.
void check_size(std::size_t runs, std::size_t width) {
    if (runs > 0 && width > most_doubles / runs)
        throw Error(ARM3R_E_SIZE, "runs is " + std::to_string(runs) + ": no array is as long");
}

std::span<const std::size_t> columns_in(const std::size_t* columns, std::size_t count) {
    need(columns, "columns");
    for (std::size_t i = 0; i < count; ++i) check_index(columns[i], column_count, "column");
    return {columns, count};
}

std::optional<BatchRows> rows_in(const arm3r_batch_rows* given, std::size_t runs) {
    if (!given) return {};
    const arm3r_batch_rows rows = struct_in(given, "arm3r_batch_rows");
    check_pointer(rows.data, "rows.data");
    check_size(rows.column_count, rows.row_count);
    check_size(runs, rows.column_count * rows.row_count);
    return BatchRows{columns_in(rows.columns, rows.column_count), rows.row_count, rows.data};
}

// The columns of the results that are wanted, of the table of summaries.
std::optional<std::span<const std::size_t>> summary_in(const arm3r_batch_options& options) {
    if (!options.summary) return {};
    for (std::size_t i = 0; i < options.summary_size; ++i)
        check_index(options.summary[i], summary_table().size(), "column");
    return std::span{options.summary, options.summary_size};
}

BatchOptions batch_options_in(const arm3r_batch_options* given, std::size_t runs) {
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
    return {options.stop,       options.progress, options.user,
            options.threads,    options.lanes,    rows_in(options.rows, runs),
            summary_in(options)};
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
    for (const std::size_t width : {varied_count, summary_table().size()}) check_size(runs, width);
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
        run_batch(variation, batch_options_in(options, runs), results);
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
        BatchOptions chosen = batch_options_in(options, runs);
        chosen.law = batch_law_in(*law);
        run_batch(variation, chosen, results);
    });
}

int32_t arm3r_batch_row_count(const double* params, size_t count, const size_t* varied, size_t varied_count,
                              const double* values, size_t runs, const size_t* columns, size_t column_count,
                              size_t* row_count) {
    return guard([&] {
        const Variation variation = variation_in(params, count, varied, varied_count, values, runs);
        need(row_count, "row_count");
        check_variation(variation);
        *row_count = most_rows(variation, columns_in(columns, column_count));
    });
}

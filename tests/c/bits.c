/* Prints a hash of all that a scenario computes, to compare builds of the library: two builds that print the same lines
 * gave the same bits.
 *
 *     bits [--batch RUNS] SCENARIO.yaml...
 *
 * The first line is "# version | compiler and flags"; each scenario then has a line "name hash", and with --batch the hash
 * of a batch behind it. A hash is FNV-1a with 64 bits over, in this order:
 *
 *   run    each column of the run, as doubles; each event, as it lies in an arm3r_event; the JSON summary and the report,
 *          both without the line that says how long the run took
 *   batch  the table of RUNS runs, as arm3r_batch_run writes it. Run i of number j has value + k/2^20 (an angle at the start)
 *          or value*(1 + k/2^20) (a stiffness), where k is random in [-2^14, 2^14): exact to one rounding
 *
 * compare_bits.py compares the lines of several builds.
 */

#include <arm3r/arm3r.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    const char *name;
    int relative; /* 1: the random part is a fraction of the value */
} varied_number;

static const varied_number varied_numbers[] = {
    {"initial.q[0]", 0},
    {"initial.q[1]", 0},
    {"initial.q[2]", 0},
    {"wall.contact.stiffness[0]", 1},
};

enum { most_varied = sizeof varied_numbers / sizeof *varied_numbers };

static void require(int32_t status, const char *what) {
    if (status == ARM3R_OK) return;
    fprintf(stderr, "bits: %s: %s\n", what, arm3r_error_message());
    exit(1);
}

static void *memory(size_t size) {
    void *block = malloc(size);
    if (!block) fprintf(stderr, "bits: there is not enough memory\n"), exit(1);
    return block;
}

/* ---- the hash */

static uint64_t add_bytes(uint64_t hash, const void *data, size_t size) {
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * UINT64_C(1099511628211);
    return hash;
}

static const uint64_t empty_hash = UINT64_C(14695981039346656037);

/* The text without the one line that holds `word`. */
static uint64_t add_text_without_line(uint64_t hash, const char *text, const char *word) {
    const char *place = strstr(text, word), *start = place, *end;
    if (!place) return add_bytes(hash, text, strlen(text));
    while (start > text && start[-1] != '\n') --start;
    end = strchr(place, '\n');
    hash = add_bytes(hash, text, (size_t)(start - text));
    return end ? add_bytes(hash, end + 1, strlen(end + 1)) : hash;
}

static uint64_t run_hash(const arm3r_run *run) {
    uint64_t hash = empty_hash;
    size_t rows, columns, events;
    const char *name, *unit, *text;
    const double *data;
    arm3r_event event;

    require(arm3r_run_shape(run, &rows, &columns), "shape");
    for (size_t i = 0; i < columns; ++i) {
        require(arm3r_run_column(run, i, &name, &unit, &data), "column");
        hash = add_bytes(hash, data, rows * sizeof *data);
    }
    require(arm3r_run_event_count(run, &events), "events");
    for (size_t i = 0; i < events; ++i) {
        require(arm3r_run_event(run, i, &event), "event");
        hash = add_bytes(hash, &event, sizeof event);
    }
    require(arm3r_run_summary(run, &text), "summary");
    hash = add_text_without_line(hash, text, "\"elapsed_s\": ");
    require(arm3r_run_report(run, &text), "report");
    return add_text_without_line(hash, text, "  wall clock ");
}

/* ---- the batch */

/* splitmix64: the next of a sequence of random numbers with 64 bits. */
static uint64_t next_random(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

/* Random values around the scenario's, where it gives one; returns how many numbers vary. */
static size_t draw_values(const double *params, size_t runs, size_t *varied, double *values) {
    uint64_t state = 1;
    size_t count = 0;
    for (size_t j = 0; j < most_varied; ++j) {
        const varied_number *number = &varied_numbers[j];
        size_t index;
        require(arm3r_param_index(number->name, strlen(number->name), &index), number->name);
        if (!isfinite(params[index])) continue;
        for (size_t i = 0; i < runs; ++i) {
            const double part = ((double)(next_random(&state) >> 49) - 16384) / 1048576;
            values[count * runs + i] = number->relative ? params[index] * (1 + part) : params[index] + part;
        }
        varied[count++] = index;
    }
    return count;
}

static uint64_t batch_hash(const arm3r_scenario *scenario, size_t runs) {
    const size_t count = arm3r_param_count(), size = arm3r_summary_count() * runs;
    double *params = memory(count * sizeof *params), *results = memory(size * sizeof *results);
    double *values = memory(most_varied * runs * sizeof *values);
    size_t varied[most_varied];
    uint64_t hash;

    require(arm3r_scenario_params(scenario, params, count), "params");
    const size_t varied_count = draw_values(params, runs, varied, values);
    require(arm3r_batch_run(params, count, varied, varied_count, values, runs, NULL, results), "batch");
    hash = add_bytes(empty_hash, results, size * sizeof *results);
    free(values), free(results), free(params);
    return hash;
}

/* ---- the program */

static void print_scenario(const char *path, size_t runs) {
    arm3r_scenario *scenario;
    arm3r_run *run;
    const char *name;

    require(arm3r_scenario_load(path, strlen(path), &scenario), path);
    require(arm3r_scenario_name(scenario, &name), path);
    require(arm3r_scenario_run(scenario, NULL, &run), path);
    printf("%s %016llx", name, (unsigned long long)run_hash(run));
    if (runs) printf(" %016llx", (unsigned long long)batch_hash(scenario, runs));
    printf("\n");
    fflush(stdout);
    arm3r_run_free(run);
    arm3r_scenario_free(scenario);
}

int main(int count, char **words) {
    int first = 1;
    size_t runs = 0;
    if (count > 2 && strcmp(words[1], "--batch") == 0) {
        runs = (size_t)strtoul(words[2], NULL, 10);
        first = 3;
    }
    if (first == count || (first == 3 && !runs)) {
        fprintf(stderr, "usage: bits [--batch RUNS] SCENARIO.yaml...\n");
        return 2;
    }
    printf("# %s | %s\n", arm3r_version(), arm3r_build_info());
    for (int i = first; i < count; ++i) print_scenario(words[i], runs);
    return 0;
}

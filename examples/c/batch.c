/* A thousand walls from soft to stiff that hit the arm: their largest forces, computed on all cores. */

#include <arm3r/arm3r.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { runs = 1000 };

static int failed(void) {
    fprintf(stderr, "%s\n", arm3r_error_message());
    return 1;
}

int main(void) {
    static const char text[] =
        "format: 1\n"
        "wall: {point: [1.9, 0, 0], contact: {stiffness: 1000}, motion: {type: constant, velocity: 0.5}, "
        "acts_on_arm: true}\n"
        "controller: {type: gravity_compensation}\n"
        "time: {stop: 1}\n";
    static const char varied[] = "wall.contact.stiffness";
    static double params[1024], stiffness[runs];
    const size_t count = arm3r_param_count(), columns = arm3r_summary_count();
    double* results = malloc(columns * runs * sizeof *results);
    const char *name, *unit, *meaning;
    arm3r_scenario* scenario = NULL;
    size_t place, i;

    if (results == NULL || count > sizeof params / sizeof *params) return 1;
    for (i = 0; i < runs; ++i) stiffness[i] = 100 * pow(10, 3.0 * (double)i / (runs - 1)); /* N/m: 100 to 1e5 */
    if (arm3r_scenario_create(text, strlen(text), "hit.yaml", strlen("hit.yaml"), &scenario)) return failed();
    if (arm3r_scenario_params(scenario, params, count)) return failed();
    if (arm3r_param_index(varied, strlen(varied), &place)) return failed();
    if (arm3r_batch_run(params, count, &place, 1, stiffness, runs, NULL, results)) return failed();
    for (i = 0; i < columns; ++i) {
        if (arm3r_summary_column(i, &name, &unit, &meaning)) return failed();
        if (strcmp(name, "peak_force") == 0)
            printf("%s: %.4g to %.4g %s\n", name, results[i * runs], results[(i + 1) * runs - 1], unit);
    }
    arm3r_scenario_free(scenario);
    free(results);
    return 0;
}

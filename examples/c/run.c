/* A scenario from text, its run, and a column of its rows. */

#include <arm3r/arm3r.h>
#include <stdio.h>
#include <string.h>

static int failed(void) {
    fprintf(stderr, "%s\n", arm3r_error_message());
    return 1;
}

int main(void) {
    static const char text[] =
        "format: 1\n"
        "wall: {contact: {stiffness: 1000}, motion: {type: constant, velocity: 0.5}, acts_on_arm: true}\n"
        "controller: {type: gravity_compensation}\n"
        "time: {stop: 1}\n";
    arm3r_scenario* scenario = NULL;
    arm3r_run* run = NULL;
    const char *name, *unit, *report;
    const double* t;
    size_t rows, columns;

    if (arm3r_scenario_create(text, strlen(text), "pushed.yaml", strlen("pushed.yaml"), &scenario)) return failed();
    if (arm3r_scenario_run(scenario, NULL, &run)) return failed();
    if (arm3r_run_shape(run, &rows, &columns)) return failed();
    if (arm3r_run_column(run, 0, &name, &unit, &t)) return failed();
    if (arm3r_run_report(run, &report)) return failed();
    printf("%zu rows of %zu columns; the last has %s = %g %s\n", rows, columns, name, t[rows - 1], unit);
    fputs(report, stderr);
    arm3r_run_free(run);
    arm3r_scenario_free(scenario);
    return 0;
}

/* A control law in C: the arm holds its weight, presses with 20 N along x on a wall, and keeps its height by a spring. */

#include <arm3r/arm3r.h>
#include <stdio.h>
#include <string.h>

static int failed(void) {
    fprintf(stderr, "%s\n", arm3r_error_message());
    return 1;
}

static int32_t press(void* user, const arm3r_law_state* state, double* tau) {
    const double f[3] = {*(const double*)user, -500 * state->tip[1], -500 * state->tip[2]}; /* N, on the wall */
    int i, k;
    for (i = 0; i < 3; ++i) {
        tau[i] = state->tau_g[i] - 5 * state->qd[i];
        for (k = 0; k < 3; ++k) tau[i] += state->jacobian[3 * k + i] * f[k]; /* J^T f */
    }
    return 0;
}

int main(void) {
    static const char text[] =
        "format: 1\n"
        "wall: {point: [1.75, 0, 0], motion: {type: fixed}, contact: {stiffness: 5000}, acts_on_arm: true}\n"
        "controller: {type: user}\n"
        "sampling: {rate: 1000}\n"
        "time: {stop: 3}\n";
    double force = 20;
    arm3r_scenario* scenario = NULL;
    arm3r_run* run = NULL;
    const char *name, *unit;
    const double* data;
    size_t rows, columns, i;

    if (arm3r_scenario_create(text, strlen(text), "press.yaml", strlen("press.yaml"), &scenario)) return failed();
    if (arm3r_scenario_control(scenario, press, &force, NULL, &run)) return failed();
    if (arm3r_run_shape(run, &rows, &columns)) return failed();
    for (i = 0; i < columns; ++i) {
        if (arm3r_run_column(run, i, &name, &unit, &data)) return failed();
        if (strcmp(name, "f_on_wall_x") == 0) printf("The wall feels %.2f %s in the end.\n", data[rows - 1], unit);
    }
    arm3r_run_free(run);
    arm3r_scenario_free(scenario);
    return 0;
}

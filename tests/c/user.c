/* What a C program sees of arm3r: read a scenario, run it, read a column; then the arm on its own. */

#include <arm3r/arm3r.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static int failed(const char *what) {
    fprintf(stderr, "%s: %s\n", what, arm3r_error_message());
    return 1;
}

static int simulate(void) {
    static const char text[] = "format: 1\ncontroller: {type: gravity_compensation}\ntime: {stop: 0.5}\n";
    arm3r_scenario *scenario = NULL;
    arm3r_run *run = NULL;
    const char *name, *unit, *summary;
    const double *t;
    size_t rows, columns;

    if (arm3r_scenario_create(text, strlen(text), "user.yaml", strlen("user.yaml"), &scenario)) return failed("create");
    if (arm3r_scenario_run(scenario, NULL, &run)) return failed("run");
    if (arm3r_run_shape(run, &rows, &columns)) return failed("shape");
    if (arm3r_run_column(run, 0, &name, &unit, &t)) return failed("column");
    if (arm3r_run_summary(run, &summary)) return failed("summary");
    printf("%s [%s]: %zu rows to %g\n%s\n", name, unit, rows, t[rows - 1], summary);
    arm3r_run_free(run);
    arm3r_scenario_free(scenario);
    return !(rows == 51 && t[rows - 1] == 0.5);
}

static int place(void) {
    const double q[6] = {0, 0, 0, 0, 0, 0};
    double tip[6], params[1024];
    size_t count = arm3r_param_count();
    arm3r_arm *arm = NULL;

    if (count > sizeof params / sizeof *params) return failed("more parameters than expected");
    if (arm3r_param_defaults(params, count)) return failed("defaults");
    if (arm3r_arm_create(params, count, &arm)) return failed("arm");
    if (arm3r_arm_tip_position(arm, 2, q, tip)) return failed("tip");
    arm3r_arm_free(arm);
    return !(tip[3] == 2 && tip[4] == 0 && tip[5] == 0);
}

int main(void) {
    printf("arm3r %s (%s)\n", arm3r_version(), arm3r_build_info());
    return simulate() || place();
}

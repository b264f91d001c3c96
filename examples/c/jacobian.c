/* A Jacobian written by hand, for equal links of 1 m and the right-hand angles of the slide, beside that of the library. */

#include <arm3r/arm3r.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static int failed(void) {
    fprintf(stderr, "%s\n", arm3r_error_message());
    return 1;
}

static void by_hand(const double q[3], double J[9]) {
    const double s1 = sin(q[0]), c1 = cos(q[0]), s2 = sin(q[1]), c2 = cos(q[1]), s23 = sin(q[1] + q[2]),
                 c23 = cos(q[1] + q[2]);
    const double own[9] = {
        -s1 * (c2 + c23), -c1 * (s2 + s23), -c1 * s23, c1 * (c2 + c23), -s1 * (s2 + s23), -s1 * s23, 0, c2 + c23, c23};
    memcpy(J, own, sizeof own);
}

int main(void) {
    static const char text[] = "{format: 1, arm: {convention: slide}}";
    const double q[3] = {0.3, 0.7, -1.1};
    double params[1024], J[9], own[9], largest = 0;
    const size_t count = arm3r_param_count();
    arm3r_scenario* scenario = NULL;
    arm3r_arm* arm = NULL;
    int i;

    if (count > sizeof params / sizeof *params) return 1;
    if (arm3r_scenario_create(text, strlen(text), "slide", strlen("slide"), &scenario)) return failed();
    if (arm3r_scenario_params(scenario, params, count)) return failed();
    if (arm3r_arm_create(params, count, &arm)) return failed();
    if (arm3r_arm_jacobian(arm, 1, q, J)) return failed();
    by_hand(q, own);
    for (i = 0; i < 9; ++i) largest = fmax(largest, fabs(own[i] - J[i]));
    printf("The Jacobian by hand is %s.\n", largest < 1e-12 ? "right" : "wrong");
    arm3r_arm_free(arm);
    arm3r_scenario_free(scenario);
    return 0;
}

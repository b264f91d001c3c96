/* arm3r: dynamics, contact and simulation of a 3R spatial arm. The C interface.
 *
 * The public API is what this header declares; it is also, word for word, what the Python package reads.
 *
 * Units are SI and radians. Joint vectors (q, qd, qdd, tau) follow the arm's convention, vectors in space are in base axes.
 * Arrays are row-major; `n` states in give `n` results out. Every pointer is non-null unless marked Nullable.
 * Text comes in as pointer and length, in UTF-8, without need of a terminator. Text that goes out is zero-terminated,
 * belongs to the object it came from and lives as long as that object, or until the same function is called on it again.
 * Functions return ARM3R_OK or a negative arm3r_status; the reason is then in arm3r_error_message() of the same thread.
 * A handle may be read by several threads at once; calls that change it must not overlap. Use after free is undefined.
 * A function that the library calls back may end its thread (pthread_exit). An exception of C++ that leaves it makes the call
 * fail with ARM3R_E_CALLBACK. It must not leave by longjmp: destructors would not run.
 * The caller's floating-point environment (rounding mode, traps, subnormal numbers) is neither used nor changed.
 */
#ifndef ARM3R_H
#define ARM3R_H

#ifndef ARM3R_CDEF
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif
#ifndef ARM3R_API
#ifdef __GNUC__
#define ARM3R_API __attribute__((visibility("default")))
#else
#define ARM3R_API
#endif
#endif
#endif

/* ---- version ------------------------------------------------------------------------------------------------- */

enum { ARM3R_ABI = 1 }; /* changes when an old caller could no longer work */

ARM3R_API int32_t arm3r_abi_version(void);     /* the library's ARM3R_ABI */
ARM3R_API const char *arm3r_version(void);     /* "0.1.0" */
ARM3R_API const char *arm3r_build_info(void);  /* compiler and flags, one line */

/* ---- errors --------------------------------------------------------------------------------------------------- */

typedef enum arm3r_status {
    ARM3R_OK = 0,
    ARM3R_E_NULL = -101,       /* a pointer that must not be null is null */
    ARM3R_E_SIZE = -102,       /* an array or buffer has the wrong length */
    ARM3R_E_INDEX = -103,      /* no parameter, column or event with this index or name */
    ARM3R_E_VALUE = -104,      /* a number is not finite or outside the range of the function */
    ARM3R_E_REACH = -105,      /* inverse kinematics: the point is out of reach */
    ARM3R_E_SINGULAR = -106,   /* the pose is singular for this function */
    ARM3R_E_OVERLAP = -107,    /* input and output arrays overlap */
    ARM3R_E_BUSY = -108,       /* the handle is in use by another call */
    ARM3R_E_FILE = -109,       /* a file cannot be read */
    ARM3R_E_OVER = -110,       /* the simulation is over */
    ARM3R_E_SCENARIO = -201,   /* the scenario is not valid */
    ARM3R_E_SIZE_CAP = -401,   /* the run would need more rows, steps or memory than allowed */
    ARM3R_E_MEMORY = -402,     /* out of memory */
    ARM3R_E_OUTPUT = -501,     /* a result cannot be written */
    ARM3R_E_CALLBACK = -601,   /* a callback asked to stop by a negative value */
    ARM3R_E_ABI = -701,        /* struct of an unknown size, or a reserved field that is not zero */
    ARM3R_E_FORMAT = -702,     /* the scenario is written for another format version */
    ARM3R_E_INTERNAL = -901    /* a bug in arm3r */
} arm3r_status;

/* The last failure of this thread; "" after none. Valid until the next failing call of this thread. */
ARM3R_API const char *arm3r_error_message(void);
/* The same as JSON: {"status", "code", "message", "problems": [{code, message, file, line, column, path, got, allowed, hint}]}. */
ARM3R_API const char *arm3r_error_json(void);

/* ---- how a run ended ------------------------------------------------------------------------------------------ */

typedef enum arm3r_outcome {
    ARM3R_RUN_OK = 0,
    ARM3R_RUN_STOPPED = 1,         /* the stop flag or the progress function asked for it */
    ARM3R_RUN_DIVERGED = 2,        /* a state is not finite, or an angle beyond 1e5 rad */
    ARM3R_RUN_STEP_COLLAPSE = 3,   /* the step size fell below what the clock can resolve */
    ARM3R_RUN_EVENT_STORM = 4,     /* more than 4096 contact events */
    ARM3R_RUN_ILL_CONDITIONED = 5, /* the mass matrix lost its positive definiteness */
    ARM3R_RUN_ENERGY = 6,          /* the energy balance does not close */
    ARM3R_RUN_BUDGET = 7,          /* max_steps or the time limit is used up */
    ARM3R_RUN_INVALID = 8,         /* of one run among many: its parameters are not valid, it was not begun */
    ARM3R_RUN_CONTROLLER = 9       /* the user's controller gave no torque that can be applied */
} arm3r_outcome;

ARM3R_API const char *arm3r_outcome_name(int32_t outcome); /* "ok", "stopped", ...; "" for an unknown value */

/* Writes the place in `words` of the one that `word` is most likely a slip for, by the rule of all messages; -1: none is
 * near. */
ARM3R_API int32_t arm3r_nearest_word(const char *word, const char *const *words, size_t n_words, int64_t *place);

/* ---- numbers: parameters ------------------------------------------------------------------------------------------
 * A scenario is a flat array of arm3r_param_count() doubles. A key of the scenario file with one number has the key's
 * path as its name, "wall.contact.stiffness"; one with several has "initial.q[0]", "initial.q[1]", ... A choice is stored as
 * the index of its word, a column as its place in arm3r_columns_text, a flag as 0 or 1, and NaN means "not given": the value
 * then follows from others. A table whose lists are longer than its keys have places (arm3r_scenario_param_count) has each of
 * them behind the array: the index of its key's first number, its length, its numbers; those of the key are NaN then.
 */

ARM3R_API size_t arm3r_param_count(void);
ARM3R_API int32_t arm3r_param_index(const char *name, size_t name_size, size_t *index);
ARM3R_API int32_t arm3r_param_name(size_t index, const char **name);
/* The key that a number belongs to; what it is: "number", "angle", "integer", "flag", "choice", "section", "column" or "file"; its
 * unit, "" for none. */
ARM3R_API int32_t arm3r_param_key(size_t index, const char **key, const char **kind, const char **unit);
ARM3R_API int32_t arm3r_param_defaults(double *params, size_t count); /* the lecture's arm, at rest, no wall, no control */

/* ---- numbers: the arm --------------------------------------------------------------------------------------------- */

typedef struct arm3r_arm arm3r_arm;

ARM3R_API int32_t arm3r_arm_create(const double *params, size_t count, arm3r_arm **arm);
ARM3R_API void arm3r_arm_free(arm3r_arm *arm); /* Nullable */

/*                                               per state:   in                                       out                */
ARM3R_API int32_t arm3r_arm_tip_position(const arm3r_arm *arm, size_t n, const double *q, double *tip);      /* 3 -> 3, m */
ARM3R_API int32_t arm3r_arm_elbow_position(const arm3r_arm *arm, size_t n, const double *q, double *elbow);  /* 3 -> 3, m */
/* The points that the arm is drawn through, scenario axes: that of axis 1 nearest to the origin, that at the height of joint 2,
 * joint 2, the end of link 2 in its plane, joint 3, the end of link 3 in its plane, the tip; of a planar arm some coincide. */
ARM3R_API int32_t arm3r_arm_points(const arm3r_arm *arm, size_t n, const double *q, double *points);          /* 3 -> 7x3, m */
/* The largest distance of the tip from the point of axis 1 at the height of joint 2, or a little more, m. */
ARM3R_API int32_t arm3r_arm_reach(const arm3r_arm *arm, double *reach);
ARM3R_API int32_t arm3r_arm_centres(const arm3r_arm *arm, size_t n, const double *q, double *centres);       /* 3 -> 3x3, m: a row a link */
ARM3R_API int32_t arm3r_arm_jacobian(const arm3r_arm *arm, size_t n, const double *q, double *jacobian);     /* 3 -> 3x3, m */
ARM3R_API int32_t arm3r_arm_geometric_jacobian(const arm3r_arm *arm, size_t n, const double *q, double *jacobian); /* 3 -> 6x3, linear rows first */
ARM3R_API int32_t arm3r_arm_jacobian_dot(const arm3r_arm *arm, size_t n, const double *q, const double *qd, double *jacobian_dot); /* 3, 3 -> 3x3, m/s */
ARM3R_API int32_t arm3r_arm_mass_matrix(const arm3r_arm *arm, size_t n, const double *q, double *mass);      /* 3 -> 3x3, kg m^2, armature included */
ARM3R_API int32_t arm3r_arm_coriolis_matrix(const arm3r_arm *arm, size_t n, const double *q, const double *qd, double *coriolis); /* 3, 3 -> 3x3, Christoffel */
ARM3R_API int32_t arm3r_arm_velocity_product(const arm3r_arm *arm, size_t n, const double *q, const double *qd, double *product); /* 3, 3 -> 3, N m: C qd */
ARM3R_API int32_t arm3r_arm_gravity_torque(const arm3r_arm *arm, size_t n, const double *q, double *tau_g);  /* 3 -> 3, N m: what holds the arm */
ARM3R_API int32_t arm3r_arm_operational_space_inertia(const arm3r_arm *arm, size_t n, const double *q, double *lambda); /* 3 -> 3x3, kg */
ARM3R_API int32_t arm3r_arm_effective_mass(const arm3r_arm *arm, size_t n, const double *q, const double *direction, double *mass); /* 3, 3 (any length) -> 1, kg */
ARM3R_API int32_t arm3r_arm_manipulability(const arm3r_arm *arm, size_t n, const double *q, double *manipulability); /* 3 -> 1, m^3: |det J| */
ARM3R_API int32_t arm3r_arm_energy(const arm3r_arm *arm, size_t n, const double *q, const double *qd, double *kinetic, double *potential); /* 3, 3 -> 1, 1, J */
ARM3R_API int32_t arm3r_arm_forward_dynamics(const arm3r_arm *arm, size_t n, const double *q, const double *qd, const double *tau,
                                             const double *f_on_tip /* Nullable */, double *qdd); /* 3, 3, 3, 3 -> 3, rad/s^2 */
ARM3R_API int32_t arm3r_arm_inverse_dynamics(const arm3r_arm *arm, size_t n, const double *q, const double *qd, const double *qdd,
                                             const double *f_on_tip /* Nullable */, double *tau); /* 3, 3, 3, 3 -> 3, N m */
/* The derivatives of both, exact to rounding: 3x3 each, a row for each component of the result. The force on the tip is constant. */
ARM3R_API int32_t arm3r_arm_forward_dynamics_derivatives(const arm3r_arm *arm, size_t n, const double *q, const double *qd, const double *tau,
                                                         const double *f_on_tip /* Nullable */, double *qdd_by_q, double *qdd_by_qd,
                                                         double *qdd_by_tau /* the inverse of the mass matrix */);
ARM3R_API int32_t arm3r_arm_inverse_dynamics_derivatives(const arm3r_arm *arm, size_t n, const double *q, const double *qd, const double *qdd,
                                                         const double *f_on_tip /* Nullable */, double *tau_by_q, double *tau_by_qd,
                                                         double *tau_by_qdd /* the mass matrix */);
/* The independent Newton-Euler recursion on rotation matrices: the transform sensor, and the check of the closed form. */
ARM3R_API int32_t arm3r_arm_recursion_inverse_dynamics(const arm3r_arm *arm, size_t n, const double *q, const double *qd, const double *qdd,
                                                       const double *f_on_tip /* Nullable */, double *tau); /* as arm3r_arm_inverse_dynamics */
ARM3R_API int32_t arm3r_arm_recursion_forward_dynamics(const arm3r_arm *arm, size_t n, const double *q, const double *qd, const double *tau,
                                                       const double *f_on_tip /* Nullable */, double *qdd); /* as arm3r_arm_forward_dynamics */
ARM3R_API int32_t arm3r_arm_tip_sensor(const arm3r_arm *arm, size_t n, const double *q, const double *qd, double *position, double *velocity); /* 3, 3 -> 3, 3 */
/* front: 1 joint 1 faces the point, 0 it faces away; elbow_up: 1 the elbow lies above the line from shoulder to tip.
 * On ARM3R_E_REACH, *failed (Nullable) is the first index out of reach and nothing is written. */
ARM3R_API int32_t arm3r_arm_inverse_kinematics(const arm3r_arm *arm, size_t n, const double *tip, int32_t front, int32_t elbow_up,
                                               double *q, size_t *failed /* Nullable */); /* 3 -> 3, rad */

/* ---- numbers: a run ------------------------------------------------------------------------------------------------ */

typedef struct arm3r_run arm3r_run;

/* Called at most every 20 ms, from the thread of the run. t: simulated time, s; stop: where it will end, s; steps so far.
 * Returns 0 to go on; > 0 ends the run as `stopped`; < 0 makes the call fail with ARM3R_E_CALLBACK. */
typedef int32_t (*arm3r_progress)(void *user, double t, double stop, int64_t steps);

typedef struct arm3r_run_options {
    size_t struct_size;             /* sizeof(arm3r_run_options) */
    const volatile int32_t *stop;   /* Nullable: the run ends as `stopped` soon after *stop is not 0 */
    arm3r_progress progress;        /* Nullable */
    void *user;                     /* Nullable: handed to progress */
    double time_limit;              /* s of wall clock; 0: none. Beyond it the outcome is `budget` */
    int64_t trust;                  /* 1: the summary also says up to when the joint angles are right to 1e-6 rad, from three
                                       more runs, each within time_limit; 0: it does not. Not with a law of your own */
    int64_t reserved[3];            /* 0 */
} arm3r_run_options;

typedef struct arm3r_event {
    int32_t type;                   /* 0 make, 1 break */
    int32_t reserved;
    double t;                       /* s */
    double q[3], qd[3];             /* rad, rad/s */
    double tip[3];                  /* m */
} arm3r_event;

/* Simulate. ARM3R_OK means that there is a run to read, whatever its outcome. */
ARM3R_API int32_t arm3r_params_run(const double *params, size_t count, const arm3r_run_options *options /* Nullable */, arm3r_run **run);
ARM3R_API void arm3r_run_free(arm3r_run *run); /* Nullable */

ARM3R_API int32_t arm3r_run_outcome(const arm3r_run *run, int32_t *outcome);
ARM3R_API int32_t arm3r_run_shape(const arm3r_run *run, size_t *rows, size_t *columns);
/* Column `index`: `rows` doubles, contiguous, alive until the run is freed. */
ARM3R_API int32_t arm3r_run_column(const arm3r_run *run, size_t index, const char **name, const char **unit, const double **data);
ARM3R_API int32_t arm3r_run_event_count(const arm3r_run *run, size_t *count);
ARM3R_API int32_t arm3r_run_event(const arm3r_run *run, size_t index, arm3r_event *event);

/* ---- numbers: a control law of your own ------------------------------------------------------------------------------
 * For scenarios with controller.type: user. It is called at t = time.start + tick/sampling.rate only, in increasing time, and never twice
 * for one; its torque is held until the next, within arm.torque_limit.
 */

/* The input of the law: the values that the scenario's sensors measure (the true ones without sensors), and functions of them. */
typedef struct arm3r_law_state {
    size_t struct_size;             /* of the library's own version of this struct */
    double tick;                    /* samples before this one */
    double t, period;               /* s */
    double q[3], qd[3];             /* rad, rad/s */
    double tip[3], tip_velocity[3]; /* m, m/s: at this q, qd */
    double jacobian[9];             /* m, row-major: tip_velocity = jacobian qd */
    double tau_g[3];                /* N m: what holds the arm at this q */
    double f_on_tip[3];             /* N */
    double contact;                 /* 1 after this force has exceeded 1 N until it falls below 0.5 N; else 0 */
    double wall_normal[3];          /* unit, from the wall towards the arm; this and the next two 0 without a wall */
    double wall_point[3];           /* m, of the face */
    double wall_velocity[3];        /* m/s, of the frame's origin */
    double residual[3];             /* N m: the observer's external torque; this and the next 0 without one */
    double collision;               /* 1 from the start of a detected collision to its end */
    double stiffness_estimate;      /* N/m, of the wall; this and the next two 0 without an estimator */
    double wall_speed_estimate;     /* m/s */
    double identifiable;            /* 1 where the data determine both */
    double q_true[3], qd_true[3], f_on_tip_true[3]; /* the true state, without sensor errors */
    double stiffness_sigma;         /* N/m, standard deviation of stiffness_estimate; 0 where it is not identifiable */
} arm3r_law_state;

/* Writes three torques, N m. Not 0, or a torque that is not finite or beyond 1e12: the run ends as `controller`. The state is
 * valid during the call. The handle of a simulation in progress may not be used from within. */
typedef int32_t (*arm3r_law)(void *user, const arm3r_law_state *state, double *tau);

/* As arm3r_params_run, with the law; `user` is handed to it. */
ARM3R_API int32_t arm3r_params_control(const double *params, size_t count, arm3r_law law, void *user /* Nullable */,
                                       const arm3r_run_options *options /* Nullable */, arm3r_run **run);

/* ---- numbers: many runs -------------------------------------------------------------------------------------------- */

/* Memory for the rows of the runs of a batch: chosen columns at the instants that each run logs, with the same bits as in the
 * log of that run alone. */
typedef struct arm3r_batch_rows {
    size_t struct_size;             /* sizeof(arm3r_batch_rows) */
    const size_t *columns;          /* places in arm3r_columns_text, whatever time.log_columns chooses */
    size_t column_count;
    size_t row_count;               /* of each run at most: arm3r_batch_row_count says how many are needed */
    double *data;                   /* row k of column j of run i: data[(i*column_count + j)*row_count + k]. NaN after the last row
                                       of a run, which may end early, and where a run has no such column */
    int64_t reserved[4];            /* 0 */
} arm3r_batch_rows;

/* Called at most every 20 ms, from the calling thread. Answers as arm3r_progress. */
typedef int32_t (*arm3r_batch_progress)(void *user, int64_t runs_done, int64_t runs);

typedef struct arm3r_batch_options {
    size_t struct_size;             /* sizeof(arm3r_batch_options) */
    const volatile int32_t *stop;   /* Nullable: runs not yet ended end as `stopped` soon after *stop is not 0 */
    arm3r_batch_progress progress;  /* Nullable */
    void *user;                     /* Nullable: handed to progress */
    int32_t threads;                /* 0: as many as the CPUs that this process may use */
    int32_t lanes;                  /* runs that a thread computes in parallel, at most: 1, 2, 4 or 8; 0: as is fastest. Never changes a result */
    const arm3r_batch_rows *rows;   /* Nullable: no rows */
    const size_t *summary;          /* Nullable: all. Else `results` has these columns alone, of arm3r_summary_column; a metric
                                       of the controller's performance that is not among them is not computed */
    size_t summary_size;            /* how many; not read where summary is null */
    int64_t reserved[1];            /* 0 */
} arm3r_batch_options;

ARM3R_API size_t arm3r_summary_count(void); /* columns of a batch's table */
ARM3R_API int32_t arm3r_summary_column(size_t index, const char **name, const char **unit, const char **meaning);
/* `runs` runs: run i has params, but values[j*runs + i] in the place of number varied[j]. results: the columns of options->summary,
 * else all arm3r_summary_count() of them, `runs` numbers each, one column after the other; NaN where a run has no such number. Row i
 * has the same bits as the summary of a run of its own. ARM3R_OK whatever the outcomes. Numbers that stand for a choice, a flag or a
 * section cannot vary. */
ARM3R_API int32_t arm3r_batch_run(const double *params, size_t count, const size_t *varied, size_t varied_count, const double *values, size_t runs,
                                  const arm3r_batch_options *options /* Nullable */, double *results);

/* The most rows that one of these runs can have; runs that are not valid have none. ARM3R_E_SCENARIO: none of the valid ones
 * has one of these columns. ARM3R_E_SIZE_CAP: a run has too many rows. */
ARM3R_API int32_t arm3r_batch_row_count(const double *params, size_t count, const size_t *varied, size_t varied_count, const double *values, size_t runs,
                                        const size_t *columns, size_t column_count, size_t *row_count);

/* A law of your own for the runs of a batch. */
typedef struct arm3r_batch_law {
    size_t struct_size;             /* sizeof(arm3r_batch_law) */
    arm3r_law function;
    void *user;                     /* Nullable: run i hands user + i*user_stride to the law */
    size_t user_stride;             /* bytes; 0: all runs hand it the same */
    int64_t reentrant;              /* 1: several threads may call it at the same time, each for a run of its own;
                                       0: only the calling thread calls it, for one run after the other */
    int64_t reserved[4];            /* 0 */
} arm3r_batch_law;

/* As arm3r_batch_run, with the law; row i has the same bits as the summary of arm3r_params_control. A run whose law did not
 * return 0 has the outcome `controller`. */
ARM3R_API int32_t arm3r_batch_control(const double *params, size_t count, const size_t *varied, size_t varied_count, const double *values, size_t runs,
                                      const arm3r_batch_law *law, const arm3r_batch_options *options /* Nullable */, double *results);

/* ---- text: scenarios ----------------------------------------------------------------------------------------------- */

typedef struct arm3r_scenario arm3r_scenario;

/* Reads the file of arm.urdf. request: JSON, an object with `urdf`, `joints`, `lock`, `tip`, `axis_tolerance` as the scenario has
 * them (numbers as text), the `folder` of the scenario where it is in one, and the keys `given` beside them, without `arm.`.
 * Returns 0 with the keys of an elbow arm as YAML, or another number with one sentence that says what is wrong. The text stays
 * until the thread calls the reader again. */
typedef int32_t (*arm3r_arm_reader)(void *user, const char *request, const char **text);
/* Sets the reader of all scenarios of the process; before, scenarios with arm.urdf are refused. */
ARM3R_API int32_t arm3r_set_arm_reader(arm3r_arm_reader reader, void *user /* Nullable */);

/* Read a scenario from text; `file` is the name used in messages and, without its suffix, the default of `name`. */
ARM3R_API int32_t arm3r_scenario_create(const char *text, size_t text_size, const char *file, size_t file_size, arm3r_scenario **scenario);
/* The same from a regular file, or from standard input when path is "-". */
ARM3R_API int32_t arm3r_scenario_load(const char *path, size_t path_size, arm3r_scenario **scenario);
ARM3R_API void arm3r_scenario_free(arm3r_scenario *scenario); /* Nullable */
ARM3R_API int32_t arm3r_scenario_copy(const arm3r_scenario *scenario, arm3r_scenario **copy);
/* Put a value (YAML, flow style) in place of what stands at a dotted path; list items by [i]. A new type, method or law drops
 * the keys of the old one. Nothing is validated before one of the functions below is called. */
ARM3R_API int32_t arm3r_scenario_set(arm3r_scenario *scenario, const char *path, size_t path_size, const char *value, size_t value_size);
/* The same; `file` is what messages and provenance call the place the value came from, e.g. "--set". */
ARM3R_API int32_t arm3r_scenario_set_from(arm3r_scenario *scenario, const char *path, size_t path_size, const char *value, size_t value_size,
                                          const char *file, size_t file_size);
ARM3R_API int32_t arm3r_scenario_validate(const arm3r_scenario *scenario);
/* The value at a path as JSON, defaults included; inf as "inf", an absent value as null. */
ARM3R_API int32_t arm3r_scenario_get(const arm3r_scenario *scenario, const char *path, size_t path_size, const char **json);
ARM3R_API int32_t arm3r_scenario_name(const arm3r_scenario *scenario, const char **name);
/* The whole scenario with all defaults, itself a scenario file; annotate 1: each value with its provenance in a comment. */
ARM3R_API int32_t arm3r_scenario_yaml(const arm3r_scenario *scenario, int32_t annotate, const char **yaml);
/* Warnings of what is allowed but probably a mistake, one a line: "FILE: warning: SENTENCE"; "" if there are none. */
ARM3R_API int32_t arm3r_scenario_warnings(const arm3r_scenario *scenario, const char **text);
/* How many numbers it has: arm3r_param_count(), and more for tables of more than 16 points. */
ARM3R_API int32_t arm3r_scenario_param_count(const arm3r_scenario *scenario, size_t *count);
ARM3R_API int32_t arm3r_scenario_params(const arm3r_scenario *scenario, double *params, size_t count);
ARM3R_API int32_t arm3r_scenario_run(const arm3r_scenario *scenario, const arm3r_run_options *options /* Nullable */, arm3r_run **run);

/* With a law of your own, as arm3r_params_control. */
ARM3R_API int32_t arm3r_scenario_control(const arm3r_scenario *scenario, arm3r_law law, void *user /* Nullable */,
                                         const arm3r_run_options *options /* Nullable */, arm3r_run **run);

/* ---- text: a run that you step yourself ---------------------------------------------------------------------------------
 * A simulation of a scenario with controller.type: user waits at a sample, until it is over: at time.stop, whose sample is
 * the last one, or where the run ended before. Given the same torques, it is bit for bit the run of arm3r_scenario_control.
 */

typedef struct arm3r_simulation arm3r_simulation;

ARM3R_API int32_t arm3r_simulation_create(const arm3r_scenario *scenario, arm3r_simulation **simulation);
ARM3R_API void arm3r_simulation_free(arm3r_simulation *simulation); /* Nullable */
ARM3R_API int32_t arm3r_simulation_is_over(const arm3r_simulation *simulation, int32_t *is_over);
/* The state that the law would get at this sample; after the end, the last one that it got. */
ARM3R_API int32_t arm3r_simulation_state(const arm3r_simulation *simulation, arm3r_law_state *state);
/* Apply three torques, N m, from this sample to the next. ARM3R_E_VALUE: not finite, beyond 1e12; nothing has happened.
 * ARM3R_E_OVER: there is no sample left. */
ARM3R_API int32_t arm3r_simulation_step(arm3r_simulation *simulation, const double *tau);
/* Both in one call: apply the torques, and write the state at the sample that follows and whether the simulation is over. */
ARM3R_API int32_t arm3r_simulation_advance(arm3r_simulation *simulation, const double *tau, arm3r_law_state *state, int32_t *is_over);
/* Copy a simulation in its present state, or restore the state of another one of the same scenario. It continues with the same bits. */
ARM3R_API int32_t arm3r_simulation_copy(const arm3r_simulation *simulation, arm3r_simulation **copy);
ARM3R_API int32_t arm3r_simulation_restore(arm3r_simulation *simulation, const arm3r_simulation *from);
/* The rows so far, as a run; its outcome is `stopped` where it is not over. */
ARM3R_API int32_t arm3r_simulation_run(const arm3r_simulation *simulation, arm3r_run **run);

/* YAML, read as strictly as a scenario, as JSON: what else is written in files stands on this reader. A node is an object with
 * line, column and one of: `map` (nodes, with key, key_line, key_column), `list` (nodes), `text` (with `quoted`, and `number` where
 * it is one; where not, `fault` says why; `degrees` is true of `VALUE deg`), `nothing`. The text stays until this thread asks again. */
ARM3R_API int32_t arm3r_yaml_json(const char *text, size_t text_size, const char *file, size_t file_size, const char **json);

/* A sweep's file, read by the table of its keys. json: an object with what they say, defaults included, numbers in SI, `scenario`
 * as the name of its file, and in each axis and statistic its place, `at`: "LINE:COLUMN"; it stays until this thread asks again.
 * scenario: the one that it names or holds, with the values of `set`, not yet validated. */
ARM3R_API int32_t arm3r_sweep_read(const char *text, size_t text_size, const char *file, size_t file_size, const char **json,
                                   arm3r_scenario **scenario);

/* ---- text: results ------------------------------------------------------------------------------------------------- */

ARM3R_API int32_t arm3r_run_summary(const arm3r_run *run, const char **json);   /* the JSON summary, one object */
ARM3R_API int32_t arm3r_run_report(const arm3r_run *run, const char **text);    /* the summary for people */
/* Warnings of the scenario and of what the run showed, one sentence a line; "" if there are none. */
ARM3R_API int32_t arm3r_run_warnings(const arm3r_run *run, const char **text);
ARM3R_API int32_t arm3r_run_checks(const arm3r_run *run, size_t *count, size_t *failed);
/* All columns at once: column i is (*data)[i*stride], `rows` doubles, alive until the run is freed; names: one after the other,
 * commas between them. */
ARM3R_API int32_t arm3r_run_block(const arm3r_run *run, const double **data, size_t *stride, const char **names);
/* CSV in pieces: the sink returns 0 to go on, anything else ends the call with ARM3R_E_OUTPUT. */
typedef int32_t (*arm3r_sink)(void *user, const char *data, size_t size);
ARM3R_API int32_t arm3r_run_csv(const arm3r_run *run, arm3r_sink sink, void *user /* Nullable */);
/* Write PATH and, beside it, the summary with the suffix .json: each whole or not at all. The ending of PATH says what is written:
 * .csv, or .npz, which numpy.load reads: an array for each column under its name, and the summary as summary.json.
 * ARM3R_E_VALUE: it has another ending. */
ARM3R_API int32_t arm3r_run_save(const arm3r_run *run, const char *path, size_t path_size);
/* Fail as arm3r_run_save would if it could not write there: to be asked before a long run. */
ARM3R_API int32_t arm3r_output_probe(const char *path, size_t path_size);
/* Where arm3r_run_save puts the summary that belongs to PATH; the text stays until this thread asks again. */
ARM3R_API int32_t arm3r_output_summary(const char *path, size_t path_size, const char **summary);

/* ---- text: reference ----------------------------------------------------------------------------------------------- */

ARM3R_API const char *arm3r_schema_json(void);     /* JSON Schema of the scenario file */
ARM3R_API const char *arm3r_sweep_schema_json(void); /* of a sweep's file */
ARM3R_API const char *arm3r_schema_markdown(void); /* the reference page of scenario keys */
ARM3R_API const char *arm3r_columns_text(void);    /* name, unit and meaning of every column, one a line */
ARM3R_API const char *arm3r_columns_markdown(void);
ARM3R_API const char *arm3r_template(void);        /* a commented scenario to start from */

#ifndef ARM3R_CDEF
#ifdef __cplusplus
}
#endif
#endif
#endif

/* What one would write by hand: RK4 for n arms in a plain loop that the compiler vectorises.
 * State: joint angle 1, the absolute angles of links 2 and 3, and their rates; component k of arm i is state[k*n + i]. */

#include <math.h>
#include <stddef.h>

struct arm {
    double A1, A2, A3, B2, B3, B, G2, G3, a2, a3; /* SI */
};

struct wall {
    double x, speed, stiffness; /* the plane x = const, coming towards the arm; a spring */
};

struct state {
    double q1, p2, p3, w1, w2, w3;
};

enum { block = 64 }; /* arms that stay in the first cache for all their steps */

/* GCC makes one call of sin and cos of an angle, which it then cannot vectorise. */
static inline double cosine(double x) { return sin(x + 1.5707963267948966); }

/* `weight`: acceleration of gravity that the links feel; `push`: force on the tip along x. */
static inline struct state rate(const struct arm *m, struct state y, double weight, double push) {
    const double c1 = cosine(y.q1), s1 = sin(y.q1);
    const double c2 = cosine(y.p2), s2 = sin(y.p2), c3 = cosine(y.p3), s3 = sin(y.p3);
    const double C = c2 * c3 + s2 * s3, S = s3 * c2 - c3 * s2;
    const double P = m->A2 * c2 + m->B * c3, Q = m->A3 * c3 + m->B * c2;
    const double fr = push * c1, ft = -push * s1;
    const double R1 = (m->a2 * c2 + m->a3 * c3) * ft + 2 * (s2 * P * y.w2 + s3 * Q * y.w3) * y.w1;
    const double R2 = -m->G2 * c2 * weight - s2 * P * y.w1 * y.w1 + m->B * S * y.w3 * y.w3 - m->a2 * s2 * fr;
    const double R3 = -m->G3 * c3 * weight - s3 * Q * y.w1 * y.w1 - m->B * S * y.w2 * y.w2 - m->a3 * s3 * fr;
    const double N = m->B * C, inverse = 1 / (m->B2 * m->B3 - N * N);
    return (struct state){y.w1, y.w2, y.w3, R1 / (m->A1 + c2 * P + c3 * Q), (m->B3 * R2 - N * R3) * inverse,
                          (m->B2 * R3 - N * R2) * inverse};
}

static inline struct state rate_falling(const struct arm *m, const struct wall *w, struct state y, double t) {
    (void)w, (void)t;
    return rate(m, y, 9.80665, 0);
}

/* Gravity compensated, the wall judged anew at each stage. */
static inline struct state rate_pushed(const struct arm *m, const struct wall *w, struct state y, double t) {
    const double tip = cosine(y.q1) * (m->a2 * cosine(y.p2) + m->a3 * cosine(y.p3));
    return rate(m, y, 0, -w->stiffness * fmax(0, tip - (w->x - w->speed * t)));
}

static inline struct state along(struct state y, double h, struct state f) {
    return (struct state){y.q1 + h * f.q1, y.p2 + h * f.p2, y.p3 + h * f.p3,
                          y.w1 + h * f.w1, y.w2 + h * f.w2, y.w3 + h * f.w3};
}

#define LOOP(name, rate)                                                                                             \
    void name(const struct arm *m, const struct wall *w, double h, int steps, size_t n, double *state) {             \
        double *q1 = state, *p2 = q1 + n, *p3 = p2 + n, *w1 = p3 + n, *w2 = w1 + n, *w3 = w2 + n;                    \
        for (size_t first = 0; first < n; first += block) {                                                          \
            const size_t end = first + block < n ? first + block : n;                                                \
            for (int step = 0; step < steps; ++step) {                                                               \
                _Pragma("omp simd") for (size_t i = first; i < end; ++i) {                                           \
                    const double t = step * h;                                                                       \
                    struct state y = {q1[i], p2[i], p3[i], w1[i], w2[i], w3[i]};                                     \
                    const struct state f1 = rate(m, w, y, t), f2 = rate(m, w, along(y, h / 2, f1), t + h / 2);       \
                    const struct state f3 = rate(m, w, along(y, h / 2, f2), t + h / 2);                              \
                    const struct state f4 = rate(m, w, along(y, h, f3), t + h);                                      \
                    y = along(along(along(along(y, h / 6, f1), h / 3, f2), h / 3, f3), h / 6, f4);                   \
                    q1[i] = y.q1, p2[i] = y.p2, p3[i] = y.p3, w1[i] = y.w1, w2[i] = y.w2, w3[i] = y.w3;              \
                }                                                                                                    \
            }                                                                                                        \
        }                                                                                                            \
    }

LOOP(loop_falling, rate_falling)
LOOP(loop_pushed, rate_pushed)

const char *loop_build(void) { return PEER_BUILD; }

#pragma once
// Two methods for y' = f(t, y), independent of any physics; docs/model.md, section 5. A right-hand side offers
//   void begin_step(const State&)                       called once before the stages of a step
//   void operator()(const T& t, const State&, State&)   the derivative
// The leading `Norm` components of the state enter the error norm; the quadratures behind them do not.

#include <array>
#include <cstddef>

#include "arm3r/numbers/real.hpp"

namespace arm3r {

template <class T, std::size_t N>
using State = std::array<T, N>;

// Component i from the coefficients of an interpolant, at one instant or at several side by side.
template <class Coefficients, class S>
ARM3R_INLINE S interpolated(const Coefficients& c, std::size_t i, const S& theta) {
    const S rest = 1.0 - theta;
    return c[0][i] + theta * (c[1][i] + rest * (c[2][i] + theta * (c[3][i] + rest * c[4][i])));
}

// The solution within a step: y(theta), theta = (t - t0)/h in [0, 1], a polynomial of degree 4 (5.2) or 3 (5.1).
template <class T, std::size_t N>
struct Interpolant {
    T t0, h;
    std::array<State<T, N>, 5> c;

    template <class S>
    ARM3R_INLINE S component(std::size_t i, const S& theta) const {
        return interpolated(c, i, theta);
    }

    State<T, N> operator()(const T& theta) const {
        State<T, N> y;
        for (std::size_t i = 0; i < N; ++i) y[i] = component(i, theta);
        return y;
    }
};

// Cubic Hermite from both ends of a step: the first four coefficients of either method.
template <class T, std::size_t N>
ARM3R_INLINE Interpolant<T, N> hermite(const T& t, const T& h, const State<T, N>& y0, const State<T, N>& f0,
                                       const State<T, N>& y1, const State<T, N>& f1) {
    Interpolant<T, N> dense{t, h, {}};
    for (std::size_t i = 0; i < N; ++i) {
        const T difference = y1[i] - y0[i];
        const T bow = h * f0[i] - difference;
        dense.c[0][i] = y0[i];
        dense.c[1][i] = difference;
        dense.c[2][i] = bow;
        dense.c[3][i] = difference - h * f1[i] - bow;
        dense.c[4][i] = T(0.0);
    }
    return dense;
}

// The end of a step of the classical method (5.1) from the derivatives of its four stages. Components from `Moving` on stay
// as they are.
template <std::size_t Moving, class T, std::size_t N>
ARM3R_INLINE State<T, N> rk4_end(const State<T, N>& y, const State<T, N>& k1, const State<T, N>& k2,
                                 const State<T, N>& k3, const State<T, N>& k4, const T& h) {
    State<T, N> y1 = y;
    const T sixth = h / 6.0;
    for (std::size_t i = 0; i < Moving; ++i) y1[i] = y[i] + sixth * ((k1[i] + k4[i]) + 2.0 * (k2[i] + k3[i]));
    return y1;
}

// One step of the classical method (5.1). f0 is the derivative at (t, y), with f.begin_step(y) done. Components from
// `Moving` on stay as they are; f need not set their rates.
template <std::size_t Moving, class T, std::size_t N, class F>
ARM3R_INLINE State<T, N> rk4_step_of_first(const F& f, const T& t, const State<T, N>& y, const State<T, N>& f0,
                                           const T& h) {
    State<T, N> stage = y, k2, k3, k4;
    const T half = 0.5 * h;
    for (std::size_t i = 0; i < Moving; ++i) stage[i] = y[i] + half * f0[i];
    f(t + half, stage, k2);
    for (std::size_t i = 0; i < Moving; ++i) stage[i] = y[i] + half * k2[i];
    f(t + half, stage, k3);
    for (std::size_t i = 0; i < Moving; ++i) stage[i] = y[i] + h * k3[i];
    f(t + h, stage, k4);
    return rk4_end<Moving>(y, f0, k2, k3, k4, h);
}
template <class T, std::size_t N, class F>
ARM3R_INLINE State<T, N> rk4_step(const F& f, const T& t, const State<T, N>& y, const State<T, N>& f0, const T& h) {
    return rk4_step_of_first<N>(f, t, y, f0, h);
}

// The same bits as rk4_step, with a single call of f in the code: for a long f.
template <class T, std::size_t N, class F>
ARM3R_INLINE State<T, N> rk4_step_in_a_loop(const F& f, const T& t, const State<T, N>& y, const State<T, N>& f0,
                                            const T& h) {
    State<T, N> stage, k[3];
    const T half = 0.5 * h;
    const State<T, N>* before = &f0;
#pragma GCC unroll 1
    for (int i = 0; i < 3; ++i) {
        const T offset = i < 2 ? half : h;
        for (std::size_t j = 0; j < N; ++j) stage[j] = y[j] + offset * (*before)[j];
        f(t + offset, stage, k[i]);
        before = &k[i];
    }
    return rk4_end<N>(y, f0, k[0], k[1], k[2], h);
}

// Dormand and Prince, order 5(4) (5.2). The last stage is the first of the next step. The `Quadratures` components
// behind the first `Norm` do not enter the error norm; those after them do. The last `Parts` of the quadratures are
// parts of others among them, and never enter it.
template <class T, std::size_t N, std::size_t Norm, std::size_t Quadratures = N - Norm, std::size_t Parts = 0>
struct Dopri5 {
    State<T, N> y1, f1;            // the end of the step
    std::array<State<T, N>, 6> k;  // k[0] = f0 .. k[5]

    template <class F>
    ARM3R_INLINE void step(const F& f, const T& t, const State<T, N>& y, const State<T, N>& f0, const T& h) {
        State<T, N> s;
        k[0] = f0;
        for (std::size_t i = 0; i < N; ++i) s[i] = y[i] + h * (1.0 / 5 * k[0][i]);
        f(t + 1.0 / 5 * h, s, k[1]);
        for (std::size_t i = 0; i < N; ++i) s[i] = y[i] + h * (3.0 / 40 * k[0][i] + 9.0 / 40 * k[1][i]);
        f(t + 3.0 / 10 * h, s, k[2]);
        for (std::size_t i = 0; i < N; ++i)
            s[i] = y[i] + h * (44.0 / 45 * k[0][i] - 56.0 / 15 * k[1][i] + 32.0 / 9 * k[2][i]);
        f(t + 4.0 / 5 * h, s, k[3]);
        for (std::size_t i = 0; i < N; ++i)
            s[i] = y[i] + h * (19372.0 / 6561 * k[0][i] - 25360.0 / 2187 * k[1][i] + 64448.0 / 6561 * k[2][i] -
                               212.0 / 729 * k[3][i]);
        f(t + 8.0 / 9 * h, s, k[4]);
        for (std::size_t i = 0; i < N; ++i)
            s[i] = y[i] + h * (9017.0 / 3168 * k[0][i] - 355.0 / 33 * k[1][i] + 46732.0 / 5247 * k[2][i] +
                               49.0 / 176 * k[3][i] - 5103.0 / 18656 * k[4][i]);
        f(t + h, s, k[5]);
        for (std::size_t i = 0; i < N; ++i)
            y1[i] = y[i] + h * (35.0 / 384 * k[0][i] + 500.0 / 1113 * k[2][i] + 125.0 / 192 * k[3][i] -
                                2187.0 / 6784 * k[4][i] + 11.0 / 84 * k[5][i]);
        f(t + h, y1, f1);
    }

    // The error estimate of component i over the step of h.
    ARM3R_INLINE T error_of(std::size_t i, const T& h) const {
        const T e = h * (71.0 / 57600 * k[0][i] - 71.0 / 16695 * k[2][i] + 71.0 / 1920 * k[3][i] -
                         17253.0 / 339200 * k[4][i] + 22.0 / 525 * k[5][i] - 1.0 / 40 * f1[i]);
        return abs(e);
    }

    // The largest error estimate in units of its tolerance, without the quadratures or, in some lanes, with them. The step
    // is accepted below 1. It is the maximum and not a mean: a joint at rest must not loosen the tolerance of one that
    // moves.
    template <class R, class M = bool>
    ARM3R_INLINE T error(const State<T, N>& y, const T& h, const R& rtol, const R& atol,
                         const M& with_quadratures = false) const {
        T largest(0.0);
        const auto include = [&](std::size_t begin, std::size_t end) ARM3R_INLINE_LAMBDA {
            for (std::size_t i = begin; i < end; ++i)
                largest = max(largest, T(error_of(i, h) / (atol + rtol * max(abs(y[i]), abs(y1[i])))));
        };
        include(0, Norm);
        include(Norm + Quadratures, N);
        if (!any(with_quadratures)) return largest;
        const T of_others = largest;
        include(Norm, Norm + Quadratures - Parts);
        return select(with_quadratures, largest, of_others);
    }

    // h times the magnitude of the dominant eigenvalue, from the difference between the last two stages, which are both
    // at the end of the step. Above 3.25 the step is limited by stability and not by accuracy (5.7).
    ARM3R_INLINE T stiffness() const {
        T rate(0.0), way(0.0);
        for (std::size_t i = 0; i < N; i = i + 1 == Norm ? i + 1 + Quadratures : i + 1) {
            const T d = (35.0 / 384 - 9017.0 / 3168) * k[0][i] + 355.0 / 33 * k[1][i] +
                        (500.0 / 1113 - 46732.0 / 5247) * k[2][i] + (125.0 / 192 - 49.0 / 176) * k[3][i] +
                        (5103.0 / 18656 - 2187.0 / 6784) * k[4][i] + 11.0 / 84 * k[5][i];
            rate = rate + (f1[i] - k[5][i]) * (f1[i] - k[5][i]);
            way = way + d * d;
        }
        return select(way > T(0.0), sqrt(T(rate / way)), T(0.0));
    }

    ARM3R_INLINE Interpolant<T, N> interpolant(const T& t, const State<T, N>& y, const T& h) const {
        Interpolant<T, N> dense = hermite(t, h, y, k[0], y1, f1);
        for (std::size_t i = 0; i < N; ++i)
            dense.c[4][i] = h * (-12715105075.0 / 11282082432 * k[0][i] + 87487479700.0 / 32700410799 * k[2][i] -
                                 10690763975.0 / 1880347072 * k[3][i] + 701980252875.0 / 199316789632 * k[4][i] -
                                 1453857185.0 / 822651844 * k[5][i] + 69997945.0 / 29380423 * f1[i]);
        return dense;
    }
};

// The factor of the step size that puts the next error a little below the tolerance (5.2).
template <class T>
ARM3R_INLINE T step_factor(const T& error) {
    const T floored = max(error, T(1e-10));
    return min(T(10.0), max(T(0.2), T(0.9 / fifth_root(floored))));
}

}  // namespace arm3r

#pragma once
// RODAS4, a Rosenbrock method of order 4(3) for stiff y' = f(t, y): Hairer and Wanner, Solving Ordinary Differential
// Equations II, section IV.7. L-stable, stiffly accurate; six linear equations with one matrix a step, no iteration.

#include <algorithm>
#include <cmath>

#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/numbers/small_lu.hpp"
#include "arm3r/ode/linearization.hpp"

namespace arm3r {

// The symbols are those of the book for the transformed stages u: the point of stage i is y + sum a_ij u_j, that of the
// seventh the end of the step, that of the sixth the end by the embedded method.
namespace rodas4 {

inline constexpr int stages = 6;
inline constexpr double gamma = 0.25;
inline constexpr double alpha[stages] = {0.0, 0.386, 0.21, 0.63, 1.0, 1.0};
inline constexpr double gamma_sum[stages] = {0.25, -0.1043, 0.1035, -0.0362, 0.0, 0.0};

inline constexpr double a[stages + 1][stages] = {
    {},
    {1.544},
    {0.9466785280815826, 0.2557011698983284},
    {3.314825187068521, 2.896124015972201, 0.9986419139977817},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1.0},
    {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1.0, 1.0},
};

inline constexpr double c[stages][stages - 1] = {
    {},
    {-5.6688},
    {-2.430093356833875, -0.2063599157091915},
    {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
    {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
    {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054},
};

// y(theta) = y + theta (y1 - y) + theta (1 - theta) sum (d[0]_j + theta d[1]_j) u_j, of order 3.
inline constexpr double d[2][stages - 1] = {
    {10.12623508344586, -7.487995877610167, -34.80091861555747, -7.992771707568823, 1.025137723295662},
    {-0.6762803392801253, 6.087714651680015, 16.43084320892478, 24.76722511418386, -6.594389125716872},
};

}  // namespace rodas4

// The layout of the state is that of linearization.hpp. The stages of the quadratures follow from those of the other
// components, and they do not enter the error norm. The last `Parts` of them are parts of others among them, and never
// enter it. T = Pack<n> is n steps in lanes: their linear equations are solved lane by lane, all else in all lanes.
template <class T, std::size_t N, std::size_t Motion, std::size_t Quadratures, std::size_t Parts = 0>
struct Rodas4 {
    static constexpr int lanes = Lanes<T>::count;
    using Mask = typename Lanes<T>::Mask;
    using Y = State<T, N>;
    using Jacobians = std::array<Linearization<N>, lanes>;

    std::size_t memory = 0;             // memory components in use behind the quadratures; the rest keep their values
    Y y1;                               // the end of the step
    std::array<Y, rodas4::stages> u{};  // the stages

    // f0 and `jacobians` are f and its Jacobian at (t, y), with f.begin_step(y) done; both can be used again after a
    // rejected step. Returns where, of `here`, the step does not fail: I - h gamma df/dy is regular, and all is finite.
    template <class F>
    ARM3R_INLINE Mask step(const F& f, const Mask& here, const Jacobians& jacobians, const T& t, const Y& y,
                           const Y& f0, const T& h) {
        const Mask regular = factorise(here, jacobians, h);
        y1 = y;
        if (!in_any_lane(regular)) return regular;
        Y fi = f0;
        for (std::size_t i = 0; i < rodas4::stages; ++i) {
            if (i > 0) f(T(t + rodas4::alpha[i] * h), y1, fi);
            find_stage(i, regular, fi, h);
            const Y way = sum(rodas4::a[i + 1], i + 1);
            for (std::size_t l = 0; l < N; ++l) y1[l] = y[l] + way[l];
        }
        return regular && is_finite();
    }

    // The error estimate of component i.
    ARM3R_INLINE T error_of(std::size_t i) const { return abs(u[rodas4::stages - 1][i]); }

    // The largest error estimate in units of its tolerance, over motion and memory, or in some lanes over the quadratures
    // too; see Dopri5.
    ARM3R_INLINE T error(const Y& y, const T& rtol, const T& atol, const Mask& with_quadratures = Mask(false)) const {
        T largest(0.0);
        const auto include = [&](std::size_t begin, std::size_t end) ARM3R_INLINE_LAMBDA {
            for (std::size_t i = begin; i < end; ++i)
                largest = max(largest, T(error_of(i) / (atol + rtol * max(abs(y[i]), abs(y1[i])))));
        };
        include(0, Motion);
        include(Motion + Quadratures, in_use());
        if (!in_any_lane(with_quadratures)) return largest;
        const T of_others = largest;
        include(Motion, Motion + Quadratures - Parts);
        return select(with_quadratures, largest, of_others);
    }

    ARM3R_INLINE Interpolant<T, N> interpolant(const T& t, const Y& y, const T& h) const {
        Interpolant<T, N> dense{t, h, {}};
        dense.c[0] = y;
        for (std::size_t i = 0; i < N; ++i) dense.c[1][i] = y1[i] - y[i], dense.c[4][i] = T(0.0);
        dense.c[2] = sum(rodas4::d[0], rodas4::stages - 1);
        dense.c[3] = sum(rodas4::d[1], rodas4::stages - 1);
        return dense;
    }

    // The step factor as for Dopri5, with the fourth root.
    ARM3R_INLINE static T step_factor(const T& error) {
        return min(T(6.0), max(T(0.2), T(0.9 / sqrt(sqrt(max(error, T(1e-10)))))));
    }

private:
    static constexpr std::size_t index(std::size_t k) { return state_index<Motion, Quadratures>(k); }
    std::size_t in_use() const { return Motion + Quadratures + memory; }

    // I - h gamma df/dy of every lane as factors, and what else the stages need of the Jacobians, side by side.
    [[gnu::noinline]] Mask factorise(const Mask& here, const Jacobians& jacobians, const T& h) {
        Mask regular = here;
        for (int lane = 0; lane < lanes; ++lane)
            if (Lanes<T>::is(here, lane))
                Lanes<T>::mark(regular, lane, factorise_lane(lane, jacobians[lane], Lanes<T>::get(h, lane)));
        return regular;
    }
    bool factorise_lane(int lane, const Linearization<N>& jacobian, double h) {
        const std::size_t n = Motion + memory;
        Lu lu;
        lu.n = n;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) lu.a[i][j] = -(h * rodas4::gamma) * jacobian.df_dy[index(i)][index(j)];
            lu.a[i][i] += 1.0;
        }
        if (!lu.factorise()) return false;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) Lanes<T>::set(factors_[i][j], lane, lu.a[i][j]);
        for (std::size_t l = 0; l < Quadratures; ++l)
            for (std::size_t k = 0; k < n; ++k)
                Lanes<T>::set(through_[l][k], lane, jacobian.df_dy[Motion + l][index(k)]);
        for (std::size_t l = 0; l < in_use(); ++l) Lanes<T>::set(df_dt_[l], lane, jacobian.df_dt[l]);
        raised_[lane] = lu.raised();
        return true;
    }

    // (I - h gamma df/dy) u_i = h gamma (f_i + h gamma_i df/dt) + gamma sum c_ij u_j.
    ARM3R_INLINE void find_stage(std::size_t i, const Mask& regular, const Y& fi, const T& h) {
        const T weight = h * rodas4::gamma;
        const Y before = sum(rodas4::c[i], i);
        Y& ui = u[i];
        for (std::size_t l = 0; l < in_use(); ++l)
            ui[l] = weight * (fi[l] + (h * rodas4::gamma_sum[i]) * df_dt_[l]) + rodas4::gamma * before[l];
        const std::size_t n = Motion + memory;
        std::array<T, N - Quadratures> x;
        for (std::size_t k = 0; k < n; ++k) x[k] = ui[index(k)];
        for (int lane = 0; lane < lanes; ++lane)
            if (Lanes<T>::is(regular, lane)) raise(x, lane, n);
        Lu::substitute(factors_, x, n);
        for (std::size_t k = 0; k < n; ++k) ui[index(k)] = x[k];
        for (std::size_t l = 0; l < Quadratures; ++l) {
            T through(0.0);
            for (std::size_t k = 0; k < n; ++k) through = through + through_[l][k] * x[k];
            ui[Motion + l] = ui[Motion + l] + weight * through;
        }
        for (std::size_t l = 0; l < in_use(); ++l) ui[l] = select(regular, ui[l], T(0.0));
    }
    void raise(std::array<T, N - Quadratures>& x, int lane, std::size_t n) const {
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t other = raised_[lane][k];
            if (other == k) continue;
            const double here = Lanes<T>::get(x[k], lane);
            Lanes<T>::set(x[k], lane, Lanes<T>::get(x[other], lane));
            Lanes<T>::set(x[other], lane, here);
        }
    }

    // The sum over the first `count` stages.
    ARM3R_INLINE Y sum(const double* coefficients, std::size_t count) const {
        Y total;
        for (T& one : total) one = T(0.0);
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t l = 0; l < N; ++l) total[l] = total[l] + coefficients[j] * u[j][l];
        return total;
    }

    ARM3R_INLINE Mask is_finite() const {
        Mask finite = true;
        for (std::size_t l = 0; l < in_use(); ++l) finite = finite && y1[l] * 0.0 == T(0.0);
        return finite;
    }

    using Lu = SmallLu<N - Quadratures>;

    std::array<std::array<T, N - Quadratures>, N - Quadratures> factors_;
    std::array<std::array<T, N - Quadratures>, Quadratures> through_;  // of the quadratures by the other components
    Y df_dt_;
    std::array<typename Lu::Rows, lanes> raised_;
};

}  // namespace arm3r

#pragma once
// RODAS4, a Rosenbrock method of order 4(3) for stiff y' = f(t, y): Hairer and Wanner, Solving Ordinary Differential
// Equations II, section IV.7. L-stable, stiffly accurate; six linear equations with one matrix a step, no iteration.

#include <algorithm>
#include <cmath>

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
// enter it.
template <std::size_t N, std::size_t Motion, std::size_t Quadratures, std::size_t Parts = 0>
struct Rodas4 {
    std::size_t memory = 0;  // memory components in use behind the quadratures; the rest keep their values
    State<double, N> y1;     // the end of the step
    std::array<State<double, N>, rodas4::stages> u{};  // the stages

    // f0 and `linearization` are f and its Jacobian at (t, y), with f.begin_step(y) done; both can be used again after
    // a rejected step. Returns false if the step fails: I - h gamma df/dy is singular, or something is not finite.
    template <class F>
    bool step(const F& f, const Linearization<N>& linearization, double t, const State<double, N>& y,
              const State<double, N>& f0, double h) {
        if (!factorise(linearization, h)) return false;
        y1 = y;
        State<double, N> fi = f0;
        for (std::size_t i = 0; i < rodas4::stages; ++i) {
            if (i > 0) f(t + rodas4::alpha[i] * h, y1, fi);
            find_stage(i, linearization, fi, h);
            const State<double, N> way = sum(rodas4::a[i + 1], i + 1);
            for (std::size_t l = 0; l < N; ++l) y1[l] = y[l] + way[l];
        }
        return is_finite();
    }

    // The error estimate of component i.
    double error_of(std::size_t i) const { return abs(u[rodas4::stages - 1][i]); }

    // The largest error estimate in units of its tolerance, over motion and memory, or over the quadratures too; see
    // Dopri5.
    double error(const State<double, N>& y, double rtol, double atol, bool with_quadratures = false) const {
        double largest = 0;
        const std::size_t counted = with_quadratures ? Motion + Quadratures - Parts : Motion;
        for (std::size_t i = 0; i < in_use(); i = i + 1 == counted ? Motion + Quadratures : i + 1)
            largest = max(largest, error_of(i) / (atol + rtol * max(abs(y[i]), abs(y1[i]))));
        return largest;
    }

    Interpolant<double, N> interpolant(double t, const State<double, N>& y, double h) const {
        Interpolant<double, N> dense{t, h, {}};
        dense.c[0] = y;
        for (std::size_t i = 0; i < N; ++i) dense.c[1][i] = y1[i] - y[i];
        dense.c[2] = sum(rodas4::d[0], rodas4::stages - 1);
        dense.c[3] = sum(rodas4::d[1], rodas4::stages - 1);
        return dense;
    }

    // The step factor as for Dopri5, with the fourth root.
    static double step_factor(double error) { return min(6.0, max(0.2, 0.9 / sqrt(sqrt(max(error, 1e-10))))); }

private:
    static constexpr std::size_t index(std::size_t k) { return state_index<Motion, Quadratures>(k); }
    std::size_t in_use() const { return Motion + Quadratures + memory; }

    bool factorise(const Linearization<N>& linearization, double h) {
        lu_.n = Motion + memory;
        for (std::size_t i = 0; i < lu_.n; ++i) {
            for (std::size_t j = 0; j < lu_.n; ++j)
                lu_.a[i][j] = -(h * rodas4::gamma) * linearization.df_dy[index(i)][index(j)];
            lu_.a[i][i] += 1.0;
        }
        return lu_.factorise();
    }

    // (I - h gamma df/dy) u_i = h gamma (f_i + h gamma_i df/dt) + gamma sum c_ij u_j.
    void find_stage(std::size_t i, const Linearization<N>& linearization, const State<double, N>& fi, double h) {
        const double weight = h * rodas4::gamma;
        const State<double, N> before = sum(rodas4::c[i], i);
        State<double, N>& ui = u[i];
        for (std::size_t l = 0; l < in_use(); ++l)
            ui[l] = weight * (fi[l] + (h * rodas4::gamma_sum[i]) * linearization.df_dt[l]) + rodas4::gamma * before[l];
        std::array<double, N - Quadratures> x;
        for (std::size_t k = 0; k < lu_.n; ++k) x[k] = ui[index(k)];
        lu_.solve(x);
        for (std::size_t k = 0; k < lu_.n; ++k) ui[index(k)] = x[k];
        for (std::size_t l = Motion; l < Motion + Quadratures; ++l) {
            double through = 0;
            for (std::size_t k = 0; k < lu_.n; ++k) through += linearization.df_dy[l][index(k)] * x[k];
            ui[l] += weight * through;
        }
    }

    // The sum over the first `count` stages.
    ARM3R_INLINE State<double, N> sum(const double* coefficients, std::size_t count) const {
        State<double, N> total{};
        for (std::size_t j = 0; j < count; ++j)
            for (std::size_t l = 0; l < N; ++l) total[l] += coefficients[j] * u[j][l];
        return total;
    }

    bool is_finite() const {
        return std::all_of(y1.begin(), y1.begin() + in_use(), [](double v) { return std::isfinite(v); });
    }

    SmallLu<N - Quadratures> lu_;
};

}  // namespace arm3r

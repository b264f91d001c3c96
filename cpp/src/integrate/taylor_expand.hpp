#pragma once
// The Taylor kernels as functions; the numbers that they are for are compiled in files of their own.

#include <concepts>
#include <utility>

#include "arm3r/lanes.hpp"
#include "arm3r/numbers/eigen_traits.hpp"
#include "arm3r/numbers/widths.hpp"
#include "integrate/taylor.hpp"

namespace arm3r {
namespace {

#include <taylor_kernels.hpp>  // made by derive_taylor

// The squared angular frequency of the wall, 1/s^2.
template <class T>
ARM3R_INLINE T frequency_2(const Wall<T>& wall) {
    const T omega = two_pi * wall.sinusoid.frequency;
    return wall.motion == Motion::sinusoid ? T(omega * omega) : T(0.0);
}

template <class T>
using Expand = void (*)(const Plant<T>&, const T&, const State<T, state_size>&, int, T (*)[quantities]);

template <std::size_t recipe, class T>
ARM3R_INLINE void expand_here(const Plant<T>& plant, const T& t, const State<T, state_size>& y, int order,
                              T (*c)[quantities]) {
    alignas(64) T given[9 + state_size];
    if constexpr (recipes[recipe].signals) {
        const WallState<T> wall = wall_at(plant.wall, t);
        for (int i = 0; i < 3; ++i) {
            given[i] = wall.position[i];
            given[3 + i] = wall.velocity[i];
            given[6 + i] = wall.acceleration[i];
        }
    }
    for (std::size_t i = 0; i < state_size; ++i) given[9 + i] = y[i];
    Recurrence<recipe, T>::expand(plant, frequency_2(plant.wall), given, order, c);
}

template <std::size_t recipe>
struct ExpandBy {
    template <class T>
    ARM3R_INLINE void operator()(const Plant<T>& plant, const T& t, const State<T, state_size>& y, int order,
                                 T (*c)[quantities]) const {
        expand_here<recipe>(plant, t, y, order, c);
    }
};

template <std::size_t recipe>
ARM3R_WIDEST_SCALARS void expand_scalars(const Plant<double>& plant, const double& t,
                                         const State<double, state_size>& y, int order, double (*c)[quantities]) {
    expand_here<recipe>(plant, t, y, order, c);
}

template <std::size_t recipe, class T>
constexpr Expand<T> expand_by() {
    if constexpr (std::same_as<T, double>) return expand_scalars<recipe>;
    else
        return Outlined<T>::template call<ExpandBy<recipe>, const Plant<T>&, const T&, const State<T, state_size>&, int,
                                          T(*)[quantities]>;
}

template <class T>
Expand<T> expand_of(Kernel kernel) {
    static constexpr auto table = []<std::size_t... i>(std::index_sequence<i...>) {
        return std::array<Expand<T>, sizeof...(i)>{expand_by<i, T>()...};
    }(std::make_index_sequence<recipes.size()>());
    return table[static_cast<std::size_t>(kernel)];
}

}  // namespace

template <class T>
void expand(Kernel kernel, const Plant<T>& plant, const T& t, const State<T, state_size>& y, int order,
            Expansion<T>& expansion) {
    expansion.order = order;
    expand_of<T>(kernel)(plant, t, y, order, expansion.c);
}

}  // namespace arm3r

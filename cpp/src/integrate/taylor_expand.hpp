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

// Made by derive_taylor; it names what only some of the kernels use.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-variable"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#include <taylor_kernels.hpp>
#pragma GCC diagnostic pop

// The squared angular frequency of the wall, 1/s^2.
template <class T>
ARM3R_INLINE T frequency_2(const Wall<T>& wall) {
    const T omega = two_pi * wall.sinusoid.frequency;
    return wall.motion == Motion::sinusoid ? T(omega * omega) : T(0.0);
}

template <class T>
using Expand = void (*)(const Plant<T>&, const T&, const State<T, state_size>&, const Pose<T>&, int, T (*)[quantities]);

template <std::size_t recipe, class T>
ARM3R_INLINE void expand_here(const Plant<T>& plant, const T& t, const State<T, state_size>& y, const Pose<T>& p,
                              int order, T (*c)[quantities]) {
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
    Recurrence<recipe, T>::expand(plant, frequency_2(plant.wall), given, p, order, c);
}

template <std::size_t recipe>
struct ExpandBy {
    template <class T>
    ARM3R_INLINE void operator()(const Plant<T>& plant, const T& t, const State<T, state_size>& y, const Pose<T>& p,
                                 int order, T (*c)[quantities]) const {
        expand_here<recipe>(plant, t, y, p, order, c);
    }
};

// The kernel of a recipe, compiled for the registers that hold `Widest`.
template <std::size_t recipe, class T, class Widest>
constexpr Expand<T> expand_for =
    Outlined<Widest>::template call<ExpandBy<recipe>, const Plant<T>&, const T&, const State<T, state_size>&,
                                    const Pose<T>&, int, T (*)[quantities]>;

template <std::size_t recipe, class T>
Expand<T> expand_by() {
    if constexpr (std::same_as<T, double>) {
#if ARM3R_HAS_EIGHT
        if (has_registers_for(8)) return expand_for<recipe, T, Pack<8>>;
#endif
#if ARM3R_HAS_FOUR
        if (has_registers_for(4)) return expand_for<recipe, T, Pack<4>>;
#endif
    }
    return expand_for<recipe, T, T>;
}

template <class T>
Expand<T> expand_of(Kernel kernel) {
    static const auto table = []<std::size_t... i>(std::index_sequence<i...>) {
        return std::array<Expand<T>, sizeof...(i)>{expand_by<i, T>()...};
    }(std::make_index_sequence<recipes.size()>());
    return table[static_cast<std::size_t>(kernel)];
}

}  // namespace

template <class T>
void expand(Kernel kernel, const Plant<T>& plant, const T& t, const State<T, state_size>& y, const Pose<T>& p,
            int order, Expansion<T>& expansion) {
    expansion.order = order;
    expand_of<T>(kernel)(plant, t, y, p, order, expansion.c);
}

}  // namespace arm3r

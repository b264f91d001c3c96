#pragma once
// A plate that moves on its own account; docs/model.md, section 4. It knows nothing of the arm. Base axes.

#include "arm3r/vectors.hpp"

namespace arm3r {

enum class Motion { fixed, constant, sinusoid };

template <class P>
struct Wall {
    Vec3<P> point;      // m, origin of the plate's frame at t = 0
    Vec3<P> n, e1, e2;  // unit: towards the arm, and along the plate's sides (4.1)
    P half1, half2;     // m, half its sides; inf: half-space
    bool has_outline;   // some lane's half is finite
    P face_offset;      // m, of the contact face in front of the frame
    Motion motion;
    Vec3<P> velocity;               // m/s, for constant
    P amplitude, frequency, phase;  // m, Hz, rad, along n, for sinusoid
};

template <class T>
struct WallState {
    Vec3<T> position, velocity, acceleration;  // of the frame's origin: m, m/s, m/s^2
};

template <class T>
ARM3R_INLINE WallState<T> no_wall() {
    const T o(0.0);
    return {{o, o, o}, {o, o, o}, {o, o, o}};
}

template <class P, class T>
ARM3R_INLINE WallState<T> wall_at(const Wall<P>& wall, const T& t) {  // (4.2)
    const T o(0.0);
    WallState<T> state{{T(wall.point[0]), T(wall.point[1]), T(wall.point[2])}, {o, o, o}, {o, o, o}};
    if (wall.motion == Motion::constant) {
        for (int i = 0; i < 3; ++i) {
            state.position[i] = wall.point[i] + wall.velocity[i] * t;
            state.velocity[i] = T(wall.velocity[i]);
        }
    } else if (wall.motion == Motion::sinusoid) {
        constexpr double two_pi = 6.283185307179586;
        const T cycles = wall.frequency * t;
        const SinCos<T> now = sincos(T((cycles - nearest_integer(cycles)) * two_pi + wall.phase));
        const P omega = two_pi * wall.frequency;
        const T s = wall.amplitude * now.sin - wall.amplitude * sincos(wall.phase).sin;
        const T v = wall.amplitude * omega * now.cos;
        const T a = -(wall.amplitude * omega * omega) * now.sin;
        for (int i = 0; i < 3; ++i) {
            state.position[i] = wall.point[i] + s * wall.n[i];
            state.velocity[i] = v * wall.n[i];
            state.acceleration[i] = a * wall.n[i];
        }
    }
    return state;
}

// A point as the plate sees it: how deep it is, how fast it sinks in, and where on the plate it is.
template <class T>
struct Indentation {
    T depth, rate;       // m, m/s; > 0 inside (4.3), deepening (4.4)
    T across1, across2;  // m from the centre along e1, e2
    T slip1, slip2;      // m/s relative to the plate along e1, e2
};

template <class P, class T>
ARM3R_INLINE Indentation<T> indentation(const Wall<P>& wall, const WallState<T>& state, const Vec3<T>& point,
                                        const Vec3<T>& velocity) {
    const Vec3<T> x = minus(point, state.position), v = minus(velocity, state.velocity);
    const Vec3<T> n = lifted<T>(wall.n), e1 = lifted<T>(wall.e1), e2 = lifted<T>(wall.e2);
    return {wall.face_offset - dot(n, x), -dot(n, v), dot(e1, x), dot(e2, x), dot(e1, v), dot(e2, v)};
}

// Distance inside the outline, m: < 0 beside the plate (4.7).
template <class P, class T>
ARM3R_INLINE T inside_outline(const Wall<P>& wall, const Indentation<T>& in) {
    return min(T(wall.half1 - abs(in.across1)), T(wall.half2 - abs(in.across2)));
}

}  // namespace arm3r

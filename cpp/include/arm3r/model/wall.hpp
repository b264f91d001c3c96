#pragma once
// A plate with a prescribed motion; docs/model.md, section 4. It does not depend on the arm. Base axes.

#include <memory>

#include "arm3r/model/scalar_motion.hpp"
#include "arm3r/numbers/vectors.hpp"

namespace arm3r {

enum class Motion { fixed, constant, sinusoid, ramp, table };
enum class Rotation { none, constant, sinusoid };

struct WallChoices {
    Motion motion = Motion::fixed;
    Rotation rotation = Rotation::none;
    bool has_outline = false;  // some lane's half is finite

    bool operator==(const WallChoices&) const = default;
};

template <class P>
struct Wall : WallChoices {
    Vec3<P> point;      // m, origin of the plate's frame at t = 0
    Vec3<P> n, e1, e2;  // unit, at t = 0: towards the arm, and along the plate's sides (4.1)
    P half1, half2;     // m, half its sides; inf: half-space
    P face_offset;      // m, of the contact face in front of the frame
    Vec3<P> velocity;   // m/s, for constant
    Vec3<P> direction;  // unit, of the other motions
    Sinusoid<P> sinusoid;
    Ramp<P> ramp;
    std::shared_ptr<QuinticTable<P>> table;
    Vec3<P> axis;  // unit, through the origin of the frame
    P turn_rate;   // rad/s, for constant
    Sinusoid<P> turn_sinusoid;
};

template <class T>
struct WallState {
    Vec3<T> position, velocity, acceleration;  // of the frame's origin: m, m/s, m/s^2
    SinCos<T> turned;                          // of the angle about the wall's axis since t = 0
    T turn_rate;                               // rad/s
};

template <class T>
ARM3R_INLINE WallState<T> no_wall() {
    const T o(0.0);
    const Vec3<T> zero(o, o, o);
    return {zero, zero, zero, {o, T(1.0)}, o};
}

// The rotation about the wall's axis, rad.
template <class P, class T>
ARM3R_INLINE ScalarMotion<T> turn(const Wall<P>& wall, const T& t) {
    if (wall.rotation == Rotation::sinusoid) return scalar_motion(wall.turn_sinusoid, t);
    const T turns = wall.turn_rate * (1 / two_pi) * t;
    return {(turns - nearest_integer(turns)) * two_pi, T(wall.turn_rate), T(0.0)};
}

template <class P, class T>
ARM3R_INLINE Vec3<T> rotated(const Vec3<P>& axis, const SinCos<T>& angle, const Vec3<P>& v) {  // Rodrigues
    const Vec3<P> around = cross(axis, v);
    const P along = dot(axis, v);
    const T rest = 1.0 - angle.cos;
    Vec3<T> out;
    for (int i = 0; i < 3; ++i) out[i] = v[i] * angle.cos + around[i] * angle.sin + (axis[i] * along) * rest;
    return out;
}

template <class P, class T>
ARM3R_INLINE void move_along(const Vec3<P>& direction, const ScalarMotion<T>& along, WallState<T>& state) {
    for (int i = 0; i < 3; ++i) {
        state.position[i] = state.position[i] + along.s * direction[i];
        state.velocity[i] = along.v * direction[i];
        state.acceleration[i] = along.a * direction[i];
    }
}

// Whether the plate does not turn, and stands still, moves at one velocity, or oscillates.
template <class P>
bool is_plain_motion(const Wall<P>& wall) {
    return wall.motion != Motion::ramp && wall.motion != Motion::table && wall.rotation == Rotation::none;
}

// Whether the plate stands still or moves at one velocity.
template <class P>
bool moves_evenly(const Wall<P>& wall) {
    return (wall.motion == Motion::fixed || wall.motion == Motion::constant) && wall.rotation == Rotation::none;
}

// A plate that stands still or moves at one velocity.
template <class P, class T>
ARM3R_INLINE WallState<T> even_wall_at(const Wall<P>& wall, const T& t) {
    WallState<T> state = no_wall<T>();
    state.position = broadcast<T>(wall.point);
    if (wall.motion != Motion::constant) return state;
    for (int i = 0; i < 3; ++i) {
        state.position[i] = wall.point[i] + wall.velocity[i] * t;
        state.velocity[i] = T(wall.velocity[i]);
    }
    return state;
}

template <class P, class T>
ARM3R_INLINE WallState<T> plain_wall_at(const Wall<P>& wall, const T& t) {
    WallState<T> state = even_wall_at(wall, t);
    if (wall.motion == Motion::sinusoid) move_along(wall.direction, scalar_motion(wall.sinusoid, t), state);
    return state;
}

template <class P, class T>
ARM3R_INLINE WallState<T> wall_at(const Wall<P>& wall, const T& t) {  // (4.2)
    WallState<T> state = plain_wall_at(wall, t);
    if (wall.motion == Motion::ramp) move_along(wall.direction, scalar_motion(wall.ramp, t), state);
    if (wall.motion == Motion::table) move_along(wall.direction, scalar_motion(*wall.table, t), state);
    if (wall.rotation != Rotation::none) {
        const ScalarMotion<T> angle = turn(wall, t);
        state.turned = sincos(angle.s);
        state.turn_rate = angle.v;
    }
    return state;
}

// The present axes of the plate.
template <class T>
struct Axes {
    Vec3<T> n, e1, e2;
};

template <class P, class T>
ARM3R_INLINE Axes<T> axes(const Wall<P>& wall, const WallState<T>& state) {
    if (wall.rotation == Rotation::none) return {broadcast<T>(wall.n), broadcast<T>(wall.e1), broadcast<T>(wall.e2)};
    return {rotated(wall.axis, state.turned, wall.n), rotated(wall.axis, state.turned, wall.e1),
            rotated(wall.axis, state.turned, wall.e2)};
}

template <class P, class T>
ARM3R_INLINE Vec3<T> normal(const Wall<P>& wall, const WallState<T>& state) {
    return axes(wall, state).n;
}

// The velocity of the plate's material point at x, m/s.
template <class P, class T>
ARM3R_INLINE Vec3<T> velocity_at(const Wall<P>& wall, const WallState<T>& state, const Vec3<T>& x) {
    if (wall.rotation == Rotation::none) return state.velocity;
    const Vec3<T> spin(state.turn_rate * wall.axis[0], state.turn_rate * wall.axis[1], state.turn_rate * wall.axis[2]);
    return plus(state.velocity, cross(spin, minus(x, state.position)));
}

// The position of a point relative to the plate: depth, rate of the depth, and place on the plate.
template <class T>
struct Indentation {
    T depth, rate;       // m, m/s; > 0 inside (4.3), deepening (4.4)
    T across1, across2;  // m from the centre along e1, e2
    T slip1, slip2;      // m/s relative to the plate's point there along e1, e2
};

// x and v: position relative to the frame's origin, and velocity relative to the plate's material point.
template <class P, class A, class T>
ARM3R_INLINE Indentation<T> indentation_along(const P& face_offset, const A& axes, const Vec3<T>& x, const Vec3<T>& v) {
    const Vec3<T> n = broadcast<T>(axes.n), e1 = broadcast<T>(axes.e1), e2 = broadcast<T>(axes.e2);
    return {face_offset - dot(n, x), -dot(n, v), dot(e1, x), dot(e2, x), dot(e1, v), dot(e2, v)};
}

template <class P, class T>
ARM3R_INLINE Indentation<T> indentation(const Wall<P>& wall, const WallState<T>& state, const Vec3<T>& point,
                                        const Vec3<T>& velocity) {
    const Vec3<T> x = minus(point, state.position), v = minus(velocity, velocity_at(wall, state, point));
    if (wall.rotation == Rotation::none) return indentation_along(wall.face_offset, wall, x, v);
    return indentation_along(wall.face_offset, axes(wall, state), x, v);
}

// The same for a plate that does not turn; the place on it is set only where it has an outline.
template <class P, class T>
ARM3R_INLINE void set_indentation(const Wall<P>& wall, const WallState<T>& state, const Vec3<T>& point,
                                  const Vec3<T>& velocity, Indentation<T>& in) {
    const Vec3<T> x = minus(point, state.position), v = minus(velocity, state.velocity);
    in.depth = wall.face_offset - dot(wall.n, x), in.rate = -dot(wall.n, v);
    if (!wall.has_outline) return;
    in.across1 = dot(wall.e1, x), in.across2 = dot(wall.e2, x);
    in.slip1 = dot(wall.e1, v), in.slip2 = dot(wall.e2, v);
}

// The same without the rates, which is cheaper.
template <class P, class T>
ARM3R_INLINE Indentation<T> indentation_at_rest(const Wall<P>& wall, const WallState<T>& state, const Vec3<T>& point) {
    const Vec3<T> x = minus(point, state.position);
    const T o(0.0);
    Indentation<T> in{wall.face_offset - dot(broadcast<T>(wall.n), x), o, o, o, o, o};
    if (wall.has_outline) {
        in.across1 = dot(broadcast<T>(wall.e1), x);
        in.across2 = dot(broadcast<T>(wall.e2), x);
    }
    return in;
}

// The distance from the outline, m: negative beside the plate (4.7).
template <class P, class T>
ARM3R_INLINE T inside_outline(const Wall<P>& wall, const Indentation<T>& in) {
    return min(T(wall.half1 - abs(in.across1)), T(wall.half2 - abs(in.across2)));
}

}  // namespace arm3r

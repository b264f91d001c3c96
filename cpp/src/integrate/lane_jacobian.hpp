#pragma once
// The Jacobian of the equations of motion of a lane whose controller remembers something, exact to rounding, by Dual: what the
// stiff method needs; docs/model.md (5.6). It is compiled once, for lanes of any width.

#include <optional>

#include "arm3r/numbers/lane_access.hpp"
#include "arm3r/ode/linearization.hpp"
#include "arm3r/plant.hpp"
#include "control/compiled_laws.hpp"

namespace arm3r {

// What the equations of a lane take besides time and state, constant within a step.
struct LaneInputs {
    ContactForceMode force_mode;
    bool touching, separated;
    double contact, force_phase, latest;
    Vec3<double> held_torque;
};

class LaneJacobian {
public:
    void load(const Plant<double>& plant);
    // f and its Jacobian at (t, y).
    void find(const LaneInputs& inputs, double t, const State<double, full_size>& y, State<double, full_size>& f0,
              Linearization<full_size>& jacobian);

private:
    using D = Dual<derivatives_per_pass>;

    std::optional<Plant<double>> plant_;
    std::optional<RightHandSide<double, D>> rhs_;
};

// Of all lanes; its functions are those of MotionJacobian.
template <class T>
class LaneJacobians {
public:
    using Mask = typename Lanes<T>::Mask;
    using Y = State<T, full_size>;

    void load_lane(int lane, const Plant<double>& plant) { of_lane_[lane].load(plant); }
    void find(const Mask& here, const RightHandSide<T, T>& rhs, const Vec3<T>& held_torque, const T& t, const Y& y,
              Y& f0, std::array<Linearization<full_size>, Lanes<T>::count>& jacobians) {
        for (int lane = 0; lane < Lanes<T>::count; ++lane) {
            if (!Lanes<T>::is(here, lane)) continue;
            const auto get = [lane](const T& x) { return Lanes<T>::get(x, lane); };
            const LaneInputs inputs{rhs.force_mode,
                                    Lanes<T>::is(rhs.touching, lane),
                                    Lanes<T>::is(rhs.separated, lane),
                                    get(rhs.contact),
                                    get(rhs.force_phase),
                                    get(rhs.latest),
                                    {get(held_torque[0]), get(held_torque[1]), get(held_torque[2])}};
            State<double, full_size> at, f;
            for (std::size_t i = 0; i < full_size; ++i) at[i] = get(y[i]);
            of_lane_[lane].find(inputs, get(t), at, f, jacobians[lane]);
            for (std::size_t i = 0; i < full_size; ++i) Lanes<T>::set(f0[i], lane, f[i]);
        }
    }

private:
    std::array<LaneJacobian, Lanes<T>::count> of_lane_;
};

// The fastest rate of the equations, 1/s: from df/dy of the velocities, and from the square root of that of the
// positions.
template <std::size_t N>
double fastest_answer(const Linearization<N>& jacobian);

}  // namespace arm3r

#pragma once
// The Jacobian of the equation of motion of a plant without a controller's memory, in lanes, exact to rounding: the equation is
// recorded once and differentiated by a forward sweep; docs/model.md (5.6).

#include <memory>

#include "arm3r/ode/linearization.hpp"
#include "arm3r/plant.hpp"
#include "integrate/forward_sweep.hpp"

namespace arm3r {

// What the tip may do to a plate where an equation is recorded: nothing, press it, or press it in some lanes and be about to
// leave it in others.
enum class RecordedContact { none, pressed, released };
inline constexpr std::size_t recorded_contacts = 3;

// The equation of motion of plants that have the same choices.
struct RecordedMotion {
    RecordedMotion(const Plant<double>& choices, RecordedContact contact);

    ForwardSweep sweep;
};

template <class T>
class MotionJacobian {
public:
    using Mask = typename Lanes<T>::Mask;
    using Y = State<T, state_size>;

    // The choices of all lanes are the same.
    void load_lane(int lane, const Plant<double>& plant);
    // f and its Jacobian at (t, y), `here`, with rhs.begin_step(y) done.
    void find(const Mask& here, const RightHandSide<T, T>& rhs, const Vec3<T>& held_torque, const T& t, const Y& y,
              Y& f0, std::array<Linearization<state_size>, Lanes<T>::count>& jacobians);

private:
    struct Played {
        RecordedMotion motion;
        AlignedVector<T> numbers;  // by slot
        bool has_numbers_of_plants = false;
    };

    Played& played(RecordedContact contact);
    void set_wall(const Mask& here, const T& seen, const T& latest, Played& run) const;

    std::array<std::unique_ptr<Plant<double>>, Lanes<T>::count> plants_;
    AlignedVector<T> numbers_;  // of the plants
    std::array<std::unique_ptr<Played>, recorded_contacts> played_;
};

}  // namespace arm3r

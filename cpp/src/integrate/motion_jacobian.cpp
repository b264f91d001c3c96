#include "integrate/motion_jacobian.hpp"

#include "arm3r/lanes.hpp"
#include "arm3r/numbers/eigen_traits.hpp"

namespace arm3r {
namespace {

constexpr int time_variable = motion_size, variable_count = motion_size + 1;

// The inputs of a recorded motion: what changes from step to step, then the numbers of the plant.
enum Input : int {
    held_at,                           // torque
    state_at = held_at + 3,            // q, qd
    grid_at = state_at + motion_size,  // the points of the grid of angles that are nearest (plant.hpp), and their sines
    pose_at = grid_at + 3,             // and cosines
    time_at = pose_at + 6,             // at which formulas of time are evaluated
    wall_at_time = time_at + 1,        // WallState
    touching_at = wall_at_time + 12,   // 1 or 0
    separated_at,                      // 1 or 0
    numbers_at
};

// Calls f for each number that motions of these plants use.
template <class F, class... Plants>
void each_number_of_motion(F f, Plants&... plants) {
    each_number(f, plants...);
    if ((... && plants.external_force.on)) each_external_force_number(f, plants.external_force...);
}

// Calls f(x, depends) for each number of a wall's state, in the order of the inputs; `depends`: on time.
template <class Wall, class State, class F>
void each_wall_number(const Wall& wall, State& state, F f) {
    const bool moves = wall.motion != Motion::fixed, bends = moves && wall.motion != Motion::constant;
    const bool turns = wall.rotation != Rotation::none;
    for (int i = 0; i < 3; ++i) f(state.position[i], moves);
    for (int i = 0; i < 3; ++i) f(state.velocity[i], bends);
    for (int i = 0; i < 3; ++i) f(state.acceleration[i], bends);
    f(state.turned.sin, turns), f(state.turned.cos, turns), f(state.turn_rate, turns);
}

// Records the motion, and describes its inputs.
class Recorder {
public:
    Recorder(const Plant<double>& choices, RecordedContact contact) : choices_(choices), contact_(contact) {
        choices_.wall.table.reset(), choices_.controller.reference.table.reset();
        copy_choices(choices_, plant_);
    }

    ForwardSweep sweep() {
        const Vec3<Expr> held = vector();
        State<Expr, state_size> y, dy;
        for (std::size_t i = 0; i < motion_size; ++i) y[i] = input({true, static_cast<int>(i)});
        const Pose<Expr> p = pose_near_grid(y);
        const Expr t = input({true, time_variable});
        WallState<Expr> wall;
        each_wall_number(choices_.wall, wall, [this](Expr& x, bool depends_on_time) {
            x = input({true, depends_on_time ? time_variable : -1});
        });
        const Expr touching = input({true}), separated = input({true});
        each_number_of_motion([this](Expr& x) { x = input({false}); }, plant_);
        plant_.held_torque = held;

        RightHandSide<Expr, Expr> rhs(plant_);
        if (contact_ != RecordedContact::none) rhs.force_mode = ContactForceMode::pressed;
        rhs.touching = touching > 0.0;
        if (contact_ == RecordedContact::released) rhs.separated = separated > 0.0;
        Vec3<Expr> tau;
        rhs.derivative_at_wall(t, wall, p, y, dy, tau);
        for (const Expr& component : dy) tape_.output(component);
        return ForwardSweep(tape_, inputs_, variable_count);
    }

private:
    Expr input(SweepInput kind) {
        inputs_.push_back(kind);
        return tape_.input();
    }
    Vec3<Expr> vector() {
        const Expr x = input({true}), y = input({true}), z = input({true});
        return {x, y, z};
    }
    // As the steps take it: rotated from the grid.
    Pose<Expr> pose_near_grid(const State<Expr, state_size>& y) {
        const Vec3<Expr> grid = vector(), angles{y[0], y[1], y[1] + y[2]};
        std::array<SinCos<Expr>, 3> turned;
        for (int i = 0; i < 3; ++i) {
            const Expr sine = input({true}), cosine = input({true});
            turned[i] = sincos_rotated(SinCos<Expr>{sine, cosine}, Expr(angles[i] - grid[i]));
        }
        if (!RightHandSide<double, double>(choices_).needs_azimuth()) turned[0] = {Expr(0.0), Expr(1.0)};
        return {turned[0].sin, turned[0].cos, turned[1].sin, turned[1].cos, turned[2].sin, turned[2].cos};
    }

    Plant<double> choices_;
    RecordedContact contact_;
    Tape tape_;
    std::vector<SweepInput> inputs_;
    Plant<Expr> plant_;
};

}  // namespace

RecordedMotion::RecordedMotion(const Plant<double>& choices, RecordedContact contact)
    : sweep(Recorder(choices, contact).sweep()) {}

template <class T>
void MotionJacobian<T>::load_lane(int lane, const Plant<double>& plant) {
    plants_[lane] = std::make_unique<Plant<double>>(plant);
    std::size_t i = 0;
    each_number_of_motion(
        [&](const double& x) {
            if (i == numbers_.size()) numbers_.push_back(T(0.0));
            Lanes<T>::set(numbers_[i++], lane, x);
        },
        plant);
    for (auto& one : played_)
        if (one) one->has_numbers_of_plants = false;
}

template <class T>
typename MotionJacobian<T>::Played& MotionJacobian<T>::played(RecordedContact contact) {
    std::unique_ptr<Played>& one = played_[static_cast<std::size_t>(contact)];
    if (!one) {
        one = std::make_unique<Played>(Played{RecordedMotion(*plants_[0], contact), {}});
        const ForwardSweep& sweep = one->motion.sweep;
        one->numbers.assign(sweep.slots(), T(0.0));
        for (std::size_t i = 0; i < sweep.constants().size(); ++i) one->numbers[i] = T(sweep.constants()[i]);
        for (int k = 0; k < static_cast<int>(motion_size); ++k)
            one->numbers[sweep.slope(sweep.input(state_at + k), k)] = T(1.0);
    }
    if (one->has_numbers_of_plants) return *one;
    const ForwardSweep& sweep = one->motion.sweep;
    for (std::size_t i = 0; i < numbers_.size(); ++i) one->numbers[sweep.input(numbers_at + i)] = numbers_[i];
    T* const numbers = one->numbers.data();
    Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { sweep.evaluate_fixed(numbers); });
    one->has_numbers_of_plants = true;
    return *one;
}

// The wall at an instant of each lane, with its derivatives by time.
template <class T>
void MotionJacobian<T>::set_wall(const Mask& here, const T& t, const T& latest, Played& run) const {
    using D = Dual<1>;
    const ForwardSweep& sweep = run.motion.sweep;
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
        if (!Lanes<T>::is(here, lane)) continue;
        const auto set = [&](int slot, double x) { Lanes<T>::set(run.numbers[slot], lane, x); };
        const D seen = min(D::variable(Lanes<T>::get(t, lane), 0), D(Lanes<T>::get(latest, lane)));
        int at = sweep.input(time_at);
        set(at, seen.number), set(sweep.slope(at, time_variable), seen.slope[0]);
        const Wall<double>& plate = plants_[lane]->wall;
        if (!plants_[lane]->has_wall) continue;
        const WallState<D> wall = wall_at(plate, seen);
        int i = wall_at_time;
        each_wall_number(plate, wall, [&](const D& x, bool depends_on_time) {
            at = sweep.input(i++);
            set(at, x.number);
            if (depends_on_time) set(sweep.slope(at, time_variable), x.slope[0]);
        });
    }
}

template <class T>
void MotionJacobian<T>::find(const Mask& here, const RightHandSide<T, T>& rhs, const Vec3<T>& held_torque, const T& t,
                             const Y& y, Y& f0, std::array<Linearization<state_size>, Lanes<T>::count>& jacobians) {
    const bool presses = rhs.force_mode != ContactForceMode::none && any(rhs.touching);
    Played& run = played(!presses             ? RecordedContact::none
                         : any(rhs.separated) ? RecordedContact::released
                                              : RecordedContact::pressed);
    const ForwardSweep& sweep = run.motion.sweep;
    set_wall(here, t, rhs.latest, run);
    T* const numbers = run.numbers.data();
    Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA {
        const T zero(0.0), one(1.0);
        const auto set = [&](int input, const T& x) ARM3R_INLINE_LAMBDA { numbers[sweep.input(input)] = x; };
        const Pose<T>& grid = rhs.pose_of_grid();
        const T* const of_grid[] = {&grid.S1, &grid.C1, &grid.S2, &grid.C2, &grid.S23, &grid.C23};
        for (int i = 0; i < 3; ++i) set(held_at + i, held_torque[i]), set(grid_at + i, rhs.angles_of_grid()[i]);
        for (int i = 0; i < 6; ++i) set(state_at + i, y[i]), set(pose_at + i, *of_grid[i]);
        set(touching_at, select(rhs.touching, one, zero));
        set(separated_at, select(rhs.separated, one, zero));
        sweep.evaluate_changing(numbers);
        for (std::size_t i = 0; i < state_size; ++i) f0[i] = select(here, numbers[sweep.output(i)], f0[i]);
    });
    for (int lane = 0; lane < Lanes<T>::count; ++lane) {
        if (!Lanes<T>::is(here, lane)) continue;
        for (std::size_t i = 0; i < state_size; ++i) {
            const auto slope = [&](int variable) {
                const int slot = sweep.slope(sweep.output(i), variable);
                return slot < 0 ? 0.0 : Lanes<T>::get(numbers[slot], lane);
            };
            for (std::size_t k = 0; k < motion_size; ++k) jacobians[lane].df_dy[i][k] = slope(k);
            jacobians[lane].df_dt[i] = slope(time_variable);
        }
    }
}

#define ARM3R_MOTION_JACOBIAN(T) template class MotionJacobian<T>;
ARM3R_LANE_TYPES(ARM3R_MOTION_JACOBIAN)

}  // namespace arm3r

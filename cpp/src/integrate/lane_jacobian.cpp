#include "integrate/lane_jacobian.hpp"

#include <algorithm>
#include <cmath>

namespace arm3r {

void LaneJacobian::load(const Plant<double>& plant) {
    rhs_.reset();
    plant_.emplace(plant);
    rhs_.emplace(*plant_);
    rhs_->law_function = compiled_law<double, D>();
}

void LaneJacobian::find(const LaneInputs& inputs, double t, const State<double, full_size>& y,
                        State<double, full_size>& f0, Linearization<full_size>& jacobian) {
    plant_->held_torque = inputs.held_torque;
    rhs_->force_mode = inputs.force_mode;
    rhs_->touching = inputs.touching;
    rhs_->separated = inputs.separated;
    rhs_->contact = D(inputs.contact);
    rhs_->force_phase = D(inputs.force_phase);
    rhs_->latest = D(inputs.latest);
    constexpr std::size_t memory = std::size_t(full_size) - std::size_t(state_size);
    linearize<motion_size, quadrature_count, derivatives_per_pass>(*rhs_, t, y, memory, f0, jacobian);
}

template <std::size_t N>
double fastest_answer(const Linearization<N>& jacobian) {
    double by_rate = 0, by_place = 0;
    for (std::size_t i = 3; i < N; i = i + 1 == motion_size ? state_size : i + 1) {
        double rate = 0, place = 0;
        for (std::size_t j = 0; j < N; j = j + 1 == motion_size ? state_size : j + 1)
            (j < 3 ? place : rate) += std::abs(jacobian.df_dy[i][j]);
        by_rate = std::max(by_rate, rate);
        by_place = std::max(by_place, place);
    }
    return by_rate + std::sqrt(by_place);
}

template double fastest_answer(const Linearization<state_size>&);
template double fastest_answer(const Linearization<full_size>&);

}  // namespace arm3r

#include <algorithm>

#include "integrate/taylor_expand.hpp"

namespace arm3r {
namespace {

Recipe needs(const Plant<double>& plant, bool pressed) {
    const Arm<double>& arm = plant.arm;
    const Controller<double>& controller = plant.controller;
    const bool compensates = controller.type == ControllerType::gravity_compensation;
    return {.torque = plant.holds_torque ? TorqueSource::held
                      : compensates      ? TorqueSource::gravity_compensation
                                         : TorqueSource::none,
            .damping = arm.has_damping,
            .signals = plant.has_wall,
            .force = pressed,
            .oblique = !arm.gravity_is_vertical || (compensates && !controller.model.gravity_is_vertical),
            .friction = arm.has_dry_friction,
            .even_wall = moves_evenly(plant.wall),
            .elbow = arm.is_elbow};
}

bool covers(const Recipe& recipe, const Recipe& needed) {
    const bool has_torque =
        recipe.torque == needed.torque || (needed.torque == TorqueSource::none && recipe.torque == TorqueSource::held);
    return has_torque && recipe.elbow == needed.elbow && recipe.damping >= needed.damping &&
           recipe.oblique >= needed.oblique && recipe.even_wall <= needed.even_wall &&
           recipe.signals >= needed.signals && recipe.force >= needed.force && recipe.friction >= needed.friction;
}

}  // namespace

Kernel kernel_of(const Plant<double>& plant, bool pressed) {
    const auto fits = [needed = needs(plant, pressed)](const Recipe& recipe) { return covers(recipe, needed); };
    return Kernel(std::find_if(recipes.begin(), recipes.end(), fits) - recipes.begin());
}

template void expand(Kernel, const Plant<double>&, const double&, const State<double, state_size>&, const Pose<double>&,
                     int, Expansion<double>&);

int order_of(double tol) {
    constexpr double each_order = 0x1.152aaa3bf81ccp-3;  // exp(-2)
    int order = 1;
    for (double reached = 1; reached > tol && order < max_degree; reached *= each_order) ++order;
    return std::max(order, 2);
}

}  // namespace arm3r

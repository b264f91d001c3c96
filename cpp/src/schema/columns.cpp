#include "schema/columns.hpp"

namespace arm3r {

std::string_view need_text(Need need) {
    switch (need) {
        case Need::nothing: return "";
        case Need::wall: return "only with a wall";
        case Need::force_reference: return "only with a law that controls force";
        case Need::path: return "only with a law that follows a path of the tip";
        case Need::joint_path: return "only with a law that follows a path of the joints";
        case Need::observer: return "only with an observer";
        case Need::estimator: return "only with an estimator";
        case Need::tank: return "only with an energy tank";
        case Need::loss: return "only where energy can be lost: in the joints, or at a wall that acts on the arm";
        default: return "only with torque limits and a control law";
    }
}

std::string_view need_hint(Need need) {
    switch (need) {
        case Need::nothing: return "";
        case Need::wall: return "add `wall: {}`";
        case Need::force_reference: return "choose a controller.type that controls a force, such as hybrid";
        case Need::path: return "choose a controller.type that follows the tip, such as impedance, and a reference";
        case Need::joint_path: return "choose controller.type joint_pd or computed_torque, and a reference";
        case Need::observer: return "add `observer: {}`";
        case Need::estimator: return "add `estimator: {}`";
        case Need::tank: return "choose controller.type energy_tank";
        case Need::loss: return "give arm.damping or arm.friction, or a wall that acts on the arm and damps";
        default: return "give arm.torque_limit, and choose a controller.type";
    }
}

}  // namespace arm3r

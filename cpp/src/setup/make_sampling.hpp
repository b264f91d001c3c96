#pragma once
// The part of make_setup() (setup.hpp) that concerns what stands between a controller and the arm.

#include "setup/setup.hpp"

namespace arm3r {

Sampling<double> make_sampling(std::span<const double> params);
Sensors<double> make_sensors(std::span<const double> params);
Observer<double> make_observer(std::span<const double> params);
Estimation<double> make_estimation(std::span<const double> params, const Contact<double>& contact);
ExternalForce<double> make_external_force(std::span<const double> params);

}  // namespace arm3r

#pragma once
// Why a run ended before its time, in words that every method shares.

#include <string>

namespace arm3r {

std::string steps_used_up(double t);
std::string event_storm(double t);

}  // namespace arm3r

#pragma once
// Why a run ended before its time, in words that every method shares.

#include <string>

namespace arm3r {

std::string step_budget_message(double t);
std::string event_storm_message(double t);

}  // namespace arm3r

#pragma once
// What a summary says of how far its run can be trusted.

#include <optional>
#include <string>

#include "trust/closed_forms.hpp"
#include "trust/horizon.hpp"

namespace arm3r {

std::string json(const ClosedForms& found);
std::string json(const Horizon& horizon);

std::string closed_form_lines(const ClosedForms& found);  // "" where none says something
std::string horizon_line(const Horizon& horizon);

}  // namespace arm3r

#pragma once
// Refuses runs before they start that would need more rows, steps or samples than the limits allow.

#include "setup/setup.hpp"

namespace arm3r {

// rows: whether they are wanted. Throws Error ARM3R_E_SIZE_CAP.
void refuse_too_large(const Setup& setup, bool rows = true);

// Whether steps of a fixed length, or the samples of a controller, are more than allowed.
bool has_too_many_steps(const Setup& setup);

// Which columns of column_table a run has, in order.
std::vector<std::size_t> columns_of(const Setup& setup);

}  // namespace arm3r

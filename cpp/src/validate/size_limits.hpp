#pragma once
// Refuses runs before they start that would need more rows, steps or samples than the limits allow.

#include "setup/setup.hpp"

namespace arm3r {

// rows: whether they are wanted. Throws Error ARM3R_E_SIZE_CAP.
void refuse_too_large(const Setup& setup, bool rows = true);

// Whether steps of a fixed length, or the samples of a controller, are more than allowed.
bool has_too_many_steps(const Setup& setup);

// Which columns of column_table a run can have.
ColumnSet possible_columns(const Setup& setup);

// Which of them stand in its log, in order; and a problem for each that is asked for, at `path`, and that the run
// cannot have.
std::vector<std::size_t> columns_of(const Setup& setup);
std::vector<Problem> missing_columns(const Setup& setup, const std::string& path = "time.log_columns");

std::vector<std::size_t> in_order(const ColumnSet& columns);

}  // namespace arm3r

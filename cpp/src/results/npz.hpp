#pragma once
// A run as one file that numpy.load reads: a ZIP archive, stored and not compressed, with an array for each column under
// its name, and the summary as summary.json. The same run gives the same bytes.

#include <functional>
#include <string_view>

#include "record/run_data.hpp"

namespace arm3r {

// In pieces, which the sink takes.
void write_npz(const Run& run, const std::function<std::string_view()>& summary,
               const std::function<void(std::string_view)>& sink);

}  // namespace arm3r

#pragma once
// Memory for the rows of a run: one block, in large pages where the system offers them. A run of 10 000 rows is over in
// less time than it takes to be given its memory in small pages.

#include <cstddef>
#include <memory>

namespace arm3r {

struct FreeRows {
    void operator()(double* block) const;
};

using RowMemory = std::unique_ptr<double[], FreeRows>;

// Not initialised. Throws std::bad_alloc.
RowMemory allocate_rows(std::size_t doubles);

}  // namespace arm3r

#include "row_memory.hpp"

#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace arm3r {

void FreeRows::operator()(double* block) const { std::free(block); }

RowMemory allocate_rows(std::size_t doubles) {
    constexpr std::size_t large_page = std::size_t{1} << 21, cache_line = 64;
    const std::size_t wanted = doubles * sizeof(double);
    const std::size_t unit = wanted >= large_page / 2 ? large_page : cache_line;
    const std::size_t bytes = (wanted + unit - 1) / unit * unit;
    void* block = std::aligned_alloc(unit, bytes);
    if (!block) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    if (unit == large_page) madvise(block, bytes, MADV_HUGEPAGE);  // advice: nothing depends on it being taken
#endif
    return RowMemory(static_cast<double*>(block));
}

}  // namespace arm3r

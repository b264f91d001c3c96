#pragma once
// Aligned memory.

#include <cstddef>

namespace arm3r::platform {

// `bytes` is a multiple of `alignment`, which is a power of two. nullptr: there is not enough memory.
void* allocate_aligned(std::size_t alignment, std::size_t bytes) noexcept;
void free_aligned(void* block) noexcept;

// Asks for large pages, where the system has them. Nothing depends on the answer.
void advise_large_pages(void* block, std::size_t bytes) noexcept;

}  // namespace arm3r::platform

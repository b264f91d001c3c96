#pragma once
// One lane of a number: of a double, which has one, or of a pack. And arrays of such numbers.

#include <cstddef>
#include <new>
#include <vector>

#include "arm3r/numbers/pack.hpp"

namespace arm3r {

template <class T>
struct Lanes {
    static constexpr int count = 1;
    using Mask = bool;
    static double get(const T& x, int) { return x; }
    static void set(T& x, int, double value) { x = value; }
    static bool is(bool mask, int) { return mask; }
    static void mark(bool& mask, int, bool here) { mask = here; }
};

template <int N>
struct Lanes<Pack<N>> {
    static constexpr int count = N;
    using Mask = PackMask<N>;
    static double get(const Pack<N>& x, int lane) { return x[lane]; }
    static void set(Pack<N>& x, int lane, double value) { x.set(lane, value); }
    static bool is(const Mask& mask, int lane) { return mask[lane]; }
    static void mark(Mask& mask, int lane, bool here) { mask.set(lane, here); }
};

// Arrays on the heap, at addresses that packs of eight can be read from (README, g++ 7).
template <class T>
struct CacheLineAllocator {
    using value_type = T;
    static constexpr std::align_val_t alignment{64};

    CacheLineAllocator() = default;
    template <class U>
    CacheLineAllocator(const CacheLineAllocator<U>&) {}

    T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), alignment)); }
    void deallocate(T* block, std::size_t) { ::operator delete(block, alignment); }
    bool operator==(const CacheLineAllocator&) const { return true; }
};

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

}  // namespace arm3r

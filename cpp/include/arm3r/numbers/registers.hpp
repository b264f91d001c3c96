// The vector registers of this processor.
#pragma once

#if defined(__x86_64__) && defined(__clang__)
#include <cpuid.h>
#endif

namespace arm3r {

// The most doubles that a register holds and the compiled variants of this build use: 8, 4 or 2. Another number of lanes
// gives the same bits.
#if defined(__x86_64__) && defined(__clang__)
// Asked of the processor, because some of clang's run-time libraries (zig's) have no answer for __builtin_cpu_supports.
// The operating system must save the registers, too, which the bits of XCR0 say.
inline int ask_for_register_width() {
    unsigned a = 0, b = 0, c = 0, d = 0;
    constexpr unsigned avx = bit_OSXSAVE | bit_AVX | bit_FMA;
    if (!__get_cpuid(1, &a, &b, &c, &d) || (c & avx) != avx) return 2;
    unsigned saved = 0, upper = 0;
    __asm__("xgetbv" : "=a"(saved), "=d"(upper) : "c"(0));
    constexpr unsigned avx2 = bit_AVX2 | bit_BMI | bit_BMI2;
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d) || (b & avx2) != avx2 || (saved & 0x6) != 0x6) return 2;
    constexpr unsigned avx512 = bit_AVX512F | bit_AVX512BW | bit_AVX512CD | bit_AVX512DQ | bit_AVX512VL;
    return (b & avx512) == avx512 && (saved & 0xe6) == 0xe6 ? 8 : 4;
}
inline int register_width() {
    static const int width = ask_for_register_width();
    return width;
}
#elif defined(__x86_64__)
inline int register_width() {
    return __builtin_cpu_supports("x86-64-v4") ? 8 : __builtin_cpu_supports("x86-64-v3") ? 4 : 2;
}
#else
inline int register_width() { return 2; }
#endif

}  // namespace arm3r

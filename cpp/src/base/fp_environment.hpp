#pragma once
// The floating-point environment of the calling thread: rounding mode, traps, and what happens to subnormal numbers.
// Results must not depend on what the host has set there.

#include <cfenv>
#include <cstdint>

namespace arm3r {

#if defined(__x86_64__)

// The control words of SSE and of the x87 unit; the flags of exceptions that have occurred are left out.
struct FpControl {
    std::uint32_t sse = 0x1F80;
    std::uint16_t x87 = 0x037F;

    static FpControl current() {
        FpControl control;
        asm volatile("stmxcsr %0" : "=m"(control.sse));
        asm volatile("fnstcw %0" : "=m"(control.x87));
        return control;
    }
    void load() const {
        asm volatile("ldmxcsr %0" : : "m"(sse));
        asm volatile("fldcw %0" : : "m"(x87));
    }
    bool is_default() const {
        constexpr std::uint32_t flags = 0x3F;
        const FpControl standard;
        return (sse & ~flags) == standard.sse && x87 == standard.x87;
    }
};

#elif defined(__wasm__)

// WebAssembly has no other environment.
struct FpControl {
    static FpControl current() { return {}; }
    void load() const {}
    bool is_default() const { return true; }
};

#elif defined(__aarch64__)

// The control register: 0 is the standard environment.
struct FpControl {
    std::uint64_t fpcr = 0;

    static FpControl current() {
        FpControl control;
        asm volatile("mrs %0, fpcr" : "=r"(control.fpcr));
        return control;
    }
    void load() const { asm volatile("msr fpcr, %0" : : "r"(fpcr)); }
    bool is_default() const { return fpcr == 0; }
};

#else

struct FpControl {
    bool standard = true;
    std::fenv_t environment{};  // where it is another one. FE_DFL_ENV may be no address that can be read

    static FpControl current() {
        FpControl control;
        control.standard = false;
        std::fegetenv(&control.environment);
        return control;
    }
    void load() const { std::fesetenv(standard ? FE_DFL_ENV : &environment); }
    bool is_default() const { return false; }
};

#endif

// Sets the standard environment: round to nearest, no traps, subnormal numbers kept.
inline void set_standard_fp_environment() {
    if (!FpControl::current().is_default()) FpControl{}.load();
}

// The standard environment as long as this lives, then the caller's again.
class StandardFpEnvironment {
public:
    StandardFpEnvironment() : callers_(FpControl::current()) {
        if (!callers_.is_default()) FpControl{}.load();
    }
    ~StandardFpEnvironment() {
        if (!callers_.is_default()) callers_.load();
    }
    StandardFpEnvironment(const StandardFpEnvironment&) = delete;
    StandardFpEnvironment& operator=(const StandardFpEnvironment&) = delete;

private:
    const FpControl callers_;
};

}  // namespace arm3r

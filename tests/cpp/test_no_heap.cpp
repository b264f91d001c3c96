#include <atomic>
#include <cstdlib>
#include <new>

#include "check.hpp"
#include "fixtures.hpp"

// Every allocation of the program is counted.
static std::atomic<long> allocations{0};

[[gnu::noinline]] void* operator new(std::size_t size) {
    allocations += 1;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace arm3r {

TEST_SUITE(no_heap)

static long allocations_of(const Params& params) {
    const long before = allocations;
    const Run run = params.run();
    CHECK(run.outcome == ARM3R_RUN_OK, run.message);
    CHECK(run.events.size() >= 2u);
    return allocations - before;
}

static Params touched(const char* method, const char* algorithm) {
    Params params =
        unequal_params().choose("controller.type", "gravity_compensation").choose("controller.algorithm", algorithm);
    params.set("wall", 1)
        .set("wall.acts_on_arm", 1)
        .set("wall.point", {1.3, 0, 0})
        .choose("wall.motion.type", "sinusoid");
    params.set("wall.motion.amplitude", 0.3)
        .set("wall.motion.frequency", 2)
        .set("arm.damping", {1, 1, 1})
        .choose("solver.method", method);
    return params;
}

TEST_CASE(a_run_ten_times_longer_allocates_no_more_often) {
    for (const char* method : {"dopri5", "rk4"}) {
        for (const char* algorithm : {"closed_form", "recursion"}) {
            const Params params = touched(method, algorithm);
            const auto of_length = [&](double stop) { return allocations_of(Params(params).set("time.stop", stop)); };
            of_length(0.5);  // the first run of all makes the tables
            const long brief = of_length(0.5);
            CHECK(brief > 0);
            CHECK(of_length(5) == brief);
        }
    }
}

TEST_SUITE_END()

}  // namespace arm3r

#pragma once
// The loop of a run by any method, alone or in lanes. A method is a lane run (lane_run.hpp) with take_step(), which tries a step
// of every lane up to the sample at its end and returns whether a lane has moved, and finish_step(), the sample and the rest.

#include "lanes/lane_run.hpp"

namespace arm3r {

template <class Method>
class RunLoop : public Method {
    static constexpr bool is_alone = Method::lanes == 1;

public:
    using Method::Method;

    // The lanes that were loaded since the last call stand at their start, and take their first sample.
    ARM3R_INLINE void start() {
        this->place_lanes();
        if constexpr (is_alone) start_steps_outlined();
        else this->start_steps();
    }

    // A step of `count` lane runs with the same batch key.
    ARM3R_INLINE static void step_together(RunLoop* const* runs, int count) {
        if constexpr (Method::together > 1) {
            Method* methods[Method::together];
            for (int i = 0; i < count; ++i) methods[i] = runs[i];
            Method::step_by_stages(methods, count);
        } else {
            if (runs[0]->take_step()) runs[0]->finish_step();
        }
    }

    // Of a run alone: a step, and before it all that are free of events and end before `until`, s, as far as the method can
    // take these at once. A request to stop waits for them.
    void advance(double until)
        requires is_alone
    {
        constexpr int most = 64;
        if constexpr (requires { this->take_event_free_steps(until, most); })
            this->take_event_free_steps(until, most - 1);
        if (take_step_outlined()) finish_step_outlined();
    }
    // Each part is compiled once.
    [[gnu::noinline]] void start_steps_outlined()
        requires is_alone
    {
        this->start_steps();
    }
    [[gnu::noinline]] bool take_step_outlined()
        requires is_alone
    {
        return this->take_step();
    }
    [[gnu::noinline]] void finish_step_outlined()
        requires is_alone
    {
        this->finish_step();
    }
};

}  // namespace arm3r

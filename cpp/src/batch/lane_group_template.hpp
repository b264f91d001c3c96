#pragma once
// Runs of one structure that march in lanes, by one method; each method is built in a file of its own.

#include <memory>

#include "batch/lane_group.hpp"

namespace arm3r {

// Lets runs of one structure march until there are no more.
template <class Marching>
class Lineup {
public:
    Lineup(Crew& crew, const Setup& first, std::size_t run)
        : crew_(crew), structure_(structure_of(first)), march_(first) {
        march_.put(0, first);
        run_[0] = run;
        for (int lane = 1; lane < Marching::lanes; ++lane) fill(lane);
    }

    ARM3R_INLINE void run() {
        march_.begin();
        while (true) {
            while ((march_.someone_ended() || crew_.is_stopped()) && turn_over()) march_.begin();
            if (!march_.is_anyone_running()) return;
            march_.step([](int, const Change&) {});
        }
    }

private:
    bool fill(int lane) {
        Setup setup;
        const bool found = crew_.next(structure_, setup, run_[lane]);
        if (found) march_.put(lane, setup);
        return found;
    }

    // Those that have ended make room for the next; whether there are any.
    [[gnu::noinline]] bool turn_over() {
        bool anyone_new = false;
        march_.forget_failures();
        for (int lane = 0; lane < Marching::lanes; ++lane) {
            if (!march_.is_running(lane)) continue;
            if (crew_.is_stopped() && !march_.has_ended(lane)) march_.stop_lane(lane, ARM3R_RUN_STOPPED);
            if (!march_.has_ended(lane)) continue;
            crew_.store(run_[lane], march_.metrics(lane));
            if (fill(lane)) anyone_new = true;
            else march_.retire(lane);
        }
        return anyone_new;
    }

    Crew& crew_;
    const Structure structure_;
    Marching march_;
    std::array<std::size_t, Marching::lanes> run_{};
};

// Packs as wide as the registers: wider ones are slow.
template <template <class> class Marching>
struct Lineups {
    static void one(Crew& crew, const Setup& first, std::size_t run) { march<double>(crew, first, run); }
#if !ARM3R_ONE_LANE
    static void two(Crew& crew, const Setup& first, std::size_t run) { march<Pack<2>>(crew, first, run); }
#endif
#if ARM3R_WIDE_PACKS
    ARM3R_FOR_FOUR static void four(Crew& crew, const Setup& first, std::size_t run) {
        march<Pack<4>>(crew, first, run);
    }
    ARM3R_FOR_EIGHT static void eight(Crew& crew, const Setup& first, std::size_t run) {
        march<Pack<8>>(crew, first, run);
    }
#endif

    template <class T>
    ARM3R_INLINE static void march(Crew& crew, const Setup& first, std::size_t run) {
        std::make_unique<Lineup<Marching<T>>>(crew, first, run)->run();
    }

    static void of(int lanes, Crew& crew, const Setup& first, std::size_t run) {
        switch (lanes) {
            case 1: return one(crew, first, run);
#if !ARM3R_ONE_LANE
            case 2: return two(crew, first, run);
#endif
#if ARM3R_WIDE_PACKS
            case 4: return four(crew, first, run);
            case 8: return eight(crew, first, run);
#endif
            default: return one(crew, first, run);
        }
    }
};

}  // namespace arm3r

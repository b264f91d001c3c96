#include "crew.hpp"

#include <limits>
#include <memory>
#include <utility>

#include "fixed_march.hpp"
#include "runs.hpp"
#include "size_cap.hpp"
#include "summary.hpp"
#include "taylor_march.hpp"

namespace arm3r {
namespace {

constexpr std::size_t runs_at_a_time = 256, most_aside = 1024;

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
    static void two(Crew& crew, const Setup& first, std::size_t run) { march<Pack<2>>(crew, first, run); }
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
#if ARM3R_WIDE_PACKS
            case 4: return four(crew, first, run);
            case 8: return eight(crew, first, run);
#endif
            default: return two(crew, first, run);
        }
    }
};

}  // namespace

Crew::Crew(Work& work) : work_(work), params_(work.variation.params.begin(), work.variation.params.end()) {}

void Crew::run() {
    std::size_t run;
    Setup setup;
    while (take(run))
        if (prepare(run, setup)) march(setup, run);
}

void Crew::march(const Setup& first, std::size_t run) {
    if (first.solver.method == Solver::dopri5) {
        store(run, run_adaptively(params_, {.should_stop = &work_.stop, .rows = false}));
    } else {
        const auto lineups = first.solver.method == Solver::rk4 ? Lineups<FixedMarch>::of : Lineups<TaylorMarch>::of;
        lineups(work_.lanes, *this, first, run);
        again_.insert(again_.end(), aside_.begin(), aside_.end());
        aside_.clear();
    }
}

bool Crew::next(const Structure& structure, Setup& setup, std::size_t& run) {
    while (aside_.size() < most_aside && take(run)) {
        if (!prepare(run, setup)) continue;
        if (structure_of(setup) == structure) return true;
        aside_.push_back(run);
    }
    return false;
}

bool Crew::take(std::size_t& run) {
    if (first_ == last_ && again_.empty()) {
        const std::size_t runs = work_.variation.runs;
        first_ = std::min(runs, work_.next.fetch_add(runs_at_a_time));
        last_ = std::min(runs, first_ + runs_at_a_time);
    }
    if (first_ < last_) {
        run = first_++;
        return true;
    }
    if (again_.empty()) return false;
    run = again_.back();
    again_.pop_back();
    return true;
}

// False where there is nothing to simulate: its row is then filled in.
bool Crew::prepare(std::size_t run, Setup& setup) {
    const Variation& variation = work_.variation;
    for (std::size_t j = 0; j < variation.varied.size(); ++j)
        params_[variation.varied[j]] = variation.values[j * variation.runs + run];
    if (is_stopped()) return refuse(run, ARM3R_RUN_STOPPED), false;
    if (!work_.is_valid(params_)) return refuse(run, ARM3R_RUN_INVALID), false;
    setup = make_setup(params_);
    if (has_too_many_steps(setup)) return refuse(run, ARM3R_RUN_BUDGET), false;
    return true;
}

void Crew::store(std::size_t run, const Metrics& metrics) {
    double* cell = work_.results + run;
    for (const SummaryNumber& number : summary_table()) {
        *cell = number.of(metrics) + 0.0;
        cell += work_.variation.runs;
    }
    work_.done.fetch_add(1, std::memory_order_relaxed);
}

void Crew::refuse(std::size_t run, arm3r_outcome why) {
    for (std::size_t i = 0; i < summary_table().size(); ++i)
        work_.results[i * work_.variation.runs + run] = std::numeric_limits<double>::quiet_NaN();
    work_.results[run] = double(why);  // the outcome is the first column
    work_.done.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace arm3r

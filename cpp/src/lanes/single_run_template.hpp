#pragma once
// A single run by one method, to its end or from sample to sample; each method is compiled in a file of its own.

#include "lanes/lane_record.hpp"
#include "lanes/run_loop.hpp"
#include "lanes/single_run.hpp"
#include "record/end_messages.hpp"

namespace arm3r {

template <class Method>
class SingleRun {
public:
    SingleRun(const Setup& setup, const RunOptions& options)
        : loaded_(setup), lane_run_(loaded_), record_(setup, options, lane_run_, 0) {
        lane_run_.set_user_law(options.user_law);
        observe_changes();
        lane_run_.load_lane(0, loaded_);
    }

    Run run() {
        lane_run_.start();
        record_.record_contact_at_start();
        record_.record_start();
        while (record_.goes_on()) {
            record_.forget_dense_output();
            lane_run_.advance(record_.next_row());  // several steps, as far as nothing happens in them
            record_.record_step();
            record_.update_row_context();
        }
        return record_.record_end();
    }

protected:
    // A copy continues as `other` would.
    SingleRun(const SingleRun& other) : loaded_(other.loaded_), lane_run_(loaded_), record_(other.record_, lane_run_) {
        lane_run_ = other.lane_run_;
        lane_run_.set_setup(loaded_);
        observe_changes();
    }

private:
    void observe_changes() {
        lane_run_.set_observer([this](int, const ContactChange& change) { record_.record_change(change); });
    }

    const Setup loaded_;  // while that of the record follows the torque that is held

protected:
    RunLoop<Method> lane_run_;
    LaneRecord<Method> record_;
};

// It stands where a step has reached a sample.
template <class Method>
class StandingRun : public InteractiveRun, SingleRun<Method> {
    using Base = SingleRun<Method>;
    using Base::lane_run_, Base::record_;

public:
    StandingRun(const Setup& setup, const RunOptions& options) : Base(setup, options) {
        lane_run_.place_lanes();
        record_.record_contact_at_start();
    }
    StandingRun(const StandingRun&) = default;

    bool is_over() const override { return !stands_; }
    void set_user_law(const UserLaw& law) override { lane_run_.set_user_law(law); }
    void preview(const UserLaw& law) const override { lane_run_.preview(law); }
    std::unique_ptr<InteractiveRun> copy() const override { return std::make_unique<StandingRun>(*this); }
    Run snapshot() const override { return StandingRun(*this).conclude(); }

    void advance() override {
        stands_ = false;
        has_started_ ? finish_step() : start();
        while (record_.goes_on()) {
            record_.forget_dense_output();
            const bool has_moved = lane_run_.take_step_outlined();
            if constexpr (Method::completes_before_sample) record_.record_step();
            else record_.stand_at_end();
            stands_ = has_moved && record_.is_running() && !lane_run_.has_failed() && lane_run_.stands_at_sample();
            if (stands_) return;
            if (has_moved) finish_step();
        }
    }

    Run conclude() override {
        if constexpr (!Method::completes_before_sample)
            if (stands_ && has_started_) {
                lane_run_.skip_sample();
                finish_step();
            }
        if (!is_over()) record_.stop("the simulation stands" + at_time(record_.t_end()));
        return record_.record_end();
    }

private:
    void start() {
        has_started_ = true;
        lane_run_.start_steps_outlined();
        record_.record_start();
    }
    void finish_step() {
        lane_run_.finish_step_outlined();
        if constexpr (!Method::completes_before_sample) record_.record_step();
        record_.update_row_context();
    }

    bool stands_ = true, has_started_ = false;
};

template <class Method>
SingleRunMethod single_run_by() {
    return {[](const Setup& setup, const RunOptions& options) { return SingleRun<Method>(setup, options).run(); },
            [](const Setup& setup, const RunOptions& options) -> std::unique_ptr<InteractiveRun> {
                return std::make_unique<StandingRun<Method>>(setup, options);
            }};
}

}  // namespace arm3r

#pragma once
// Runs in lanes by steps that end at events: each lane has its own step, which ends at the next sample of its controller,
// where a formula of time changes, and where its contact changes. The steps have a length that their error chooses (5.2),
// (5.6), (5.7), or one length (5.1).

#include "contact/contact_search.hpp"
#include "contact/contact_watch.hpp"
#include "integrate/step_limits.hpp"
#include "integrate/step_method.hpp"
#include "lanes/lane_run.hpp"
#include "run/singular_passage.hpp"

namespace arm3r {

template <class T, std::size_t N>
class LaneEvents : public LaneRun<T, N> {
    using Base = LaneRun<T, N>;
    using Mask = typename Base::Mask;
    using Y = typename Base::Y;
    using Method = StepMethod<T, N>;

public:
    explicit LaneEvents(const Setup& any_lane)
        : Base(any_lane, ContactFelt::by_mode),
          method_(any_lane, this->plant_, this->rhs_, this->evaluations_),
          holds_samples_(any_lane.digital.sampling.on),
          has_constant_samples_(holds_samples_ && !tracked_quantities(any_lane).motion()) {
        this->needs_derivative_ = false;
        for (int lane = 0; lane < Base::lanes; ++lane) load_steps(lane);
    }
    void load_lane(int lane, const Setup& setup) {
        Base::load_lane(lane, setup);
        load_steps(lane);
    }
    void clear_lane(int lane) {
        Base::clear_lane(lane);
        load_steps(lane);
    }

    static constexpr int together = 1;  // lane runs that a group steps together
    static constexpr bool completes_before_sample = true;

    // The first sample, and the first step of these lanes.
    ARM3R_INLINE void start_steps() {
        Mask fresh = false;
        for (int lane = 0; lane < Base::lanes; ++lane) Lanes<T>::mark(fresh, lane, this->is_new_[lane]);
        this->is_new_.fill(false);
        this->started_ = this->active_;
        sample_where(fresh);
        this->rhs_.latest = T(infinite);
        Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA {
            method_.set_start(fresh, this->t_, this->y_);
            if (method_.chooses_length()) next_h_ = select(fresh, first_step(fresh), next_h_);
        });
    }

    // Tries a step of every lane, and returns whether one of them has moved; finish_step() completes it.
    ARM3R_INLINE bool take_step() {
        const bool moves = try_step();
        if (!moves) check_budget();
        return moves;
    }
    ARM3R_INLINE bool try_step() {
        t0_ = this->t_;
        const StepEnd end = step_end();
        choose_length(end);
        moved_ = this->active_;
        const Mask collapses = moved_ && !was_last_ && this->h_ < min_step(t0_);
        if (in_any_lane(collapses)) {
            stop_collapsed(collapses);
            moved_ = moved_ && !collapses;
            if (!in_any_lane(moved_)) return false;
        }
        this->rhs_.latest = select(was_last_, end.latest, T(infinite));
        error_ = method_.attempt(moved_, t0_, this->y_, this->h_);
        const Mask accepted = error_ < T(1.0), refused = moved_ && !accepted;
        moved_ = moved_ && accepted;
        if (in_any_lane(refused)) refuse(refused);
        if (!in_any_lane(moved_)) return false;
        dense_ = method_.dense_output(t0_, this->y_, this->h_);
        if (in_any_lane(moved_ && ends_at_poses_)) {
            seek_singular_poses();
            if (!in_any_lane(moved_)) return false;
        }
        to_pose_ = select(moved_, T(infinite), to_pose_);
        end_step(end);
        return true;
    }

    // The sample that is due, and the derivative with which the next step starts.
    ARM3R_INLINE void finish_step() {
        const Mask is_new = sample_where(moved_);
        this->rhs_.latest = T(infinite);
        method_.accept(moved_, moved_ && continues_ && !is_new, this->t_, this->y_, this->h_);
        this->balance_.update_where(moved_, Energies<T>{this->kinetic_, this->potential_, this->stored(this->in_)},
                                    this->y_);
        this->balance_.add_error_where(moved_, error_);
        if (method_.chooses_length()) choose_next_length();
        else whole_steps_ = whole_steps_ + select(moved_ && this->t_ >= next_on_grid() - this->slack_, T(1.0), T(0.0));
        if (in_any_lane(moved_ && this->t_ >= knot_)) pass_knots();
        check_budget();
    }

    // Whether a formula of time may jump, or the torque, at the end of the last step that was accepted.
    bool may_jump_at_end(int lane) const { return Lanes<T>::is(may_jump_, lane); }
    double theta(int lane) const { return Lanes<T>::get(theta_, lane); }
    const Method& method() const { return method_; }
    Metrics metrics(int lane) const {
        Metrics found = Base::metrics(lane);
        found.stiff_steps = method_.stiff_steps(lane);
        return found;
    }
    // The dense output of the last step that was accepted.
    void fill_dense_output(int lane, DenseOutput& dense) const {
        const auto get = [lane](const T& x) { return Lanes<T>::get(x, lane); };
        dense.t0 = get(dense_.t0), dense.h = get(dense_.h), dense.order = -1, dense.size = N;
        for (std::size_t i = 0; i < dense_.c.size(); ++i)
            for (std::size_t j = 0; j < N; ++j) dense.c[i][j] = get(dense_.c[i][j]);
    }

private:
    // Stops the lanes that may take no further step.
    ARM3R_INLINE void check_budget() {
        const Mask used_up =
            this->active_ && this->accepted_ + this->rejected_ >= this->max_steps_ && this->t_ < this->stop_;
        if (in_any_lane(used_up)) this->stop_lanes(used_up, ARM3R_RUN_BUDGET);
    }

    // The numbers of a lane's steps, from the setup that it has.
    void load_steps(int lane) {
        const Setup& setup = this->setup(lane);
        const auto set = [lane](T& x, double value) { Lanes<T>::set(x, lane, value); };
        method_.load_lane(lane, setup);
        set(this->slack_, setup.clock_rounding());
        const Plant<double>& plant = setup.plant;
        set(max_step_, std::min(setup.solver.max_step, plant.has_wall ? max_wall_step(plant.wall) : infinite));
        set(max_turn_, std::min(0.25 * std::numbers::pi, fifth_root(1e5 * setup.solver.rtol)));
        set(next_h_, infinite), set(to_pose_, infinite);
        Lanes<T>::mark(ends_at_poses_, lane, setup.ends_steps_at_singular_poses());
        set(start_, setup.start), set(step_, method_.chooses_length() ? infinite : setup.solver.step);
        set(whole_steps_, 0.0);
        Lanes<T>::mark(was_refused_, lane, false);
        Lanes<T>::mark(had_finite_end_, lane, true);
        set_knots(lane, setup.start);
    }

    // ---- the length of a step

    // The latest end of the step and the reasons for it.
    struct StepEnd {
        T t;                            // s
        Mask is_knot, is_jump, is_due;  // a formula of time changes, or jumps; the controller is due
        T latest;                       // s, where formulas of time are evaluated at the latest (5.8)
    };

    ARM3R_INLINE StepEnd step_end() const {
        const T due = this->is_controlled_ ? this->sampled_.next() : T(infinite);
        T t = min(min(knot_, due), this->stop_);
        if (!method_.chooses_length()) t = min(t, next_on_grid());
        t = select(knot_ <= t + this->slack_, last_knot_, t);
        t = select(t >= this->stop_ - this->slack_, this->stop_, t);
        const Mask is_knot = knot_ <= t, is_jump = jump_ <= t;
        const Mask has_sides = this->plant_.wall.motion == Motion::table ? is_jump || is_knot : is_jump;
        return {t, is_knot, is_jump, due <= t + this->slack_, select(has_sides, before_knot_, T(infinite))};
    }

    // The end of the next step of the given length; the last one may be cut short, or lengthened by a rounding error.
    ARM3R_INLINE T next_on_grid() const { return start_ + (whole_steps_ + 1.0) * step_; }

    ARM3R_INLINE void choose_length(const StepEnd& end) {
        const T rest = end.t - t0_;
        if (method_.chooses_length()) {
            const T wanted = min(min(next_h_, max_step()), to_pose_);
            was_last_ = wanted >= rest - this->slack_;
            const T half_rest = 0.5 * rest;  // avoids a very short last step
            this->h_ = select(was_last_, rest, select(rest < 2.0 * wanted, half_rest, wanted));
        } else {
            was_last_ = to_pose_ >= rest;
            this->h_ = min(rest, to_pose_);
        }
        was_cut_ = was_last_ || this->h_ == to_pose_;
    }

    ARM3R_INLINE void choose_next_length() {
        const T factor = method_.factor(error_);
        const T whole = max(this->h_, select(was_cut_, next_h_, T(0.0)));
        next_h_ = select(moved_, T(whole * select(was_refused_, min(factor, T(1.0)), factor)), next_h_);
        was_refused_ = was_refused_ && !moved_;
        const Mask at_jump = moved_ && ends_at_jump_;
        if (in_any_lane(at_jump)) restart_after_jump(at_jump);
    }

    // The next knots of a lane after t. No step is as short as the rounding errors of the clock: those that lie as close
    // together are passed at once.
    void set_knots(int lane, double t) {
        const Setup& setup = this->setup(lane);
        const double rounding = setup.clock_rounding(), knot = arm3r::next_knot(setup, t);
        double last = knot;
        for (double other = knot; other < infinite && other <= last + rounding; other = arm3r::next_knot(setup, other))
            last = other;
        Lanes<T>::set(knot_, lane, knot);
        Lanes<T>::set(last_knot_, lane, last);
        Lanes<T>::set(before_knot_, lane, just_before(knot));
        Lanes<T>::set(jump_, lane, next_jump(setup, t));
    }
    [[gnu::noinline]] void pass_knots() {
        for (int lane = 0; lane < Base::lanes; ++lane)
            if (Lanes<T>::get(knot_, lane) <= this->t(lane)) set_knots(lane, this->t(lane));
    }

    ARM3R_INLINE static T min_step(const T& t) {
        return 16.0 * std::numeric_limits<double>::epsilon() * max(abs(t), T(1e-3));
    }

    ARM3R_INLINE T max_step() {  // (5.2)
        T h = min(max_step_, turning_time());
        const Mask touching = this->rhs_.touching && !method_.is_stiff();
        const bool may_press = this->plant_.acts_on_arm && this->plant_.has_wall && in_any_lane(touching);
        if (may_press)
            Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA {
                const T quarter = contact_time(this->plant_, this->wall_, this->p_, this->in_);
                const T breaks = time_to_break(this->plant_.contact, this->in_, quarter, method_.tolerance().rtol);
                h = select(touching, min(h, min(quarter, breaks)), h);
            });
        return h;
    }

    // The time in which the fastest link angle turns by the maximum allowed per step, at its present rate and
    // acceleration. Motions without an error estimate of their own (a spin without gravity, a compensated drift) would
    // otherwise take steps in which the wall passes unnoticed and the work of a turning torque is inaccurate.
    ARM3R_INLINE T turning_time() const {
        const auto fastest = [](const Y& v)
                                 ARM3R_INLINE_LAMBDA { return max(max(abs(v[3]), abs(v[4])), abs(v[4] + v[5])); };
        return min(T(max_turn_ / fastest(this->y_)), sqrt(T(2.0 * max_turn_ / fastest(method_.f0()))));
    }

    ARM3R_INLINE T weighted_norm(const Y& v) const {
        T largest(0.0);
        for (std::size_t i = 0; i < N; i = i + 1 == motion_size ? state_size : i + 1)
            largest = max(largest, T(abs(v[i]) / method_.tolerance().of(abs(this->y_[i]))));
        return largest;
    }

    ARM3R_INLINE T first_step(const Mask& here) {  // (5.2)
        const Y &y = this->y_, &f = method_.f0();
        const T size = weighted_norm(y), slope = weighted_norm(f);
        const T trial = select(size < T(1e-5) || slope < T(1e-5), T(1e-6), T(0.01 * size / slope));
        Y euler, f1;
        for (std::size_t i = 0; i < N; ++i) euler[i] = y[i] + trial * f[i];
        method_.evaluate(here, T(this->t_ + trial), euler, f1);
        for (std::size_t i = 0; i < N; ++i) f1[i] = f1[i] - f[i];
        const T bend = weighted_norm(f1) / trial;
        const T steepest = max(slope, bend);
        const T by_slope = select(steepest <= T(1e-15), max(T(1e-6), T(1e-3 * trial)), fifth_root(T(0.01 / steepest)));
        return min(T(100.0 * trial), by_slope);
    }

    [[gnu::noinline]] void restart_after_jump(const Mask& here) {
        Outlined<T>::run([&]()
                             ARM3R_INLINE_LAMBDA { next_h_ = select(here, min(next_h_, first_step(here)), next_h_); });
    }

    ARM3R_INLINE void refuse(const Mask& here) {
        const Mask is_finite = error_ * 0.0 == T(0.0);
        this->rejected_ = this->rejected_ + select(here, T(1.0), T(0.0));
        was_refused_ = was_refused_ || here;
        had_finite_end_ = (had_finite_end_ && !here) || (is_finite && here);
        if (method_.chooses_length()) {
            const T shorter = select(is_finite, T(this->h_ * min(T(1.0), method_.factor(error_))), T(0.1 * this->h_));
            next_h_ = select(here, shorter, next_h_);
        } else {
            this->stop_lanes(here, ARM3R_RUN_DIVERGED);
        }
    }

    [[gnu::noinline]] void stop_collapsed(const Mask& here) {
        this->stop_lanes(here && had_finite_end_, ARM3R_RUN_STEP_COLLAPSE);
        this->stop_lanes(here && !had_finite_end_, ARM3R_RUN_DIVERGED);
    }

    // ---- singular poses

    // A step that passes one ends just before it instead, in a second try.
    ARM3R_INLINE void seek_singular_poses() {
        const auto may_pass =
            may_pass_singular_pose(this->plant_.controller.model, this->p_, this->y_, method_.end(), this->h_);
        const Mask here = moved_ && ends_at_poses_ && may_pass;
        if (in_any_lane(here)) search_poses(here);
    }
    [[gnu::noinline]] void search_poses(const Mask& here) {
        constexpr double at_end = 1 - 1e-6;  // of the step
        for (int lane = 0; lane < Base::lanes; ++lane) {
            if (!Lanes<T>::is(here, lane)) continue;
            const std::optional<double> close =
                just_before_passage(this->setup(lane).plant.controller.model, this->dense_output(*this, lane));
            if (!close || *close > at_end) continue;
            Lanes<T>::set(to_pose_, lane, *close * this->h(lane));
            Lanes<T>::set(this->rejected_, lane, Lanes<T>::get(this->rejected_, lane) + 1);
            Lanes<T>::mark(moved_, lane, false);
        }
    }

    // ---- the end of a step

    ARM3R_INLINE void end_step(const StepEnd& end) {
        theta_ = T(1.0);
        crosses_ = false;
        const T peak = this->contact_.peak(), peak_time = this->contact_.peak_time();
        if (this->plant_.has_wall) Outlined<T>::run([this]() ARM3R_INLINE_LAMBDA { watch_contact(); });
        Y y1 = method_.end();
        T t1 = select(was_last_, end.t, T(t0_ + this->h_));
        if (in_any_lane(crosses_)) {
            t1 = select(crosses_, T(t0_ + theta_ * this->h_), t1);
            stop_at_crossing(y1);
        }
        if (this->contact_.any_transient()) end_transients(peak, peak_time);
        if (this->contact_.any_touching()) Outlined<T>::run([this]() ARM3R_INLINE_LAMBDA { add_impulse(); });
        if (this->performance_.samples() || this->performance_.sums_work())
            Outlined<T>::run([&]() ARM3R_INLINE_LAMBDA { add_performance(t1); });
        Mask comes_to_rest = false;
        for (std::size_t i = 3; i < motion_size; ++i)
            comes_to_rest = comes_to_rest || !(without_tiny_rate(y1[i]) == y1[i]);
        const Mask reached = t1 == end.t;
        continues_ = !(crosses_ || comes_to_rest || (reached && end.is_knot));
        ends_at_jump_ = reached && end.is_jump;
        may_jump_ = reached && (end.is_jump || end.is_due);
        this->accept(moved_, t1, y1);
        this->locate_tip();
        this->compute_energies();
        check_motion();
        if (in_any_lane(crosses_)) apply_changes();
    }

    ARM3R_INLINE void check_motion() {
        const Mask diverges = moved_ && is_out_of_range(this->y_);
        if (in_any_lane(diverges)) this->stop_lanes(diverges, ARM3R_RUN_DIVERGED);
        if (!this->may_be_ill_conditioned_) return;
        const Mask ill = moved_ && !is_well_conditioned(this->plant_.arm, this->p_);
        if (in_any_lane(ill)) this->stop_lanes(ill, ARM3R_RUN_ILL_CONDITIONED);
    }

    // The state at the crossing is that of the dense output, so that the tip lies on the face there. Where this has one
    // order less than the end of a step, it is not accurate enough for the works: these come from a second step, which ends
    // at the crossing (5.6).
    ARM3R_INLINE void stop_at_crossing(Y& y1) {
        for (std::size_t i = 0; i < N; ++i) y1[i] = select(crosses_, dense_.component(i, theta_), y1[i]);
        const Mask repeats = crosses_ && method_.repeats_to_event();
        if (!in_any_lane(repeats)) return;
        const T h = select(repeats, T(theta_ * this->h_), this->h_);
        const Mask ends = repeats && method_.attempt(repeats, t0_, this->y_, h) < T(infinite);
        const Y end = method_.end();
        for (std::size_t i = motion_size; i < state_size; ++i) y1[i] = select(ends, end[i], y1[i]);
    }

    // Takes the samples of the lanes that are due. Returns where the torque may be new.
    ARM3R_INLINE Mask sample_where(const Mask& here) {
        if (!this->is_controlled_) return false;
        const Mask due = here && this->goes_on() && this->is_due();
        if (in_any_lane(due)) this->update_controller(due);
        return due;
    }

    // ---- contact

    ARM3R_INLINE void watch_contact() {
        auto& contact = this->contact_;
        const bool is_elastic = !is_damped(this->plant_.contact.law);
        const Mask held = contact.touching() || contact.embedded();
        const ContactWatch<T> watch(this->plant_.wall, !held && !contact.separated(), contact.touching(), held,
                                    T(this->h_ * (1.0 / (samples_per_step - 1))));
        const T& stiffness = this->plant_.contact.stiffness[0];
        T most = contact.peak() / stiffness;
        Mask eventful = is_elastic ? Mask(false) : contact.touching() || contact.separated();
        T force = contact.peak(), time = contact.peak_time();
        Indentation<T> before;
#pragma GCC unroll 1
        for (int n = 0; n < samples_per_step; ++n) {
            const T theta(double(n) / (samples_per_step - 1));
            const Indentation<T> now = indentation_at(this->plant_, dense_, theta);
            if (n > 0) eventful = eventful || watch.may_change(before, now, most);
            const T here = stiffness * now.depth;
            most = max(most, now.depth);
            time = select(here > force, T(dense_.t0 + theta * dense_.h), time);
            force = max(force, here);
            before = now;
        }
        eventful = eventful && moved_;
        if (is_elastic) contact.set_peak(moved_ && contact.touching() && !eventful, force, time);
        if (in_any_lane(eventful)) search_lanes(eventful);
    }

    [[gnu::noinline]] void search_lanes(const Mask& here) {
        for (int lane = 0; lane < Base::lanes; ++lane) {
            if (!Lanes<T>::is(here, lane)) continue;
            const DenseOutput dense = this->dense_output(*this, lane);
            Peak peak = this->contact_.peak(lane);
            const std::optional<Crossing> crossing =
                ContactSearch(this->setup(lane).plant).next(dense, 0, this->mode(lane), peak);
            this->contact_.set_peak(lane, peak);
            if (!crossing) continue;
            Lanes<T>::mark(crosses_, lane, true);
            Lanes<T>::set(theta_, lane, crossing->theta);
            next_mode_[lane] = crossing->next;
        }
    }

    // The first contact of a run that lasts is transient until an instant within this step; its peak is that until then.
    [[gnu::noinline]] void end_transients(const T& peak, const T& peak_time) {
        for (int lane = 0; lane < Base::lanes; ++lane) {
            const auto get = [lane](const T& x) { return Lanes<T>::get(x, lane); };
            const double end = std::max((get(this->contact_.transient_until()) - get(t0_)) / this->h(lane), 0.0);
            if (!Lanes<T>::is(moved_, lane) || !(end <= get(theta_))) continue;
            Peak until_then{get(peak), get(peak_time)};
            if (this->mode(lane) == ContactMode::contact)
                ContactSearch(this->setup(lane).plant).include_peak(this->dense_output(*this, lane), end, until_then);
            this->contact_.end_transient(lane, until_then);
        }
    }

    ARM3R_INLINE void add_impulse() {
        const Mask here = moved_ && this->contact_.touching();
        if (!is_linear(this->plant_.contact.law)) return add_impulses(here);
        const T impulse = impulse_by_gauss(this->plant_, this->contact_.law(), dense_, T(0.0), theta_);
        this->contact_.add_impulse(select(here, impulse, T(0.0)));
    }
    [[gnu::noinline]] void add_impulses(const Mask& here) {
        T impulse(0.0);
        for (int lane = 0; lane < Base::lanes; ++lane)
            if (Lanes<T>::is(here, lane))
                Lanes<T>::set(
                    impulse, lane,
                    ContactSearch(this->setup(lane).plant).impulse(this->dense_output(*this, lane), 0, theta(lane)));
        this->contact_.add_impulse(impulse);
    }

    [[gnu::noinline]] void apply_changes() {
        for (int lane = 0; lane < Base::lanes; ++lane)
            if (Lanes<T>::is(crosses_, lane))
                this->change_mode(lane, change_at(this->setup(lane).plant, this->indentation_of(lane), theta(lane),
                                                  this->t(lane), this->mode(lane), next_mode_[lane]));
    }

    // ---- performance: the step as one segment, which ends at theta

    ARM3R_INLINE void add_performance(const T& t1) {
        has_constant_samples_ ? add_segment<trapezoid>(t1) : add_segment<boole>(t1);
    }

    template <const auto& rule>
    ARM3R_INLINE void add_segment(const T& t1) {
        const T duration = theta_ * this->h_, until = slightly_before(t1);
        const T& phase = holds_samples_ ? this->sampled_.controller_state().force_phase : this->rhs_.force_phase;
        const Vec3<T> held = holds_samples_ ? this->plant_.held_torque : limited_held_torque();
        Vec3<T> mean_power = zero_vector<T>();
        const auto sample_at = [&](std::size_t j, PerformanceSample<T>& sample) ARM3R_INLINE_LAMBDA {
            const Vec3<T> power = sample_step(T(theta_ * rule.node[j]), until, phase, sample);
            mean_power = plus(mean_power, scaled(T(rule.weight[j]), power));
        };
        const Mask unresolved = this->performance_.template add_whole<rule>(t0_, duration, this->rhs_.touching, phase,
                                                                            held, moved_, sample_at);
        if (in_any_lane(unresolved)) this->refine_segment(*this, rule, unresolved, t1);
        if (!this->performance_.sums_work()) return;
        Vec3<T> work = scaled(duration, mean_power);
        if (holds_samples_)
            for (std::size_t i = 0; i < 3; ++i)
                work[i] = held[i] * (dense_.component(i, theta_) - dense_.component(i, T(0.0)));
        this->performance_.add_work(work, moved_);
    }

    // The torque of a constant law, which the actuators may limit.
    ARM3R_INLINE Vec3<T> limited_held_torque() const {
        if (!this->plant_.holds_torque) return zero_vector<T>();
        return limited(this->plant_.arm, this->plant_.held_torque, this->plant_.controller.saturation);
    }

    // A sample of the step at theta, evaluated before `until`. Returns the power of each torque there, W.
    ARM3R_INLINE Vec3<T> sample_step(const T& theta, const T& until, const T& phase, PerformanceSample<T>& sample) {
        const Plant<T>& plant = this->plant_;
        const T t = min(T(t0_ + theta * this->h_), until);
        Y y;
        for (std::size_t i = 0; i < N; ++i) y[i] = dense_.component(i, theta);
        const Vec3<T> q(y[0], y[1], y[2]), qd(y[3], y[4], y[5]);
        const Pose<T> p = pose(q);
        WallState<T> wall = no_wall<T>();
        Indentation<T> in{};
        if (plant.has_wall) {
            wall = wall_at(plant.wall, t);
            in = tip_indentation(plant, wall, p, qd);
        }
        sample_motion(this->performance_.tracked(), plant, this->contact_.law(), this->performance_.controller(), t, p,
                      wall, in, this->contact_.touching(), phase, sample);
        const Vec3<T> tau = torque_in_step(t, wall, p, in, q, qd, y);
        sample_saturation(plant.arm, tau, sample);
        return cwise_product(tau, qd);
    }

    ARM3R_INLINE Vec3<T> torque_in_step(const T& t, const WallState<T>& wall, const Pose<T>& p,
                                        const Indentation<T>& in, const Vec3<T>& q, const Vec3<T>& qd,
                                        const Y& y) const {
        const Plant<T>& plant = this->plant_;
        if (holds_samples_) return plant.held_torque;
        if constexpr (N == state_size) {
            return torque_without_memory(plant, q, p);
        } else {
            Vec3<T> force = zero_vector<T>();
            if (plant.has_wall && this->contact_.any_touching())
                force = only_where(this->contact_.touching(),
                                   contact_force(plant.wall, wall, this->contact_.law(), in, Clamping::clamped))
                            .on_tip;
            if (plant.external_force.on) force = plus(force, external_force_at(plant.external_force, t));
            Y rates;
            return this->rhs_.torque(t, wall, p, q, qd, force, y, rates);
        }
    }

    Method method_;
    bool holds_samples_, has_constant_samples_;  // of a sampled controller; where metrics see nothing but its torque
    T max_step_{infinite}, max_turn_{0.0};       // s, rad
    T start_{0.0}, step_{infinite}, whole_steps_{0.0};                                 // of steps of one length
    T knot_{infinite}, last_knot_{infinite}, before_knot_{infinite}, jump_{infinite};  // s

    T next_h_{0.0}, error_{0.0};  // s; in units of the tolerance
    T to_pose_{infinite};         // s, to a singular pose that the step tried before has passed
    Mask ends_at_poses_ = false;
    Mask was_refused_ = false, had_finite_end_ = true;

    // Of the last step.
    T t0_{0.0}, theta_{1.0};  // theta_: its end within the dense output
    Interpolant<T, N> dense_{};
    Mask moved_ = false, was_last_ = false, was_cut_ = false, crosses_ = false;
    Mask continues_ = false, ends_at_jump_ = false, may_jump_ = false;
    std::array<ContactMode, Base::lanes> next_mode_{};
};

}  // namespace arm3r

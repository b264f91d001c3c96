#pragma once
// The values and the first derivatives of a recorded formula, in lanes: the structure of its derivatives is found once, and
// those that are zero are left out. Each lane has the bits of Dual.

#include "arm3r/numbers/dual.hpp"
#include "arm3r/numbers/expr.hpp"
#include "arm3r/numbers/lane_access.hpp"

namespace arm3r {

// What is known of an input of a tape before its number is.
struct SweepInput {
    bool changes = false;  // from one sweep to the next
    int variable = -1;     // of differentiation that it depends on; -1: on none
};

// The steps that evaluate a tape with its derivatives. Numbers stand in slots: first those of the nodes, then the derivatives
// that are not zero.
class ForwardSweep {
public:
    // One description for each input of the tape, in their order.
    ForwardSweep(const Tape& tape, std::span<const SweepInput> inputs, int variables);

    int slots() const { return slots_; }
    std::span<const double> constants() const { return constants_; }  // by slot, of the nodes; 0 of others
    int input(int i) const { return inputs_[i]; }                     // the slot of an input
    int output(int i) const { return outputs_[i]; }
    // The slot of the derivative of a node, or of an input, by a variable; -1: it is zero.
    int slope(int node, int variable) const { return slopes_[node * variables_ + variable]; }

    // Evaluates what does not change from sweep to sweep, or what does. `numbers` has a number for each slot, and those of
    // the inputs are set, as are the derivatives of the inputs that have any.
    template <class T>
    ARM3R_INLINE void evaluate_fixed(T* numbers) const {
        evaluate(fixed_, numbers);
    }
    template <class T>
    ARM3R_INLINE void evaluate_changing(T* numbers) const {
        evaluate(changing_, numbers);
    }

private:
    // A derivative of a result from those of its operands a and b; -1: it is zero.
    struct Slope {
        int result, a, b;
    };
    struct Step {
        Op op;
        int result, a, b, c;
        int first, last;  // of slope_steps_
    };

    Step step_of(const TapeNode& node, int i);
    template <class T>
    ARM3R_INLINE void evaluate(const std::vector<Step>& steps, T* numbers) const;
    template <class T>
    ARM3R_INLINE static OfTwo<T> result_of(const Step& step, const T* x);

    int variables_ = 0, slots_ = 0;
    std::vector<double> constants_;
    std::vector<int> inputs_, outputs_, slopes_;
    std::vector<Step> fixed_, changing_;
    std::vector<Slope> slope_steps_;
};

// A truth value is a number here: 1 or 0.
template <class T>
ARM3R_INLINE OfTwo<T> ForwardSweep::result_of(const Step& step, const T* x) {
    const T zero(0.0), one(1.0);
    const T &a = x[step.a], &b = x[step.b];
    const auto of_one = [&](const OfOne<T>& f) ARM3R_INLINE_LAMBDA { return OfTwo<T>{f.result, f.by_a, zero}; };
    const auto truth = [&](const auto& mask)
                           ARM3R_INLINE_LAMBDA { return OfTwo<T>{select(mask, one, zero), zero, zero}; };
    switch (step.op) {
        case Op::add: return {a + b, one, one};
        case Op::subtract: return {a - b, one, T(-1.0)};
        case Op::multiply: return {a * b, b, a};
        case Op::divide: return divide_and_slopes(a, b);
        case Op::negate: return {-a, T(-1.0), zero};
        case Op::sqrt: return of_one(sqrt_and_slopes(a));
        case Op::abs: return of_one(copysign_and_slopes(a, one));
        case Op::copysign: return of_one(copysign_and_slopes(a, b));
        case Op::sine: {
            const SinCos<T> at = sincos(a);
            return {at.sin, at.cos, zero};
        }
        case Op::cosine: {
            const SinCos<T> at = sincos(a);
            return {at.cos, -at.sin, zero};
        }
        case Op::tanh: return of_one(tanh_and_slopes(a));
        case Op::atan2: return atan2_and_slopes(a, b);
        case Op::exp: return of_one(exp_and_slopes(a));
        case Op::log: return of_one(log_and_slopes(a));
        case Op::power: return power_and_slopes(a, b);
        case Op::less: return truth(a < b);
        case Op::less_equal: return truth(a <= b);
        case Op::equal: return truth(a == b);
        case Op::logical_and: return {a * b, zero, zero};
        case Op::logical_or: return {max(a, b), zero, zero};
        case Op::logical_not: return {one - a, zero, zero};
        default: return {zero, zero, zero};
    }
}

template <class T>
ARM3R_INLINE void ForwardSweep::evaluate(const std::vector<Step>& steps, T* numbers) const {
    const T zero(0.0);
    for (const Step& step : steps) {
        const Slope* const first = slope_steps_.data() + step.first;
        const Slope* const last = slope_steps_.data() + step.last;
        if (step.op == Op::select || step.op == Op::min || step.op == Op::max) {
            const T &a = numbers[step.a], &b = numbers[step.b];
            const auto takes_a = step.op == Op::select ? numbers[step.c] > zero
                                 : step.op == Op::min  ? !(b < a)
                                                       : !(a < b);
            numbers[step.result] = select(takes_a, a, b);
            for (const Slope* s = first; s != last; ++s)
                numbers[s->result] = select(takes_a, s->a < 0 ? zero : numbers[s->a], s->b < 0 ? zero : numbers[s->b]);
            continue;
        }
        const OfTwo<T> f = result_of(step, numbers);
        numbers[step.result] = f.result;
        for (const Slope* s = first; s != last; ++s) {
            if (s->b < 0) numbers[s->result] = f.by_a * numbers[s->a];
            else if (s->a < 0) numbers[s->result] = f.by_b * numbers[s->b];
            else numbers[s->result] = f.by_a * numbers[s->a] + f.by_b * numbers[s->b];
        }
    }
}

}  // namespace arm3r

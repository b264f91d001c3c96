#include "integrate/forward_sweep.hpp"

namespace arm3r {
namespace {

// Which nodes the outputs depend on.
std::vector<bool> needed_nodes(const Tape& tape) {
    std::vector<bool> needed(tape.nodes().size(), false);
    for (const int output : tape.outputs()) needed[output] = true;
    for (std::size_t i = needed.size(); i-- > 0;) {
        if (!needed[i]) continue;
        const TapeNode& node = tape.nodes()[i];
        for (const int operand : {node.a, node.b, node.c})
            if (operand >= 0) needed[operand] = true;
    }
    return needed;
}

bool has_slopes(Op op) { return !recording::is_comparison(op) && !recording::is_logic(op); }
bool has_slope_by_second(Op op) { return op != Op::copysign; }

}  // namespace

ForwardSweep::ForwardSweep(const Tape& tape, std::span<const SweepInput> inputs, int variables)
    : variables_(variables),
      slots_(static_cast<int>(tape.nodes().size())),
      constants_(tape.nodes().size()),
      inputs_(tape.inputs().begin(), tape.inputs().end()),
      outputs_(tape.outputs().begin(), tape.outputs().end()),
      slopes_(tape.nodes().size() * static_cast<std::size_t>(variables), -1) {
    const std::vector<bool> needed = needed_nodes(tape);
    std::vector<bool> changes(needed.size(), false);
    for (int i = 0; i < static_cast<int>(needed.size()); ++i) {
        const TapeNode& node = tape.nodes()[i];
        if (node.op == Op::constant) {
            constants_[i] = node.number;
        } else if (node.op == Op::input) {
            const SweepInput& input = inputs[static_cast<std::size_t>(node.number)];
            changes[i] = input.changes;
            if (input.variable >= 0) slopes_[i * variables_ + input.variable] = slots_++;
        } else if (needed[i]) {
            const Step step = step_of(node, i);
            changes[i] = changes[step.a] || changes[step.b] || changes[step.c];
            (changes[i] ? changing_ : fixed_).push_back(step);
        }
    }
}

// With the steps of its derivatives. A choice has its truth value as the last operand.
ForwardSweep::Step ForwardSweep::step_of(const TapeNode& node, int i) {
    const int second = node.b < 0 ? node.a : node.b;
    Step step{node.op, i, node.a, second, node.a, static_cast<int>(slope_steps_.size()), 0};
    if (node.op == Op::select) step.a = node.b, step.b = node.c, step.c = node.a;
    const bool by_second = node.b >= 0 && has_slope_by_second(node.op);
    for (int variable = 0; variable < variables_ && has_slopes(node.op); ++variable) {
        const int a = slope(step.a, variable), b = by_second ? slope(step.b, variable) : -1;
        if (a < 0 && b < 0) continue;
        slopes_[i * variables_ + variable] = slots_;
        slope_steps_.push_back({slots_++, a, b});
    }
    step.last = static_cast<int>(slope_steps_.size());
    return step;
}

}  // namespace arm3r

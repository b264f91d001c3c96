// A number that records the formula that it is part of. The record gives the operation counts of the formula, its
// structure, and its replay on any other number type with the same bits.
#pragma once

#include <algorithm>
#include <bit>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "arm3r/numbers/real.hpp"

namespace arm3r {

enum class Op {
    constant,
    input,
    select,
    add,
    subtract,
    multiply,
    divide,
    negate,
    sqrt,
    abs,
    min,
    max,
    copysign,
    sine,
    cosine,
    tanh,
    atan2,
    exp,
    log,
    power,
    less,
    less_equal,
    equal,
    logical_and,
    logical_or,
    logical_not
};

// One operation on the results of earlier nodes; unused operands are -1.
struct TapeNode {
    Op op;
    int a = -1, b = -1, c = -1;
    double number = 0.0;  // of a constant

    friend bool operator==(const TapeNode& x, const TapeNode& y) {
        return x.op == y.op && x.a == y.a && x.b == y.b && x.c == y.c &&
               std::bit_cast<std::uint64_t>(x.number) == std::bit_cast<std::uint64_t>(y.number);
    }
};

class Expr;

class Tape {
public:
    Tape() = default;
    Tape(const Tape&) = delete;
    Tape& operator=(const Tape&) = delete;

    Expr input();
    void output(const Expr& x);

    std::span<const TapeNode> nodes() const { return nodes_; }
    std::span<const int> inputs() const { return inputs_; }
    std::span<const int> outputs() const { return outputs_; }
    int count(Op op) const {
        const auto same = [op](const TapeNode& node) { return node.op == op; };
        return static_cast<int>(std::count_if(nodes_.begin(), nodes_.end(), same));
    }

    // Evaluates the outputs from the inputs, in the order both were declared; T = double, Pack or Dual.
    template <class T>
    void play(std::span<const T> inputs, std::span<T> outputs) const;

    // The node's index: that of an equal earlier one where there is one.
    int record(const TapeNode& node) {
        const auto [place, is_new] = places_.try_emplace(node, static_cast<int>(nodes_.size()));
        if (is_new) nodes_.push_back(node);
        return place->second;
    }

private:
    struct Hash {
        std::size_t operator()(const TapeNode& n) const {
            std::size_t hash = std::bit_cast<std::uint64_t>(n.number);
            for (const int part : {static_cast<int>(n.op), n.a, n.b, n.c})
                hash = (hash ^ static_cast<std::size_t>(part)) * 0x9e3779b97f4a7c15 + (hash >> 29);
            return hash;
        }
    };

    std::vector<TapeNode> nodes_;
    std::vector<int> inputs_, outputs_;
    std::unordered_map<TapeNode, int, Hash> places_;
};

// The common part of Expr and its truth values: a node of a tape, or a constant that needs no node yet.
template <class Constant>
class Recorded {
public:
    Recorded(Constant constant) : constant_(constant) {}
    Recorded(Tape& tape, int node) : tape_(&tape), node_(node) {}

    Tape* tape() const { return tape_; }
    Constant constant() const { return constant_; }
    int node_on(Tape& tape) const {
        if (tape_ == nullptr) return tape.record({.op = Op::constant, .number = static_cast<double>(constant_)});
        if (tape_ != &tape) throw std::invalid_argument("an expression mixes numbers recorded on two tapes");
        return node_;
    }

private:
    Tape* tape_ = nullptr;
    int node_ = -1;
    Constant constant_{};
};

class ExprMask : public Recorded<bool> {
    using Recorded::Recorded;
};

class Expr : public Recorded<double> {
public:
    using Recorded::Recorded;
    Expr() : Recorded(0.0) {}

    Expr& operator+=(const Expr& b);
    Expr& operator-=(const Expr& b);
    Expr& operator*=(const Expr& b);
    Expr& operator/=(const Expr& b);
};

namespace recording {

// The meaning of each operation, for recorded formulas and constants alike.
template <class T>
T arithmetic(Op op, const T& a, const T& b) {
    switch (op) {
        case Op::add: return a + b;
        case Op::subtract: return a - b;
        case Op::multiply: return a * b;
        case Op::divide: return a / b;
        case Op::negate: return -a;
        case Op::sqrt: return sqrt(a);
        case Op::abs: return abs(a);
        case Op::min: return min(a, b);
        case Op::max: return max(a, b);
        case Op::copysign: return copysign(a, b);
        case Op::sine: return sincos(a).sin;
        case Op::cosine: return sincos(a).cos;
        case Op::tanh: return tanh(a);
        case Op::atan2: return atan2(a, b);
        case Op::exp: return exp(a);
        case Op::log: return log(a);
        case Op::power: return power(a, b);
        default: throw std::logic_error("not an arithmetic operation");
    }
}

template <class T>
auto comparison(Op op, const T& a, const T& b) {
    switch (op) {
        case Op::less: return a < b;
        case Op::less_equal: return a <= b;
        case Op::equal: return a == b;
        default: throw std::logic_error("not a comparison");
    }
}

template <class Mask>
Mask logic(Op op, const Mask& a, const Mask& b) {
    switch (op) {
        case Op::logical_and: return a && b;
        case Op::logical_or: return a || b;
        case Op::logical_not: return !a;
        default: throw std::logic_error("not a logical operation");
    }
}

inline bool is_comparison(Op op) { return op >= Op::less && op <= Op::equal; }
inline bool is_logic(Op op) { return op >= Op::logical_and && op <= Op::logical_not; }

inline Tape* tape_of(std::initializer_list<Tape*> tapes) {
    const auto found = std::find_if(tapes.begin(), tapes.end(), [](Tape* tape) { return tape != nullptr; });
    return found == tapes.end() ? nullptr : *found;
}

template <class Result, class... Operands>
Result record(Tape& tape, Op op, const Operands&... operands) {
    const int at[] = {operands.node_on(tape)..., -1, -1};
    return Result(tape, tape.record({.op = op, .a = at[0], .b = at[1], .c = at[2]}));
}

inline Expr arithmetic(Op op, const Expr& a) {
    if (a.tape() == nullptr) return arithmetic(op, a.constant(), 0.0);
    return record<Expr>(*a.tape(), op, a);
}

inline Expr arithmetic(Op op, const Expr& a, const Expr& b) {
    Tape* const tape = tape_of({a.tape(), b.tape()});
    if (tape == nullptr) return arithmetic(op, a.constant(), b.constant());
    return record<Expr>(*tape, op, a, b);
}

inline ExprMask comparison(Op op, const Expr& a, const Expr& b) {
    Tape* const tape = tape_of({a.tape(), b.tape()});
    if (tape == nullptr) return comparison(op, a.constant(), b.constant());
    return record<ExprMask>(*tape, op, a, b);
}

inline ExprMask logic(Op op, const ExprMask& a, const ExprMask& b) {
    Tape* const tape = tape_of({a.tape(), b.tape()});
    if (tape == nullptr) return logic(op, a.constant(), b.constant());
    return record<ExprMask>(*tape, op, a, b);
}

}  // namespace recording

inline Expr operator+(const Expr& a, const Expr& b) { return recording::arithmetic(Op::add, a, b); }
inline Expr operator-(const Expr& a, const Expr& b) { return recording::arithmetic(Op::subtract, a, b); }
inline Expr operator*(const Expr& a, const Expr& b) { return recording::arithmetic(Op::multiply, a, b); }
inline Expr operator/(const Expr& a, const Expr& b) { return recording::arithmetic(Op::divide, a, b); }
inline Expr operator-(const Expr& a) { return recording::arithmetic(Op::negate, a); }
inline Expr& Expr::operator+=(const Expr& b) { return *this = *this + b; }
inline Expr& Expr::operator-=(const Expr& b) { return *this = *this - b; }
inline Expr& Expr::operator*=(const Expr& b) { return *this = *this * b; }
inline Expr& Expr::operator/=(const Expr& b) { return *this = *this / b; }

inline ExprMask operator<(const Expr& a, const Expr& b) { return recording::comparison(Op::less, a, b); }
inline ExprMask operator>(const Expr& a, const Expr& b) { return b < a; }
inline ExprMask operator<=(const Expr& a, const Expr& b) { return recording::comparison(Op::less_equal, a, b); }
inline ExprMask operator>=(const Expr& a, const Expr& b) { return b <= a; }
inline ExprMask operator==(const Expr& a, const Expr& b) { return recording::comparison(Op::equal, a, b); }
inline ExprMask operator&&(const ExprMask& a, const ExprMask& b) { return recording::logic(Op::logical_and, a, b); }
inline ExprMask operator||(const ExprMask& a, const ExprMask& b) { return recording::logic(Op::logical_or, a, b); }
inline ExprMask operator!(const ExprMask& a) { return recording::logic(Op::logical_not, a, a); }
inline ExprMask operator!=(const Expr& a, const Expr& b) { return !(a == b); }

// While recording, a truth value may turn out either way unless it is a constant.
inline bool any(const ExprMask& mask) { return mask.tape() != nullptr || mask.constant(); }
inline bool all(const ExprMask& mask) { return mask.tape() == nullptr && mask.constant(); }

inline Expr select(const ExprMask& mask, const Expr& a, const Expr& b) {
    if (mask.tape() == nullptr) return mask.constant() ? a : b;
    return recording::record<Expr>(*mask.tape(), Op::select, mask, a, b);
}

inline Expr sqrt(const Expr& x) { return recording::arithmetic(Op::sqrt, x); }
inline Expr abs(const Expr& x) { return recording::arithmetic(Op::abs, x); }
inline Expr min(const Expr& a, const Expr& b) { return recording::arithmetic(Op::min, a, b); }
inline Expr max(const Expr& a, const Expr& b) { return recording::arithmetic(Op::max, a, b); }
inline Expr copysign(const Expr& a, const Expr& b) { return recording::arithmetic(Op::copysign, a, b); }
inline Expr tanh(const Expr& x) { return recording::arithmetic(Op::tanh, x); }
inline Expr atan2(const Expr& y, const Expr& x) { return recording::arithmetic(Op::atan2, y, x); }
inline Expr exp(const Expr& x) { return recording::arithmetic(Op::exp, x); }
inline Expr log(const Expr& x) { return recording::arithmetic(Op::log, x); }
inline Expr power(const Expr& x, const Expr& p) { return recording::arithmetic(Op::power, x, p); }
inline SinCos<Expr> sincos(const Expr& x) {
    return {recording::arithmetic(Op::sine, x), recording::arithmetic(Op::cosine, x)};
}
// A formula holds the sine itself, not the short cut to it.
inline SinCos<Expr> sincos_near(const Expr&, const SinCos<Expr>&, const Expr& angle) { return sincos(angle); }

inline Expr Tape::input() {
    const TapeNode node{.op = Op::input, .number = static_cast<double>(inputs_.size())};
    inputs_.push_back(record(node));
    return Expr(*this, inputs_.back());
}

inline void Tape::output(const Expr& x) { outputs_.push_back(x.node_on(*this)); }

template <class T>
void Tape::play(std::span<const T> inputs, std::span<T> outputs) const {
    if (inputs.size() != inputs_.size() || outputs.size() != outputs_.size())
        throw std::invalid_argument("a tape is played with as many inputs and outputs as it has");
    using Mask = decltype(inputs[0] < inputs[0]);
    std::vector<T> numbers(nodes_.size(), T(0.0));
    std::vector<Mask> masks(nodes_.size(), Mask(false));
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const TapeNode& n = nodes_[i];
        if (n.op == Op::constant) {
            numbers[i] = T(n.number);
            masks[i] = Mask(n.number != 0.0);
        } else if (n.op == Op::input) {
            numbers[i] = inputs[static_cast<std::size_t>(n.number)];
        } else if (n.op == Op::select) {
            numbers[i] = select(masks[n.a], numbers[n.b], numbers[n.c]);
        } else if (recording::is_comparison(n.op)) {
            masks[i] = recording::comparison(n.op, numbers[n.a], numbers[n.b]);
        } else if (recording::is_logic(n.op)) {
            masks[i] = recording::logic<Mask>(n.op, masks[n.a], masks[n.b]);
        } else {
            numbers[i] = recording::arithmetic(n.op, numbers[n.a], numbers[n.b < 0 ? n.a : n.b]);
        }
    }
    for (std::size_t i = 0; i < outputs_.size(); ++i) outputs[i] = numbers[outputs_[i]];
}

static_assert(Real<Expr>);

}  // namespace arm3r

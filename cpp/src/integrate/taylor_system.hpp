#pragma once
// A recorded motion as a system of sums and products of series (docs/model.md, 5.5): its states, and the equation that
// gives the accelerations.

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "integrate/taylor_motion.hpp"

namespace arm3r {

// Nodes of a formula in which a product of series is the only costly operation. Factors without a series are kept in
// front: (s x) y = s (x y), so that equal products show.
class Series {
public:
    struct Function {  // a function of a series, kept as a state of its own
        Op op = Op::constant;
        int argument = -1, state = -1;
        int derivative = -1;
    };

    int number(double x) { return record({.op = Op::constant, .number = x}); }
    int input(bool is_state) {
        tape_.input();
        series_.push_back(is_state);
        return size() - 1;
    }

    const TapeNode& operator[](int i) const { return tape_.nodes()[i]; }
    int size() const { return static_cast<int>(tape_.nodes().size()); }
    bool is_series(int i) const { return series_[i]; }
    bool is_state(int i) const { return series_[i] && (*this)[i].op == Op::input; }
    bool is_number(int i, double x) const { return (*this)[i].op == Op::constant && (*this)[i].number == x; }
    bool is_scaled(int i) const { return is_series(i) && (*this)[i].op == Op::multiply && !is_series((*this)[i].a); }
    bool is_convolution(int i) const {
        return is_series(i) && (*this)[i].op == Op::multiply && is_series((*this)[i].a);
    }
    const std::vector<Function>& functions() const { return functions_; }
    const Function* function_of(int state) const {
        const auto is = [state](const Function& f) { return f.state == state; };
        const auto found = std::find_if(functions_.begin(), functions_.end(), is);
        return found == functions_.end() ? nullptr : &*found;
    }

    int add(int a, int b) {
        if (is_number(a, 0)) return b;
        if (is_number(b, 0)) return a;
        return record({.op = Op::add, .a = a, .b = b});
    }

    int subtract(int a, int b) {
        if (is_number(a, 0)) return negate(b);
        if (is_number(b, 0)) return a;
        if ((*this)[a].op == Op::add && (*this)[a].a == b) return (*this)[a].b;
        if ((*this)[b].op == Op::negate) return add(a, (*this)[b].a);
        return record({.op = Op::subtract, .a = a, .b = b});
    }

    int negate(int a) {
        if ((*this)[a].op == Op::constant) return number(-(*this)[a].number);
        if ((*this)[a].op == Op::negate) return (*this)[a].a;
        if (is_scaled(a)) return multiply(negate((*this)[a].a), (*this)[a].b);
        return record({.op = Op::negate, .a = a});
    }

    int multiply(int a, int b) {
        for (const auto& [x, y] : {std::pair(a, b), std::pair(b, a)}) {
            if (is_number(x, 0)) return x;
            if (is_number(x, 1)) return y;
        }
        if (!is_series(b)) std::swap(a, b);
        if (is_scaled(b)) return multiply(multiply(a, (*this)[b].a), (*this)[b].b);
        if (is_series(a) && is_scaled(a)) return multiply((*this)[a].a, multiply((*this)[a].b, b));
        if (is_series(a) && (*this)[a].op == Op::negate) return negate(multiply((*this)[a].a, b));
        if ((*this)[b].op == Op::negate && is_series(b)) return negate(multiply(a, (*this)[b].a));
        if (is_series(b) && !is_series(a)) return record({.op = Op::multiply, .a = a, .b = b});
        return record({.op = Op::multiply, .a = std::min(a, b), .b = std::max(a, b)});
    }

    int divide(int a, int b) {
        if (is_series(b)) throw std::logic_error("a quotient of series in the motion");
        if (!is_series(a)) return record({.op = Op::divide, .a = a, .b = b});
        return multiply(record({.op = Op::divide, .a = number(1), .b = b}), a);
    }

    int function(Op op, int a, int b = -1) {
        if (!is_series(a) && (b < 0 || !is_series(b))) return record({.op = op, .a = a, .b = b});
        for (const Function& f : functions_)
            if (f.op == op && f.argument == a) return f.state;
        functions_.push_back({.op = op, .argument = a, .state = input(true)});
        return functions_.back().state;
    }

    // The derivatives of the functions, from those of the given states; they are added to the states.
    void differentiate(std::map<int, int>& derivatives) {
        for (std::size_t i = 0; i < functions_.size(); ++i) {
            const Function f = functions_[i];
            const int slope = derivative(f.argument, derivatives);
            derivatives[f.state] = functions_[i].derivative = multiply(outer_derivative(f), slope);
        }
    }

private:
    int outer_derivative(const Function& f) {
        switch (f.op) {
            case Op::sine: return function(Op::cosine, f.argument);
            case Op::cosine: return negate(function(Op::sine, f.argument));
            case Op::tanh: return subtract(number(1), multiply(f.state, f.state));
            default: throw std::logic_error("no series is known for a function in the motion");
        }
    }

    int derivative(int i, const std::map<int, int>& derivatives) {
        const TapeNode n = (*this)[i];
        if (!is_series(i)) return number(0);
        if (is_state(i)) return derivatives.at(i);
        if (n.op == Op::negate) return negate(derivative(n.a, derivatives));
        if (is_scaled(i)) return multiply(n.a, derivative(n.b, derivatives));
        if (n.op == Op::add) return add(derivative(n.a, derivatives), derivative(n.b, derivatives));
        if (n.op == Op::subtract) return subtract(derivative(n.a, derivatives), derivative(n.b, derivatives));
        throw std::logic_error("the argument of a function is not linear in the states");
    }

    int record(const TapeNode& node) {
        const int place = tape_.record(node);
        if (place == static_cast<int>(series_.size()))
            series_.push_back((node.a >= 0 && series_[node.a]) || (node.b >= 0 && series_[node.b]));
        return place;
    }

    Tape tape_;
    std::vector<bool> series_;
    std::vector<Function> functions_;
};

// The derivative of factor * rate. Its coefficient of order k is k + 1 times that of order k + 1 of the product, which the
// factor's coefficients up to order k + 1 and the acceleration's of order k give: the latter enters times factor_0.
struct ProductRate {
    int node = -1, factor = -1, rate = -1, acceleration = -1, product = -1;
};

struct System {
    Series series;
    std::vector<int> numbers;  // of the plant
    int frequency_2 = -1;
    std::vector<int> given;             // states; a quadrature is -1
    std::vector<int> rates;             // the derivatives of the wall and of the angles
    std::vector<int> angles;            // of the links
    std::vector<int> directions;        // of the links: states
    std::vector<int> accelerations;     // of q1 and of the link angles
    int inertia = -1;                   // about the first axis
    std::vector<int> matrix;            // of the link angles: 22, 23, 33; of an elbow arm 12, 13, too
    std::vector<int> remainder;         // what inertia and matrix times the accelerations are
    std::vector<ProductRate> products;  // in the remainder: the momentum about the first axis, directions times rate
    std::vector<int> energy;            // the derivatives of the quadratures
    std::vector<int> powers;            // of the torques
    std::vector<int> signals;
    std::set<int> live;              // the nodes that matter
    std::vector<int> states;         // those of them with a derivative
    std::map<int, int> derivatives;  // of the states

    System(const Tape& tape, const Recipe& recipe) : is_elbow(recipe.elbow), even_wall_(recipe.even_wall) {
        std::vector<int> place;
        for (const TapeNode& node : tape.nodes()) place.push_back(translated(node, place));
        for (const int output : tape.outputs()) list_of_output().push_back(place[output]);
        differentiate();
        find_live();
    }

    const bool is_elbow;

    // What has to be known of an order.
    std::vector<int> roots() const {
        std::vector<int> all = signals;
        for (const std::vector<int>* list : {&energy, &powers, &remainder})
            all.insert(all.end(), list->begin(), list->end());
        for (const int state : states) all.push_back(derivatives.at(state));
        return all;
    }

    // The nodes, besides the states, whose coefficients these nodes need.
    std::set<int> nodes_of(std::vector<int> nodes) const {
        std::set<int> found;
        while (!nodes.empty()) {
            const int i = nodes.back();
            nodes.pop_back();
            if (i < 0 || !series.is_series(i) || series.is_state(i) || !found.insert(i).second) continue;
            nodes.insert(nodes.end(), {series[i].a, series[i].b});
        }
        return found;
    }

private:
    int translated(const TapeNode& n, const std::vector<int>& place) {
        if (n.op == Op::input) return input();
        if (n.op == Op::constant) return series.number(n.number);
        const int a = place[n.a], b = n.b < 0 ? -1 : place[n.b];
        switch (n.op) {
            case Op::add: return series.add(a, b);
            case Op::subtract: return series.subtract(a, b);
            case Op::negate: return series.negate(a);
            case Op::multiply: return series.multiply(a, b);
            case Op::divide: return series.divide(a, b);
            default: return series.function(n.op, a, b);
        }
    }

    // In the order of the recording.
    int input() {
        if (frequency_2 < 0) return frequency_2 = series.input(false);
        const bool is_number = even_wall_ && given.size() >= 3 && given.size() < wall_size;
        if (given.size() < wall_size + motion_size) return given.emplace_back(series.input(!is_number));
        if (products.size() < directions_size) return products.emplace_back(series.input(true)).node;
        if (is_elbow && accelerations.empty()) return accelerations.emplace_back(series.input(true));
        return numbers.emplace_back(series.input(false));
    }
    std::vector<int>& list_of_output() {
        const std::array<std::pair<std::vector<int>*, std::size_t>, 6> lists{{{&rates, wall_size + 3},
                                                                              {&directions, directions_size},
                                                                              {&remainder, 4},
                                                                              {&matrix, is_elbow ? 5 : 3},
                                                                              {&energy, quadrature_count},
                                                                              {&powers, 3}}};
        for (const auto& [list, size] : lists)
            if (list->size() < size) return *list;
        return signals;
    }

    void differentiate() {
        const int* const qd = &given[wall_size + 3];
        while (accelerations.size() < 3) accelerations.push_back(series.input(true));
        for (std::size_t i = 0; i < rates.size(); ++i) derivatives[given[i]] = rates[i];
        for (int i = 0; i < 2; ++i) derivatives[qd[i]] = accelerations[i];
        derivatives[qd[2]] = series.subtract(accelerations[2], accelerations[1]);
        const int* const q = &given[wall_size];
        angles = {q[0], q[1], series.add(q[1], q[2])};
        series.differentiate(derivatives);

        for (std::size_t i = 0; i < directions_size; ++i)
            define(products[i], directions[i], i < 2 ? qd[1] : series.add(qd[1], qd[2]), accelerations[1 + i / 2]);
        inertia = remainder.front();
        remainder.erase(remainder.begin());
        ProductRate momentum{.node = series.input(true)};
        define(momentum, inertia, qd[0], accelerations[0]);
        products.push_back(momentum);
        remainder[0] = series.subtract(remainder[0], momentum.node);
        given.resize(given_size, -1);
    }

    void define(ProductRate& product, int factor, int rate, int acceleration) {
        product = {product.node, factor, rate, acceleration, series.multiply(factor, rate)};
    }

    void find_live() {
        for (std::size_t i = wall_size; i < given.size(); ++i) reach(given[i]);
        for (const std::vector<int>* list : {&energy, &powers, &signals, &remainder, &directions, &matrix})
            for (const int i : *list) reach(i);
        reach(inertia);
        for (const int i : given)
            if (live.contains(i) && series.is_series(i)) states.push_back(i);
        for (const Series::Function& f : series.functions())
            if (live.contains(f.state)) states.push_back(f.state);
    }

    void reach(int i) {
        if (i < 0 || !live.insert(i).second) return;
        reach(series[i].a), reach(series[i].b);
        const auto rate = derivatives.find(i);
        if (rate != derivatives.end()) reach(rate->second);
    }

    const bool even_wall_;  // then the wall's velocity is a number
};

}  // namespace arm3r

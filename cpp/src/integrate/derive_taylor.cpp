// Writes the Taylor kernels: for each recipe the arm's motion is recorded, turned into a system of sums, products and
// quotients of series (docs/model.md, 5.5), and printed as a C++ struct. Run by the build: derive_taylor FILE.

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "arm3r/lanes.hpp"
#include "arm3r/numbers/eigen_traits.hpp"
#include "integrate/taylor_recipes.hpp"

namespace arm3r {
namespace {

// ---- the recorded formulas ------------------------------------------------------------------------------------------------

// The states with given initial values: the wall, the motion and the quadratures. Functions of them are added later.
constexpr std::size_t wall_size = 9, given_size = wall_size + state_size;

// Inputs: the squared angular frequency of the wall, its state, the motion, the numbers of the plant.
// Outputs: the derivatives of the given states, the powers of the torques, then the signals.
struct Recording {
    Tape tape;

    explicit Recording(const Recipe& recipe) {
        const Expr frequency_2 = tape.input();
        WallState<Expr> wall;
        for (Vec3<Expr>* const vector : {&wall.position, &wall.velocity, &wall.acceleration})
            for (Expr& x : *vector) x = tape.input();
        State<Expr, state_size> y, dy;
        for (std::size_t i = 0; i < motion_size; ++i) y[i] = tape.input();
        Plant<Expr> plant = chosen(recipe);
        each_number([&](Expr& x) { x = tape.input(); }, plant);

        RightHandSide<Expr, Expr> rhs(plant);
        rhs.force_mode = recipe.force ? ContactForceMode::pressed : ContactForceMode::none;
        const Pose<Expr> p = rhs.pose_near(y);
        Indentation<Expr> felt;
        if (recipe.force) felt = indentation_at_rest(plant.wall, wall, tip_position(plant.arm, p));
        Vec3<Expr> tau;
        rhs.derivative(Expr(0.0), wall, p, felt, y, dy, tau);

        for (const Expr& x : wall.velocity) tape.output(x);
        for (const Expr& x : wall.acceleration) tape.output(x);
        for (const Expr& x : wall.velocity) tape.output(-(frequency_2 * x));  // zero unless the wall oscillates
        for (const Expr& x : dy) tape.output(x);
        for (std::size_t i = 0; i < 3; ++i) tape.output(tau[i] * y[3 + i]);
        if (!recipe.signals) return;
        const Vec3<Expr> still{0.0, 0.0, 0.0};
        const Indentation<Expr> in = indentation(plant.wall, wall, tip_position(plant.arm, p), still);
        for (const Expr& x : {in.depth, in.across1, in.across2}) tape.output(x);
    }

private:
    static Plant<Expr> chosen(const Recipe& recipe) {
        Plant<Expr> plant;
        plant.has_wall = plant.acts_on_arm = recipe.signals;
        plant.wall.motion = Motion::fixed;
        plant.contact.law = ContactLaw::spring;
        plant.holds_torque = recipe.torque == TorqueSource::held;
        if (recipe.torque == TorqueSource::gravity_compensation)
            plant.controller.type = ControllerType::gravity_compensation;
        plant.controller.algorithm = Algorithm::closed_form;
        plant.arm.gravity_is_vertical = plant.controller.model.gravity_is_vertical = !recipe.azimuth;
        plant.arm.has_damping = recipe.damping;
        plant.arm.has_dry_friction = recipe.friction;
        plant.arm.has_torque_limit = plant.holds_torque;
        return plant;
    }
};

// ---- the same as series ----------------------------------------------------------------------------------------------

// Nodes of a formula in which a product of series is the only costly operation. Factors without a series are kept in
// front: (s x) y = s (x y), so that equal products show; x (1/y) is x/y.
class Series {
public:
    struct Function {  // a function of a series, kept as a state of its own
        Op op = Op::constant;
        int argument = -1, state = -1;
        int start = -1;  // node of the first coefficient; none: by op
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
        const TapeNode& n = (*this)[i];
        return is_series(i) && ((n.op == Op::multiply && is_series(n.a)) || n.op == Op::divide);
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
        return turned(Op::cosine, record({.op = Op::add, .a = a, .b = b}));
    }

    int subtract(int a, int b) {
        if (is_number(a, 0)) return negate(b);
        if (is_number(b, 0)) return a;
        if ((*this)[a].op == Op::add && (*this)[a].a == b) return (*this)[a].b;
        return turned(Op::sine, record({.op = Op::subtract, .a = a, .b = b}));
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
        if (is_reciprocal(a)) return divide(b, (*this)[a].b);
        if (is_reciprocal(b)) return divide(a, (*this)[b].b);
        return record({.op = Op::multiply, .a = std::min(a, b), .b = std::max(a, b)});
    }

    int divide(int a, int b) {
        if (!is_series(b) && is_series(a)) return multiply(record({.op = Op::divide, .a = number(1), .b = b}), a);
        return record({.op = Op::divide, .a = a, .b = b});
    }

    int function(Op op, int a, int b = -1) {
        if (!is_series(a) && (b < 0 || !is_series(b))) return record({.op = op, .a = a, .b = b});
        return function_with_start(op, a, -1);
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
    bool is_reciprocal(int i) const {
        return is_series(i) && (*this)[i].op == Op::divide && is_number((*this)[i].a, 1);
    }

    int function_with_start(Op op, int argument, int start) {
        for (const Function& f : functions_)
            if (f.op == op && f.argument == argument) return f.state;
        functions_.push_back({.op = op, .argument = argument, .state = input(true), .start = start});
        return functions_.back().state;
    }

    // cos a cos b + sin a sin b is cos(b - a), sin b cos a - sin a cos b is sin(b - a): a state instead of two products.
    int turned(Op op, int sum) {
        auto p = two_functions((*this)[sum].a), q = two_functions((*this)[sum].b);
        if (op == Op::cosine && p[0].op == Op::sine) std::swap(p, q);
        const Op first = op == Op::cosine ? Op::cosine : Op::sine;
        const bool fits = p[0].op == first && p[1].op == Op::cosine && q[0].op == Op::sine &&
                          q[1].op == (op == Op::cosine ? Op::sine : Op::cosine);
        const int b = p[op == Op::cosine].argument, a = p[op == Op::sine].argument;
        if (!fits || q[0].argument != a || q[1].argument != b) return sum;
        return function_with_start(op, subtract(b, a), sum);
    }

    // The factors of a product of two, sines first, then by their arguments.
    std::array<Function, 2> two_functions(int i) const {
        if (!is_convolution(i)) return {};
        const Function *f = function_of((*this)[i].a), *g = function_of((*this)[i].b);
        if (!f || !g) return {};
        if (std::pair(f->op, f->argument) > std::pair(g->op, g->argument)) std::swap(f, g);
        return {*f, *g};
    }

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

// ---- the system of a recipe ------------------------------------------------------------------------------------------

struct System {
    Series series;
    std::vector<int> numbers;  // of the plant
    int frequency_2 = -1;
    std::vector<int> given;   // states; a quadrature is -1
    std::vector<int> rates;   // the derivatives of the given states
    std::vector<int> powers;  // of the torques
    std::vector<int> signals;
    std::vector<int> states;         // that matter: each before its derivative where that is a state too
    std::map<int, int> derivatives;  // of the states
    std::vector<int> live;           // all nodes that matter, operands first

    explicit System(const Tape& tape) {
        std::vector<int> place;
        for (const TapeNode& node : tape.nodes()) place.push_back(translated(node, place));
        for (const int output : tape.outputs()) {
            std::vector<int>& list = rates.size() < given_size ? rates : powers.size() < 3 ? powers : signals;
            list.push_back(place[output]);
        }
        given.resize(given_size, -1);
        for (std::size_t i = 0; i < given.size(); ++i)
            if (given[i] >= 0) derivatives[given[i]] = rates[i];
        series.differentiate(derivatives);
        find_live();
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

    int input() {
        if (frequency_2 < 0) return frequency_2 = series.input(false);
        const bool is_state = given.size() < wall_size + motion_size;
        std::vector<int>& list = is_state ? given : numbers;
        list.push_back(series.input(is_state));
        return list.back();
    }

    void find_live() {
        std::set<int> found;
        for (std::size_t i = wall_size; i < given.size(); ++i) {
            if (given[i] >= 0) reach(given[i], found);
            reach(rates[i], found);
        }
        for (const int i : powers) reach(i, found);
        for (const int i : signals) reach(i, found);
        live.assign(found.begin(), found.end());
        for (const int i : given)
            if (found.contains(i)) states.push_back(i);
        for (const Series::Function& f : series.functions())
            if (found.contains(f.state)) states.push_back(f.state);
    }

    void reach(int i, std::set<int>& found) const {
        if (i < 0 || !found.insert(i).second) return;
        reach(series[i].a, found), reach(series[i].b, found);
        const auto rate = derivatives.find(i);
        if (rate != derivatives.end()) reach(rate->second, found);
        if (const Series::Function* f = series.function_of(i)) reach(f->start < 0 ? f->argument : f->start, found);
    }
};

// ---- the printed kernel ----------------------------------------------------------------------------------------------

constexpr std::size_t max_sums_at_once = 10;  // what the registers hold

std::string named(char kind, int i) { return kind + std::to_string(i); }

// zI is the first coefficient of node I, or the node where it is no series; xI its coefficient of order k; mI the inner
// part of a product, without its first and its newest factors; nodes with a row keep all their coefficients in r.
class Printer {
public:
    Printer(const System& system, std::ostream& out) : system_(system), series_(system.series), out_(out) {
        for (const int i : nodes_of(roots()))
            if (series_.is_convolution(i))
                for (const int factor : factors(i)) rows_.try_emplace(factor, static_cast<int>(rows_.size()));
    }

    void print(std::size_t recipe) {
        out_ << "\ntemplate <class T>\nstruct Recurrence<" << recipe << ", T> {\n"
             << "    ARM3R_INLINE static void expand(const Plant<T>& plant, [[maybe_unused]] const T& frequency_2,\n"
             << "                                    const T* given, int order, T (*c)[quantities]) {\n"
             << "        constexpr int rows = " << rows_.size() << ";\n"
             << "        alignas(64) T r[(max_degree + 1) * rows];\n"
             << "        const Numbers<T> numbers(plant);\n";
        print_first();
        out_ << "        for (;; ++k) {\n";
        print_states("            c[k]", 'x');
        out_ << "            if (k == order) break;\n"
             << "            T* const now = r + k * rows;\n";
        for (const int i : system_.states) print_row("            now", 'x', i);
        print_nodes("            ", nodes_of(roots()), true);
        print_signals("            c[k]", 'x');
        print_advance("            ", 'x', " * reciprocals[k + 1]");
        out_ << "        }\n";
        print_nodes("        ", nodes_of(system_.signals), false);
        print_signals("        c[k]", 'x');
        out_ << "    }\n};\n";
    }

private:
    void print_first() {
        std::set<int> turned, divisors;
        for (const int i : system_.live) {
            if (const Series::Function* f = series_.function_of(i); f && f->op != Op::tanh && f->start < 0)
                if (turned.insert(f->argument).second)
                    out_ << "        const SinCos<T> turn" << f->argument << " = sincos(" << named('z', f->argument)
                         << ");\n";
            out_ << "        const T " << named('z', i) << " = " << first(i) << ";\n";
            print_row("        r", 'z', i);
            if (series_.is_convolution(i) && series_[i].op == Op::divide) divisors.insert(series_[i].b);
        }
        for (const int i : divisors) out_ << "        const T over" << i << " = 1.0 / " << named('z', i) << ";\n";
        print_states("        c[0]", 'z');
        print_signals("        c[0]", 'z');
        print_advance("        T ", 'z', "");
        out_ << "        int k = 1;\n";
    }

    std::string first(int i) const {
        const auto position = [i](const std::vector<int>& list) {
            return std::to_string(std::find(list.begin(), list.end(), i) - list.begin());
        };
        const TapeNode& n = series_[i];
        if (const Series::Function* f = series_.function_of(i)) {
            if (f->start >= 0) return named('z', f->start);
            if (f->op == Op::tanh) return "tanh(" + named('z', f->argument) + ")";
            return "turn" + std::to_string(f->argument) + (f->op == Op::sine ? ".sin" : ".cos");
        }
        if (i == system_.frequency_2) return "frequency_2";
        if (series_.is_state(i)) return "given[" + position(system_.given) + "]";
        if (n.op == Op::input) return "*numbers.at[" + position(system_.numbers) + "]";
        const std::string a = n.a < 0 ? "" : named('z', n.a), b = n.b < 0 ? "" : named('z', n.b);
        switch (n.op) {
            case Op::constant: return literal(n.number);
            case Op::add: return a + " + " + b;
            case Op::subtract: return a + " - " + b;
            case Op::multiply: return a + " * " + b;
            case Op::divide: return a + " / " + b;
            case Op::negate: return "-" + a;
            case Op::min: return "min(" + a + ", " + b + ")";
            case Op::max: return "max(" + a + ", " + b + ")";
            default: throw std::logic_error("an operation that no kernel knows");
        }
    }

    static std::string literal(double x) {
        std::ostringstream text;
        text << "T(" << std::hexfloat << x << ")";
        return text.str();
    }

    // The coefficient of order k >= 1. The newest coefficients are added last, because they are computed last.
    std::string next(int i) const {
        const TapeNode& n = series_[i];
        const auto x = [](int operand) { return named('x', operand); };
        const auto z = [](int operand) { return named('z', operand); };
        const bool a_moves = series_.is_series(n.a), b_moves = n.b >= 0 && series_.is_series(n.b);
        switch (n.op) {
            case Op::add: return !a_moves ? x(n.b) : !b_moves ? x(n.a) : x(n.a) + " + " + x(n.b);
            case Op::subtract: return !a_moves ? "-" + x(n.b) : !b_moves ? x(n.a) : x(n.a) + " - " + x(n.b);
            case Op::negate: return "-" + x(n.a);
            case Op::multiply:
                if (!a_moves) return z(n.a) + " * " + x(n.b);
                if (n.a == n.b) return "2.0 * (" + named('m', i) + " + " + z(n.a) + " * " + x(n.a) + ")";
                return "(" + named('m', i) + " + " + x(n.a) + " * " + z(n.b) + ") + " + z(n.a) + " * " + x(n.b);
            default: {
                const std::string known = "(" + named('m', i) + " + " + x(n.b) + " * " + z(i) + ")";
                return (a_moves ? "(" + x(n.a) + " - " + known + ")" : "-" + known) + " * over" + std::to_string(n.b);
            }
        }
    }

    void print_nodes(const std::string& indent, const std::vector<int>& nodes, bool kept) {
        std::vector<int> sums;
        for (const int i : nodes)
            if (series_.is_convolution(i)) sums.push_back(i);
        auto waiting = sums.cbegin();
        for (const int i : nodes) {
            if (waiting != sums.cend() && i == *waiting) {
                const auto last = std::min(sums.cend(), waiting + max_sums_at_once);
                print_loop(indent, {waiting, last});
                waiting = last;
            }
            out_ << indent << "const T " << named('x', i) << " = " << next(i) << ";\n";
            if (kept) print_row(indent + "now", 'x', i);
        }
    }

    void print_row(const std::string& where, char kind, int i) {
        const auto row = rows_.find(i);
        if (row != rows_.end()) out_ << where << "[" << row->second << "] = " << named(kind, i) << ";\n";
    }

    void print_states(const std::string& where, char kind) {
        for (std::size_t j = 0; j < state_size; ++j) {
            const int i = system_.given[wall_size + j];
            const std::string book = kind == 'z' ? "given[" + std::to_string(wall_size + j) + "]" : named('b', j);
            out_ << where << "[" << j << "] = " << (j < motion_size ? named(kind, i) : book) << ";\n";
        }
        for (std::size_t j = 0; j < 3; ++j)
            out_ << where << "[" << works_at + j << "] = " << (kind == 'z' ? "T(0.0)" : named('w', j)) << ";\n";
    }

    void print_signals(const std::string& where, char kind) {
        for (std::size_t j = state_size; j < works_at; ++j) {
            const std::size_t signal = j - state_size;
            out_ << where << "[" << j
                 << "] = " << (signal < system_.signals.size() ? named(kind, system_.signals[signal]) : "T(0.0)")
                 << ";\n";
        }
    }

    // The states' coefficients of the next order.
    void print_advance(const std::string& indent, char kind, const std::string& scale) {
        const auto rate = [&](int i) {
            if (kind == 'x' && !series_.is_series(i)) return std::string("T(0.0)");
            return named(kind, i) + scale;
        };
        for (std::size_t j = motion_size; j < state_size; ++j)
            out_ << indent << named('b', j) << " = " << rate(system_.rates[wall_size + j]) << ";\n";
        for (std::size_t j = 0; j < 3; ++j)
            out_ << indent << named('w', j) << " = " << rate(system_.powers[j]) << ";\n";
        for (const int i : system_.states)
            out_ << indent << named('x', i) << " = " << rate(system_.derivatives.at(i)) << ";\n";
    }

    // The nodes, besides the states, whose coefficients these nodes need.
    std::vector<int> nodes_of(std::vector<int> roots) const {
        std::set<int> found;
        while (!roots.empty()) {
            const int i = roots.back();
            roots.pop_back();
            if (i < 0 || !series_.is_series(i) || series_.is_state(i) || !found.insert(i).second) continue;
            roots.insert(roots.end(), {series_[i].a, series_[i].b});
        }
        return {found.begin(), found.end()};
    }

    std::vector<int> roots() const {
        std::vector<int> all = system_.signals;
        all.insert(all.end(), system_.rates.begin() + wall_size, system_.rates.end());
        all.insert(all.end(), system_.powers.begin(), system_.powers.end());
        for (const int state : system_.states) all.push_back(system_.derivatives.at(state));
        return all;
    }

    // ---- inner sums: a[1] b[k-1] + ... + a[k-1] b[1], from the middle outwards, so that the newest come last; of a
    // square, half of it
    std::array<int, 2> factors(int i) const {
        const TapeNode& n = series_[i];
        return n.op == Op::divide ? std::array{n.b, i} : std::array{n.a, n.b};
    }

    bool is_square(int i) const { return factors(i)[0] == factors(i)[1]; }

    void print_loop(const std::string& indent, const std::vector<int>& sums) {
        const auto term = [&](int i, const std::string& a, const std::string& b) {
            return a + "[" + std::to_string(rows_.at(factors(i)[0])) + "] * " + b + "[" +
                   std::to_string(rows_.at(factors(i)[1])) + "]";
        };
        out_ << indent << "T";
        for (const int i : sums) out_ << (i == sums.front() ? " " : ", ") << named('m', i) << "(0.0)";
        out_ << ";\n" << indent << "if (k % 2 == 0) {\n" << indent << "    const T* const mid = r + k / 2 * rows;\n";
        for (const int i : sums)
            out_ << indent << "    " << named('m', i) << " = "
                 << (is_square(i) ? "0.5 * (" + term(i, "mid", "mid") + ")" : term(i, "mid", "mid")) << ";\n";
        out_
            << indent << "}\n"
            << indent
            << "for (const T *up = r + (k - 1) / 2 * rows, *down = r + (k - (k - 1) / 2) * rows; up > r; up -= rows, down += rows) {\n";
        for (const int i : sums)
            out_ << indent << "    " << named('m', i) << " += " << term(i, "up", "down")
                 << (is_square(i) ? "" : " + " + term(i, "down", "up")) << ";\n";
        out_ << indent << "}\n";
    }

    const System& system_;
    const Series& series_;
    std::ostream& out_;
    std::map<int, int> rows_;
};

}  // namespace

void derive(std::ostream& out) {
    std::size_t numbers = 0;
    Plant<Expr> plant;
    each_number([&](Expr&) { ++numbers; }, plant);
    out << "// Made by derive_taylor from the recorded motion of the arm.\n\n"
        << "template <class T>\nstruct Numbers {\n    std::array<const T*, " << numbers << "> at;\n"
        << "    ARM3R_INLINE explicit Numbers(const Plant<T>& plant) {\n        int i = 0;\n"
        << "        each_number([&](const T& x) ARM3R_INLINE_LAMBDA { at[i++] = &x; }, plant);\n    }\n};\n\n"
        << "template <std::size_t recipe, class T>\nstruct Recurrence;\n";
    for (std::size_t i = 0; i < recipes.size(); ++i) {
        const Recording recording(recipes[i]);
        Printer(System(recording.tape), out).print(i);
    }
}

}  // namespace arm3r

int main(int count, char** arguments) {
    std::ofstream file(count == 2 ? arguments[1] : "");
    arm3r::derive(file);
    return file.flush() ? 0 : 1;
}

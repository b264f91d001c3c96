#pragma once
// The text of a Taylor kernel (docs/model.md, 5.5): from the coefficients of one order those of the next.

#include <array>
#include <ostream>
#include <sstream>
#include <string>

#include "integrate/taylor_system.hpp"

namespace arm3r {

inline std::string named(char kind, int i) { return kind + std::to_string(i); }

inline std::string literal(double x) {
    std::ostringstream text;
    text << "T(" << std::hexfloat << x << ")";
    return text.str();
}

// Inner sums of products that are computed as one number of this type, and the rows of their factors.
struct Sum {
    std::vector<int> products;
    std::string type, name;
    int first, second;
    bool is_half = false;  // of a square, half of it
};

// Of node I, zI is the first coefficient, or the node where it is no series; xI the coefficient of order k; pI the same
// without the accelerations of that order; aI the coefficient of order k + 1, ahead of the others; yI an acceleration's
// of order k - 1. mI is the inner sum of a product, without its first and its newest factors; hI the coefficient of order
// k + 1 of a product with a rate, without the acceleration. Nodes with a row keep all their coefficients in r.
class Printer {
public:
    Printer(const System& system, std::ostream& out) : system_(system), series_(system.series), out_(out) {
        ahead_ = system.nodes_of({system.inertia});
        ahead_.insert(system.directions.begin(), system.directions.end());
        std::set<int> nodes = system.nodes_of(system.roots()), with_rate;
        nodes.insert(ahead_.begin(), ahead_.end());
        if (system.is_elbow) late_.insert(system.accelerations[0]);
        for (const ProductRate& p : system.products) {
            late_.insert({p.node, p.acceleration});
            with_rate.insert(p.product);
        }
        nodes.insert(with_rate.begin(), with_rate.end());
        for (const int i : nodes) {
            const TapeNode& n = series_[i];
            if (late_.contains(n.a) || late_.contains(n.b)) late_.insert(i);
            for (const int operand : {n.a, n.b})
                if (!ahead_.contains(i) && is_scalar_ahead(operand)) carried_.insert(operand);
            if (!series_.is_convolution(i)) continue;
            (ahead_.contains(i) || with_rate.contains(i) ? ahead_sums_ : sums_).push_back(i);
            factors_.insert({n.a, n.b});
        }
        for (std::size_t j = 0; !system.is_elbow && j + 1 < system.products.size(); ++j) forces_.push_back(force_of(j));
    }
    virtual ~Printer() = default;

    void print(std::size_t recipe) {
        give_rows();
        out_
            << "\n// " << sums_.size() + ahead_sums_.size() << " products of series.\n"
            << head(std::to_string(recipe))
            << "    ARM3R_INLINE static void expand(const Plant<T>& plant, [[maybe_unused]] const T& frequency_2,\n"
            << "                                    const T* given, const Pose<T>& p, int order, T (*c)[quantities]) {\n"
            << "        constexpr int rows = " << row_count_ << ";\n"
            << "        alignas(64) T r[(max_degree + 2) * rows];\n"
            << "        T *now = r, *next = r + rows;\n"
            << "        const Numbers<T> numbers(plant);\n";
        indent_ = "        ", kind_ = 'z', at_ = "c[0]", scale_ = "";
        print_numbers();
        print_order("T ");
        print_before_loop();
        line("int k = 1, before = 0, half = 0;  // half: k / 2 rows");
        line("for (;; ++k) {");
        indent_ = "            ", kind_ = 'x', at_ = "c[k]", scale_ = " * reciprocals[k + 1]";
        line("now = next, next += rows;");
        line("before = half, half = k / 2 * rows;");
        print_states();
        line("if (k == order) break;");
        print_order("");
        indent_ = "        ";
        line("}");
        print_last_signals();
        out_ << "    }\n};\n";
    }

protected:
    // A direction turns this node, a force, into a link's plane: rest - number * the node of the product `turning`.
    struct Force {
        int product, direction, node, rest, number, turning;
    };

    // What differs with the numbers that a kernel is for. These are packs of runs.
    virtual std::string head(const std::string& recipe) const {
        return "template <class T>\nstruct Recurrence<" + recipe + ", T> {\n";
    }
    virtual void give_rows() {
        for (const int i : factors_) row_of_[i] = row_count_++;
    }
    virtual void store(int i, char kind) {
        const auto row = row_of_.find(i);
        const bool is_ahead = kind == 'a', is_kept = kind == 'z' || is_ahead || (kind == 'x' && !ahead_.contains(i));
        if (is_kept && row != row_of_.end())
            line((is_ahead ? "next[" : "now[") + std::to_string(row->second) + "] = " + named(kind, i) + ";");
    }
    virtual void print_before_loop() {}
    virtual std::vector<Sum> sums_of(const std::vector<int>& products) const {
        std::vector<Sum> sums;
        for (const int i : products)
            sums.push_back({{i}, "T", named('m', i), row_of_.at(series_[i].a), row_of_.at(series_[i].b), is_square(i)});
        return sums;
    }
    virtual std::string loaded(const std::string& order, int row) const {
        return order + "[" + std::to_string(row) + "]";
    }
    virtual void print_parts(const Sum&, const std::set<int>&) {}  // those of several products that are needed
    virtual void print_advance(const std::string& type) {
        print_next_order(type);
        for (int j = 1; j < 3; ++j) {
            const int i = system_.accelerations[j];
            line(type + named('y', i) + " = " + x(i) + ";");
        }
    }
    virtual void print_states() {
        for (std::size_t j = 0; j < state_size; ++j) print_quantity(j, state(j));
        for (std::size_t j = 0; j < 3; ++j) print_quantity(works_at + j, work(j));
    }
    virtual void print_signals() {
        for (std::size_t j = 0; j < signals_size; ++j) {
            const bool is_there = j < system_.signals.size();
            print_quantity(state_size + j, is_there ? x(system_.signals[j]) : "T(0.0)");
        }
    }

    // The coefficients of order k + 1 that depend on no acceleration of order k.
    virtual void print_ahead(const std::string& type) {
        for (const ProductRate& p : system_.products) {
            if (p.factor == system_.inertia) continue;
            if (is_first()) print_node(p.product, 'z');
            else
                define(p.product, 'x',
                       named('h', p.product) + " + (" + named('z', p.factor) + " * reciprocals[k]) * " +
                           named('y', p.acceleration));
        }
        for (const int i : system_.directions) {
            print_node(system_.derivatives.at(i), kind_);
            define(i, 'a', x(system_.derivatives.at(i)) + scale_);
        }
        if (is_first())
            for (const int i : ahead_sums_) line("const T " + named('m', i) + "(0.0);");
        print_node(system_.inertia, 'a');
        for (const ProductRate& p : system_.products)
            line(type + named('h', p.product) + " = " + named('m', p.product) + " + " + newest_of(p) + ";");
    }

    virtual void print_accelerations() {
        print_orders();
        for (const ProductRate& p : system_.products) define(p.node, 'p', "orders * " + named('h', p.product));
        if (system_.is_elbow) define(system_.accelerations[0], 'p', "T(0.0)");
        for (const Force& f : forces_) {
            if (is_first()) break;
            print_node(f.rest, 'x');
            define(f.node, 'p',
                   rest_of(f) + " - (orders * " + named('z', f.number) + ") * " +
                       named('h', system_.products[f.turning].product));
        }
        print_solution();
        for (const ProductRate& p : system_.products)
            if (p.factor != system_.inertia)
                define(p.node, kind_, named('p', p.node) + " + " + named('z', p.factor) + " * " + x(p.acceleration));
    }

    virtual void begin_order() {
        done_.clear();
        for (const int i : known()) done_.insert({i, 'x'});
    }

    // ---- the system

    bool is_first() const { return kind_ == 'z'; }
    bool is_square(int i) const { return series_[i].a == series_[i].b; }
    bool is_direction(int i) const { return contains(system_.directions, i); }
    bool is_scalar_ahead(int i) const { return ahead_.contains(i) && !is_direction(i); }
    static bool contains(const std::vector<int>& list, int i) {
        return std::find(list.begin(), list.end(), i) != list.end();
    }

    Force force_of(std::size_t turning) const {
        const auto turned_by = [&](int i) {
            const TapeNode& n = series_[i];
            return n.op == Op::subtract && series_.is_scaled(n.b) && series_[n.b].b == system_.products[turning].node;
        };
        const auto found = std::find_if(sums_.begin(), sums_.end(), [&](int i) { return turned_by(series_[i].b); });
        if (found == sums_.end() || !is_direction(series_[*found].a))
            throw std::logic_error("a direction without a force");
        const int direction = series_[*found].a, node = series_[*found].b;
        return {*found, direction, node, series_[node].a, series_[series_[node].b].a, int(turning)};
    }

    // The slope of a direction is a product, or a product with the other sign.
    bool has_negative_slope(int direction) const { return series_[system_.derivatives.at(direction)].op == Op::negate; }
    const ProductRate& slope_of(int direction) const {
        const int slope = system_.derivatives.at(direction);
        const int product = has_negative_slope(direction) ? series_[slope].a : slope;
        return *std::find_if(system_.products.begin(), system_.products.end(),
                             [&](const ProductRate& p) { return p.product == product; });
    }

    // ---- lines

    void line(const std::string& text) { out_ << indent_ << text << "\n"; }

    // The name of a node's coefficient: of order k; of one that no acceleration changes as 'p'.
    std::string x(int i) const { return value(i, kind_); }
    std::string value(int i, char kind) const {
        if (!series_.is_series(i)) return named('z', i);
        return named(kind == 'p' && !late_.contains(i) ? kind_ : kind, i);
    }
    std::string rest_of(const Force& f) const { return series_.is_series(f.rest) ? x(f.rest) : "T(-0.0)"; }

    void define(int i, char kind, const std::string& text) {
        line("const T " + named(kind, i) + " = " + text + ";");
        done_.insert({i, kind});
        store(i, kind);
    }

    // With what it needs.
    void print_node(int i, char kind) {
        if (kind == 'p' && !late_.contains(i)) kind = kind_;
        if (i < 0 || !series_.is_series(i) || !done_.insert({i, kind}).second) return;
        print_node(series_[i].a, kind), print_node(series_[i].b, kind);
        define(i, kind, coefficient(i, kind));
    }

    void print_orders() { line(std::string("const T orders(") + (is_first() ? "1.0" : "k + 1.0") + ");"); }

    void print_solution() {
        std::string rest[3];
        for (int i = 0; i < 3; ++i) {
            print_node(system_.remainder[i], 'p');
            rest[i] = value(system_.remainder[i], 'p');
        }
        const auto& a = system_.accelerations;
        const auto sum = [&](const std::string& first, const std::string& second, const std::string& third) {
            return first + " * " + rest[0] + " + (" + second + " * " + rest[1] + " + " + third + " * " + rest[2] + ")";
        };
        if (system_.is_elbow) {
            define(a[0], kind_, sum("inverse11", "inverse12", "inverse13"));
            define(a[1], kind_, sum("inverse12", "inverse22", "inverse23"));
            define(a[2], kind_, sum("inverse13", "inverse23", "inverse33"));
            return;
        }
        define(a[0], kind_, "inverse11 * " + rest[0]);
        define(a[1], kind_, "inverse22 * " + rest[1] + " + inverse23 * " + rest[2]);
        define(a[2], kind_, "inverse23 * " + rest[1] + " + inverse33 * " + rest[2]);
    }

    // The newest term of a product with a rate.
    std::string newest_of(const ProductRate& p) const {
        const std::string rate = named('z', p.rate);
        if (p.factor == system_.inertia) return named('a', p.factor) + " * " + rate;
        return x(system_.derivatives.at(p.factor)) + " * (" + (is_first() ? "" : "reciprocals[k + 1] * ") + rate + ")";
    }

    // What the next order has: the quadratures, the states, the rates of the links, and what was computed ahead.
    void print_next_order(const std::string& type) {
        const auto rate = [&](int i) {
            if (!is_first() && !series_.is_series(i)) return std::string("T(0.0)");
            return x(i) + scale_;
        };
        const auto set = [&](char kind, int i, const std::string& text) {
            line(type + named(kind, i) + " = " + text + ";");
        };
        for (std::size_t j = 0; j < quadrature_count; ++j) set('b', motion_size + j, rate(system_.energy[j]));
        for (std::size_t j = 0; j < 3; ++j) set('w', j, rate(system_.powers[j]));
        for (const int i : system_.states)
            set('x', i, is_direction(i) ? named('a', i) : rate(system_.derivatives.at(i)));
        for (const int i : carried_) set('x', i, named('a', i));
        std::set<int> set_already;
        for (const ProductRate& p : system_.products)
            if (!series_.is_state(p.rate) && set_already.insert(p.rate).second) set('x', p.rate, rate(p.acceleration));
    }

    void print_quantity(std::size_t j, const std::string& text) {
        line(at_ + "[" + std::to_string(j) + "] = " + text + ";");
    }
    std::string state(std::size_t j) const {
        if (j < motion_size) return x(system_.given[wall_size + j]);
        return is_first() ? "given[" + std::to_string(wall_size + j) + "]" : named('b', j);
    }
    std::string work(std::size_t j) const { return is_first() ? "T(0.0)" : named('w', j); }

private:
    // ---- what is known at the start

    void print_numbers() {
        for (int i = 0; i < series_.size(); ++i) {
            const Series::Function* f = series_.function_of(i);
            const bool is_known = f || !series_.is_series(i) || contains(system_.given, i);
            if (!is_known || !system_.live.contains(i)) continue;
            if (f && f->op == Op::tanh) print_node(f->argument, 'z');
            define(i, 'z', first(i));
        }
        print_states();
        for (const int i : system_.matrix) print_node(i, 'z');
        print_node(system_.inertia, 'z');
        const auto m = [&](int i) { return named('z', system_.matrix[i]); };
        if (system_.is_elbow) return print_inverse(named('z', system_.inertia), m(3), m(4), m(0), m(1), m(2));
        line("const T over = 1.0 / (" + m(0) + " * " + m(2) + " - " + m(1) + " * " + m(1) + ");");
        line("const T inverse22 = " + m(2) + " * over, inverse23 = -" + m(1) + " * over, inverse33 = " + m(0) +
             " * over, inverse11 = 1.0 / " + named('z', system_.inertia) + ";");
    }

    // Of a symmetric matrix, by its cofactors.
    void print_inverse(const std::string& a11, const std::string& a12, const std::string& a13, const std::string& a22,
                       const std::string& a23, const std::string& a33) {
        const auto minor = [](const std::string& a, const std::string& b, const std::string& c, const std::string& d) {
            return "(" + a + " * " + b + " - " + c + " * " + d + ")";
        };
        line("const T cofactor11 = " + minor(a22, a33, a23, a23) + ", cofactor12 = " + minor(a13, a23, a12, a33) +
             ", cofactor13 = " + minor(a12, a23, a13, a22) + ";");
        line("const T over = 1.0 / (" + a11 + " * cofactor11 + (" + a12 + " * cofactor12 + " + a13 +
             " * cofactor13));");
        line("const T inverse11 = cofactor11 * over, inverse12 = cofactor12 * over, inverse13 = cofactor13 * over;");
        line("const T inverse22 = " + minor(a11, a33, a13, a13) + " * over, inverse23 = " + minor(a12, a13, a11, a23) +
             " * over, inverse33 = " + minor(a11, a22, a12, a12) + " * over;");
    }

    std::string first(int i) const {
        const auto position = [i](const std::vector<int>& list) {
            return std::to_string(std::find(list.begin(), list.end(), i) - list.begin());
        };
        if (const Series::Function* f = series_.function_of(i)) {
            if (f->op == Op::tanh) return "tanh(" + named('z', f->argument) + ")";
            const auto angle = std::find(system_.angles.begin(), system_.angles.end(), f->argument);
            if (angle == system_.angles.end()) throw std::logic_error("a sine of something that is no angle of a link");
            static constexpr std::array names{"1", "2", "23"};
            return std::string(f->op == Op::sine ? "p.S" : "p.C") + names[angle - system_.angles.begin()];
        }
        if (i == system_.frequency_2) return "frequency_2";
        if (contains(system_.given, i)) return "given[" + position(system_.given) + "]";
        if (series_[i].op == Op::input) return "*numbers.at[" + position(system_.numbers) + "]";
        return coefficient(i, 'z');
    }

    // ---- one order

    // What the order before has left.
    std::vector<int> known() const {
        std::vector<int> nodes = system_.states;
        nodes.insert(nodes.end(), carried_.begin(), carried_.end());
        for (const ProductRate& p : system_.products)
            if (!contains(nodes, p.rate)) nodes.push_back(p.rate);
        return nodes;
    }

    // From the states' coefficients of order k those of order k + 1. `type`: "T " where they are declared.
    void print_order(const std::string& type) {
        if (!is_first()) {
            begin_order();
            for (const int i : known()) store(i, 'x');
            print_sums(sums_, {sums_.begin(), sums_.end()}, of_this_order);
            print_sums(ahead_sums_, {ahead_sums_.begin(), ahead_sums_.end()}, of_next_order);
        }
        print_ahead(type);
        print_accelerations();
        for (const int i : factors_)
            if (!ahead_.contains(i)) print_node(i, kind_);
        for (const int i : system_.roots())
            if (!contains(system_.remainder, i)) print_node(i, kind_);
        print_signals();
        print_advance(type);
    }

    void print_last_signals() {
        begin_order();
        print_sums(sums_, system_.nodes_of(system_.signals), of_this_order);
        for (const int i : system_.signals) print_node(i, 'x');
        print_signals();
    }

    // From the coefficients of the same order. The newest are added last, because they are computed last.
    std::string coefficient(int i, char kind) const {
        const TapeNode& n = series_[i];
        const auto z = [](int operand) { return named('z', operand); };
        const bool is_whole = is_first() && kind != 'a';
        const bool a_moves = is_whole || series_.is_series(n.a),
                   b_moves = is_whole || (n.b >= 0 && series_.is_series(n.b));
        const std::string a = n.a < 0 ? "" : value(n.a, kind), b = n.b < 0 ? "" : value(n.b, kind);
        switch (n.op) {
            case Op::constant: return literal(n.number);
            case Op::add: return !a_moves ? b : !b_moves ? a : a + " + " + b;
            case Op::subtract: return !a_moves ? "-" + b : !b_moves ? a : a + " - " + b;
            case Op::negate: return "-" + a;
            case Op::divide: return a + " / " + b;
            case Op::min: return "min(" + a + ", " + b + ")";
            case Op::max: return "max(" + a + ", " + b + ")";
            case Op::multiply: break;
            default: throw std::logic_error("an operation that no kernel knows");
        }
        if (is_whole || !series_.is_convolution(i)) return a + " * " + b;
        if (n.a == n.b) return "2.0 * (" + named('m', i) + " + " + z(n.a) + " * " + a + ")";
        return "(" + named('m', i) + " + " + a + " * " + z(n.b) + ") + " + z(n.a) + " * " + b;
    }

    // ---- inner sums of order n: a[1] b[n-1] + ... + a[n-1] b[1], from the middle outwards, so that the newest come last

    // Where the sums of an order begin: whether it has a middle, and where that is; the innermost pair.
    struct Order {
        const char *has_middle, *middle, *up, *down;
    };
    static constexpr Order of_this_order{"k % 2 == 0", "r + half", "r + before", "now - before"};
    static constexpr Order of_next_order{"k % 2 == 1", "r + half + rows", "r + half", "next - half"};

    void print_sums(const std::vector<int>& products, const std::set<int>& needed, const Order& order) {
        constexpr std::ptrdiff_t at_once = 10;  // what the registers hold
        std::vector<Sum> sums = sums_of(products);
        std::erase_if(sums, [&](const Sum& sum) {
            return std::none_of(sum.products.begin(), sum.products.end(), [&](int i) { return needed.contains(i); });
        });
        for (auto next = sums.begin(); next != sums.end();) {
            const auto last = next + std::min(at_once, sums.end() - next);
            print_loop({next, last}, order);
            next = last;
        }
        for (const Sum& sum : sums) print_parts(sum, needed);
    }

    void print_loop(const std::vector<Sum>& sums, const Order& order) {
        const auto product = [&](const Sum& sum, const std::string& first, const std::string& second) {
            return loaded(first, sum.first) + " * " + loaded(second, sum.second);
        };
        for (const Sum& sum : sums) line(sum.type + " " + sum.name + "(0.0);");
        line(std::string("if (") + order.has_middle + ") {");
        line(std::string("    const T* const mid = ") + order.middle + ";");
        for (const Sum& sum : sums) {
            const std::string middle = product(sum, "mid", "mid");
            line("    " + sum.name + " = " + (sum.is_half ? "0.5 * (" + middle + ")" : middle) + ";");
        }
        line("}");
        line(std::string("for (const T *up = ") + order.up + ", *down = " + order.down +
             "; up > r; up -= rows, down += rows) {");
        for (const Sum& sum : sums)
            line("    " + sum.name + " += " + product(sum, "up", "down") +
                 (sum.is_half ? "" : " + " + product(sum, "down", "up")) + ";");
        line("}");
    }

protected:
    const System& system_;
    const Series& series_;
    std::ostream& out_;
    std::set<int> ahead_, late_;          // known one order ahead; depend on the accelerations
    std::set<int> carried_;               // of ahead_: what others need of order k
    std::vector<int> sums_, ahead_sums_;  // products of order k and of order k + 1
    std::set<int> factors_;               // of products
    std::vector<Force> forces_;           // of the directions, by what turns them
    int row_count_ = 0;
    std::string indent_, at_, scale_;
    char kind_ = 'z';

private:
    std::map<int, int> row_of_;            // of a factor
    std::set<std::pair<int, char>> done_;  // the coefficients that are printed, with their kind
};

}  // namespace arm3r

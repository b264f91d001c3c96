// Writes the Taylor kernels: for each recipe the arm's motion is recorded, turned into a system of sums and products of
// series (docs/model.md, 5.5), and printed as a C++ struct. Run by the build: derive_taylor FILE.

#include <fstream>
#include <sstream>
#include <string>

#include "integrate/taylor_system.hpp"

namespace arm3r {
namespace {

constexpr std::size_t max_sums_at_once = 10;  // what the registers hold

// Which numbers a kernel is for: packs, or doubles, of which it sums up several products side by side, with the same bits.
enum class Numbers { packs, doubles };

std::string named(char kind, int i) { return kind + std::to_string(i); }

std::string literal(double x) {
    std::ostringstream text;
    text << "T(" << std::hexfloat << x << ")";
    return text.str();
}

// Of node I, zI is the first coefficient, or the node where it is no series; xI the coefficient of order k; pI the same
// without the accelerations of that order; aI the coefficient of order k + 1, ahead of the others. mI is the inner sum
// of a product, without its first and its newest factors; hI the coefficient of order k + 1 of a product with a rate,
// without the acceleration. Nodes with a row keep all their coefficients in r.
class Printer {
public:
    Printer(const System& system, Numbers numbers, std::ostream& out)
        : system_(system), series_(system.series), numbers_(numbers), out_(out) {
        ahead_ = system.nodes_of({system.inertia});
        ahead_.insert(system.directions.begin(), system.directions.end());
        std::set<int> nodes = system.nodes_of(system.roots()), with_rate;
        nodes.insert(ahead_.begin(), ahead_.end());
        for (const ProductRate& p : system.products) {
            late_.insert({p.node, p.acceleration});
            with_rate.insert(p.product);
        }
        nodes.insert(with_rate.begin(), with_rate.end());
        for (const int i : nodes) {
            if (late_.contains(series_[i].a) || late_.contains(series_[i].b)) late_.insert(i);
            if (series_.is_convolution(i))
                (ahead_.contains(i) || with_rate.contains(i) ? ahead_sums_ : sums_).push_back(i);
        }
        for (const std::vector<int>* sums : {&sums_, &ahead_sums_})
            for (const std::vector<int>& group : groups_of(*sums)) give_rows(group);
    }

    void print(std::size_t recipe) {
        out_ << "\n// " << sums_.size() + ahead_sums_.size() << " products of series.\n"
             << (numbers_ == Numbers::packs
                     ? "template <class T>\nstruct Recurrence<" + std::to_string(recipe) + ", T> {\n"
                     : "template <>\nstruct Recurrence<" + std::to_string(recipe) +
                           ", double> {\n    using T = double;\n")
             << "    ARM3R_INLINE static void expand(const Plant<T>& plant, [[maybe_unused]] const T& frequency_2,\n"
             << "                                    const T* given, int order, T (*c)[quantities]) {\n"
             << "        constexpr int rows = " << row_count_ << ";\n"
             << "        alignas(64) T r[(max_degree + 2) * rows];\n"
             << "        T *now = r, *next = r + rows;\n"
             << "        const Numbers<T> numbers(plant);\n";
        indent_ = "        ", kind_ = 'z', at_ = "c[0]", scale_ = "";
        print_numbers();
        print_order("T ");
        out_ << "        int k = 1;\n        for (;; ++k) {\n            now = next, next += rows;\n";
        indent_ = "            ", kind_ = 'x', at_ = "c[k]", scale_ = " * reciprocals[k + 1]";
        print_states();
        out_ << "            if (k == order) break;\n";
        print_order("");
        out_ << "        }\n";
        indent_ = "        ";
        print_last_signals();
        out_ << "    }\n};\n";
    }

private:
    bool is_first() const { return kind_ == 'z'; }

    // ---- what is known at the start

    void print_numbers() {
        std::set<int> turned;
        for (int i = 0; i < series_.size(); ++i) {
            const Series::Function* f = series_.function_of(i);
            const bool is_known = f || !series_.is_series(i) || contains(system_.given, i);
            if (!is_known || !system_.live.contains(i)) continue;
            if (f && f->op != Op::tanh && turned.insert(f->argument).second) {
                print_node(f->argument, 'z');
                out_ << indent_ << "const SinCos<T> turn" << f->argument << " = sincos(" << named('z', f->argument)
                     << ");\n";
            } else if (f && f->op == Op::tanh) {
                print_node(f->argument, 'z');
            }
            define(i, 'z', first(i));
        }
        print_states();
        for (const int i : system_.matrix) print_node(i, 'z');
        print_node(system_.inertia, 'z');
        const auto m = [&](int i) { return named('z', system_.matrix[i]); };
        out_ << indent_ << "const T over = 1.0 / (" << m(0) << " * " << m(2) << " - " << m(1) << " * " << m(1) << ");\n"
             << indent_ << "const T inverse22 = " << m(2) << " * over, inverse23 = -" << m(1)
             << " * over, inverse33 = " << m(0) << " * over, inverse11 = 1.0 / " << named('z', system_.inertia)
             << ";\n";
    }

    std::string first(int i) const {
        const auto position = [i](const std::vector<int>& list) {
            return std::to_string(std::find(list.begin(), list.end(), i) - list.begin());
        };
        if (const Series::Function* f = series_.function_of(i)) {
            if (f->op == Op::tanh) return "tanh(" + named('z', f->argument) + ")";
            return "turn" + std::to_string(f->argument) + (f->op == Op::sine ? ".sin" : ".cos");
        }
        if (i == system_.frequency_2) return "frequency_2";
        if (series_.is_state(i)) return "given[" + position(system_.given) + "]";
        if (series_[i].op == Op::input) return "*numbers.at[" + position(system_.numbers) + "]";
        return coefficient(i, 'z');
    }

    // ---- one order

    void begin_order() {
        done_.clear();
        for (const int i : system_.states) done_.insert({i, 'x'});
    }

    // From the states' coefficients of order k those of order k + 1. `type`: "T " where they are declared.
    void print_order(const std::string& type) {
        if (!is_first()) {
            begin_order();
            for (const int i : system_.states) mark(i, 'x');
            for (const ProductRate& p : system_.products) print_node(p.rate, 'x');
            print_sums(sums_, {sums_.begin(), sums_.end()}, "k");
            print_sums(ahead_sums_, {ahead_sums_.begin(), ahead_sums_.end()}, "(k + 1)");
        }
        print_ahead(type);
        print_accelerations();
        for (const auto& [i, rows] : rows_)
            if (!ahead_.contains(i)) print_node(i, kind_);
        for (const int i : system_.roots())
            if (!contains(system_.remainder, i)) print_node(i, kind_);
        print_signals();
        print_advance(type);
    }

    // The coefficients of order k + 1 that depend on no acceleration of order k.
    void print_ahead(const std::string& type) {
        for (const ProductRate& p : system_.products) {
            if (p.factor == system_.inertia) continue;
            if (is_first()) print_node(p.product, 'z');
            else define(p.product, 'x', named('h', p.product) + " + " + named('z', p.factor) + " * " + x(p.rate));
        }
        for (const int i : system_.directions) {
            print_node(system_.derivatives.at(i), kind_);
            define(i, 'a', x(system_.derivatives.at(i)) + scale_);
        }
        if (is_first())
            for (const int i : ahead_sums_) out_ << indent_ << "const T " << named('m', i) << "(0.0);\n";
        print_node(system_.inertia, 'a');
        for (const ProductRate& p : system_.products)
            out_ << indent_ << type << named('h', p.product) << " = " << named('m', p.product) << " + "
                 << named('a', p.factor) << " * " << named('z', p.rate) << ";\n";
    }

    void print_accelerations() {
        out_ << indent_ << "const T orders(" << (is_first() ? "1.0" : "k + 1.0") << ");\n";
        for (const ProductRate& p : system_.products) define(p.node, 'p', "orders * " + named('h', p.product));
        std::string rest[3];
        for (int i = 0; i < 3; ++i) {
            print_node(system_.remainder[i], 'p');
            rest[i] = value(system_.remainder[i], 'p');
        }
        const auto& a = system_.accelerations;
        define(a[0], kind_, "inverse11 * " + rest[0]);
        define(a[1], kind_, "inverse22 * " + rest[1] + " + inverse23 * " + rest[2]);
        define(a[2], kind_, "inverse23 * " + rest[1] + " + inverse33 * " + rest[2]);
        for (const ProductRate& p : system_.products)
            if (p.factor != system_.inertia)
                define(p.node, kind_, named('p', p.node) + " + " + named('z', p.factor) + " * " + x(p.acceleration));
    }

    void print_states() {
        for (std::size_t j = 0; j < state_size; ++j) {
            const int i = system_.given[wall_size + j];
            const std::string balance = is_first() ? "given[" + std::to_string(wall_size + j) + "]" : named('b', j);
            out_ << indent_ << at_ << "[" << j << "] = " << (j < motion_size ? x(i) : balance) << ";\n";
        }
        for (std::size_t j = 0; j < 3; ++j)
            out_ << indent_ << at_ << "[" << works_at + j << "] = " << (is_first() ? "T(0.0)" : named('w', j)) << ";\n";
    }

    void print_signals() {
        for (std::size_t j = state_size; j < works_at; ++j) {
            const std::size_t signal = j - state_size;
            const bool is_there = signal < system_.signals.size();
            out_ << indent_ << at_ << "[" << j << "] = " << (is_there ? x(system_.signals[signal]) : "T(0.0)") << ";\n";
        }
    }

    void print_last_signals() {
        begin_order();
        print_sums(sums_, system_.nodes_of(system_.signals), "k");
        for (const int i : system_.signals) print_node(i, 'x');
        print_signals();
    }

    void print_advance(const std::string& type) {
        const auto rate = [&](int i) {
            if (!is_first() && !series_.is_series(i)) return std::string("T(0.0)");
            return x(i) + scale_;
        };
        for (std::size_t j = 0; j < quadrature_count; ++j)
            out_ << indent_ << type << named('b', motion_size + j) << " = " << rate(system_.energy[j]) << ";\n";
        for (std::size_t j = 0; j < 3; ++j)
            out_ << indent_ << type << named('w', j) << " = " << rate(system_.powers[j]) << ";\n";
        for (const int i : system_.states)
            out_ << indent_ << type << named('x', i) << " = "
                 << (contains(system_.directions, i) ? named('a', i) : rate(system_.derivatives.at(i))) << ";\n";
    }

    // ---- nodes

    static bool contains(const std::vector<int>& list, int i) {
        return std::find(list.begin(), list.end(), i) != list.end();
    }

    // The name of a node's coefficient: of order k; of one that no acceleration changes as 'p'.
    std::string x(int i) const { return value(i, kind_); }
    std::string value(int i, char kind) const {
        if (!series_.is_series(i)) return named('z', i);
        return named(kind == 'p' && !late_.contains(i) ? kind_ : kind, i);
    }

    void mark(int i, char kind) {
        done_.insert({i, kind});
        const bool is_ahead = kind == 'a', is_kept = kind == 'z' || is_ahead || (kind == 'x' && !ahead_.contains(i));
        const auto rows = rows_.find(i);
        if (rows == rows_.end() || !is_kept) return;
        for (const int row : rows->second)
            out_ << indent_ << (is_ahead ? "next[" : "now[") << row << "] = " << named(kind, i) << ";\n";
    }

    void define(int i, char kind, const std::string& text) {
        out_ << indent_ << "const T " << named(kind, i) << " = " << text << ";\n";
        mark(i, kind);
    }

    // With what it needs.
    void print_node(int i, char kind) {
        if (kind == 'p' && !late_.contains(i)) kind = kind_;
        if (i < 0 || !series_.is_series(i) || !done_.insert({i, kind}).second) return;
        print_node(series_[i].a, kind), print_node(series_[i].b, kind);
        define(i, kind, coefficient(i, kind));
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

    // ---- inner sums of order n: a[1] b[n-1] + ... + a[n-1] b[1], from the middle outwards, so that the newest come last;
    // of a square, half of it

    bool is_square(int i) const { return series_[i].a == series_[i].b; }

    // Sums that are computed side by side: doubles by four and by two, squares alone.
    std::vector<std::vector<int>> groups_of(const std::vector<int>& sums) const {
        std::vector<std::vector<int>> groups;
        std::vector<int> products;
        for (const int i : sums) {
            if (numbers_ == Numbers::packs || is_square(i)) groups.push_back({i});
            else products.push_back(i);
        }
        for (auto next = products.begin(); next != products.end();) {
            const std::ptrdiff_t left = products.end() - next, width = left >= 4 ? 4 : left >= 2 ? 2 : 1;
            groups.emplace_back(next, next + width);
            next += width;
        }
        return groups;
    }

    // Doubles of a group stand beside each other: the first factors, then the second ones.
    void give_rows(const std::vector<int>& group) {
        const bool is_shared = numbers_ == Numbers::packs;
        for (const bool second : {false, true})
            for (const int i : group) {
                const int factor = second ? series_[i].b : series_[i].a;
                std::vector<int>& rows = rows_[factor];
                if (rows.empty() || !is_shared) rows.push_back(row_count_++);
                row_of_[{i, second}] = is_shared ? rows.front() : rows.back();
            }
    }

    // Those that are needed, in the groups of all.
    void print_sums(const std::vector<int>& sums, const std::set<int>& needed, const std::string& n) {
        std::vector<std::vector<int>> groups = groups_of(sums);
        std::erase_if(groups, [&](const std::vector<int>& group) {
            return std::none_of(group.begin(), group.end(), [&](int i) { return needed.contains(i); });
        });
        for (auto next = groups.begin(); next != groups.end();) {
            const auto last =
                groups.end() - next > std::ptrdiff_t(max_sums_at_once) ? next + max_sums_at_once : groups.end();
            print_loop({next, last}, needed, n);
            next = last;
        }
    }

    // A product of a group: of the first factors of one order and the second ones of another.
    std::string term(const std::vector<int>& group, const std::string& first, const std::string& second) const {
        const auto factors = [&](const std::string& order, bool is_second) {
            const std::string row = std::to_string(row_of_.at({group[0], is_second}));
            return group.size() == 1 ? order + "[" + row + "]" : type_of(group) + "::load(" + order + " + " + row + ")";
        };
        return factors(first, false) + " * " + factors(second, true);
    }

    static std::string type_of(const std::vector<int>& group) {
        return group.size() == 1 ? "T" : "Pack<" + std::to_string(group.size()) + ">";
    }
    static std::string sum_of(const std::vector<int>& group) { return named(group.size() == 1 ? 'm' : 'g', group[0]); }

    void print_loop(const std::vector<std::vector<int>>& groups, const std::set<int>& needed, const std::string& n) {
        for (const auto& g : groups) out_ << indent_ << type_of(g) << " " << sum_of(g) << "(0.0);\n";
        out_ << indent_ << "if (" << n << " % 2 == 0) {\n"
             << indent_ << "    const T* const mid = r + " << n << " / 2 * rows;\n";
        for (const auto& g : groups) {
            const std::string product = term(g, "mid", "mid");
            out_ << indent_ << "    " << sum_of(g) << " = " << (is_square(g[0]) ? "0.5 * (" + product + ")" : product)
                 << ";\n";
        }
        out_ << indent_ << "}\n"
             << indent_ << "for (const T *up = r + (" << n << " - 1) / 2 * rows, *down = r + (" << n << " - (" << n
             << " - 1) / 2) * rows; up > r; up -= rows, down += rows) {\n";
        for (const auto& g : groups)
            out_ << indent_ << "    " << sum_of(g) << " += " << term(g, "up", "down")
                 << (is_square(g[0]) ? "" : " + " + term(g, "down", "up")) << ";\n";
        out_ << indent_ << "}\n";
        for (const auto& g : groups)
            for (std::size_t lane = 0; g.size() > 1 && lane < g.size(); ++lane)
                if (needed.contains(g[lane]))
                    out_ << indent_ << "const T " << named('m', g[lane]) << " = " << sum_of(g) << "[" << lane << "];\n";
    }

    const System& system_;
    const Series& series_;
    const Numbers numbers_;
    std::ostream& out_;
    std::set<int> ahead_, late_;                  // known one order ahead; depend on the accelerations
    std::vector<int> sums_, ahead_sums_;          // products of order k and of order k + 1
    std::map<int, std::vector<int>> rows_;        // of the factors of products
    std::map<std::pair<int, bool>, int> row_of_;  // of the first and of the second factor of a product
    int row_count_ = 0;
    std::set<std::pair<int, char>> done_;  // the coefficients that are printed, with their kind
    std::string indent_, at_, scale_;
    char kind_ = 'z';
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
        const System system(recording.tape());
        for (const Numbers numbers : {Numbers::packs, Numbers::doubles}) Printer(system, numbers, out).print(i);
    }
}

}  // namespace arm3r

int main(int count, char** arguments) {
    std::ofstream file(count == 2 ? arguments[1] : "");
    arm3r::derive(file);
    return file.flush() ? 0 : 1;
}

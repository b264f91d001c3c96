#pragma once
// The text of a Taylor kernel for doubles: four products, or what belongs to the four directions, side by side, with the
// bits of the kernel for packs.

#include "integrate/taylor_printer.hpp"

namespace arm3r {

// Sums of four products are named gI, by the first of them.
class PrinterByFour : public Printer {
public:
    PrinterByFour(const System& system, std::ostream& out) : Printer(system, out) {
        for (const std::vector<int>* products : {&sums_, &ahead_sums_})
            for (const std::vector<int>& group : groups_of(*products))
                for (const bool second : {false, true}) {
                    const std::vector<int> factors = factors_of(group, second);
                    rows_[factors];
                    if (are_ahead(factors)) continue;
                    std::copy_if(factors.begin(), factors.end(), std::inserter(carried_, carried_.end()),
                                 [&](int i) { return is_scalar_ahead(i); });
                }
        const auto is_zero = [&](int i) { return series_.is_number(i, 0); };
        for (std::size_t j = 0; j < quadrature_count; ++j) is_zero_[motion_size + j] = is_zero(system_.energy[j]);
        for (std::size_t j = 0; j < signals_size; ++j) is_zero_[state_size + j] = j >= system_.signals.size();
        for (std::size_t j = 0; j < 3; ++j) is_zero_[works_at + j] = is_zero(system_.powers[j]);
    }

protected:
    std::string head(const std::string& recipe) const override {
        return "template <>\nstruct Recurrence<" + recipe + ", double> {\n    using T = double;\n";
    }

    // ---- sums

    void give_rows() override {
        for (auto& [factors, row] : rows_) row = row_count_, row_count_ += width;
    }
    std::vector<Sum> sums_of(const std::vector<int>& products) const override {
        std::vector<Sum> sums;
        for (const std::vector<int>& group : groups_of(products))
            sums.push_back({group, "Pack<4>", named('g', group[0]), rows_.at(factors_of(group, false)),
                            rows_.at(factors_of(group, true))});
        return sums;
    }
    std::string loaded(const std::string& order, int row) const override {
        return "Pack<4>::load(" + order + " + " + std::to_string(row) + ")";
    }
    // Those of the forces and of the slopes stay together.
    void print_parts(const Sum& sum, const std::set<int>& needed) override {
        if (sum.products == forced_products() || sum.products == rate_products()) return;
        for (std::size_t lane = 0; lane < sum.products.size(); ++lane) {
            const int i = sum.products[lane];
            if (needed.contains(i))
                line("const T " + named('m', i) + " = " + (is_square(i) ? "0.5 * " : "") + lane_of(sum.name, lane) +
                     ";");
        }
    }

    // The factors of four products are stored at once: a load of four numbers that were stored one by one waits for them.
    void store(int i, char kind) override {
        known_.insert({i, kind});
        const auto is_known = [&](int factor) { return known_.contains({factor, kind}); };
        for (const auto& [factors, row] : rows_) {
            const bool is_kept = kind == 'z' || kind == (are_ahead(factors) ? 'a' : 'x');
            if (!is_kept || !contains(factors, i) || !std::all_of(factors.begin(), factors.end(), is_known)) continue;
            line(four_of(factors, [&](int factor) { return named(kind, factor); }) + ".store(" +
                 (kind == 'a' ? "next + " : "now + ") + std::to_string(row) + ");");
        }
    }
    void begin_order() override {
        Printer::begin_order();
        known_.clear();
    }

    // ---- the directions and their forces

    // `slopes`: their products with the rates, of order k, in the order of the directions; `turned`: the directions of
    // order k, and `factors` of the first, in the order of the forces; y: the accelerations of order k - 1.
    void print_before_loop() override {
        const auto& p = system_.products;
        const auto z = [](int i) { return named('z', i); };
        define_four("directions", four_of(p, [&](const ProductRate& q) { return z(q.factor); }));
        define_four("factors", four_of(forces_, [&](const Force& f) { return z(f.direction); }));
        define_four("forces", four_of(forces_, [&](const Force& f) { return z(f.node); }));
        define_four("numbers_of_forces", four_of(forces_, [&](const Force& f) { return z(f.number); }));
        define_four("slope_factors", four_of(p, [&](const ProductRate& q) { return z(slope_of(q.factor).factor); }));
        define_four("rates", four_of(p, [&](const ProductRate& q) { return z(q.rate); }));
        line("Pack<4> h = " + four_of(p, [&](const ProductRate& q) { return named('h', slope_of(q.factor).product); }) +
             ";");
        line("Pack<4> turned = " + four_of(forces_, [&](const Force& f) { return named('a', f.direction); }) + ";");
        line("Pack<4> y = " + four_of(p, [&](const ProductRate& q) { return z(q.acceleration); }) + ";");
    }

    void print_ahead(const std::string& type) override {
        if (is_first()) return Printer::print_ahead(type);
        const auto& p = system_.products;
        define_four("slopes", "h + (slope_factors * T(reciprocals[k])) * y");
        for (int lane = 0; lane < width; ++lane) define(slope_of(p[lane].factor).product, 'x', lane_of("slopes", lane));
        define_four("scale", four_of(p, [&](const ProductRate& q) {
                        return std::string(has_negative_slope(q.factor) ? "-" : "") + "reciprocals[k + 1]";
                    }));
        define_four("ahead", "slopes * scale");
        for (int lane = 0; lane < width; ++lane) define(p[lane].factor, 'a', lane_of("ahead", lane));
        print_node(system_.inertia, 'a');
        define_four("products", named('g', p[0].product) + " + slopes * (scale * rates)");
        line("h = " +
             four_of(p, [&](const ProductRate& q) { return lane_of("products", &slope_of(q.factor) - &p[0]); }) + ";");
        line(named('h', p.back().product) + " = " + named('m', p.back().product) + " + " + newest_of(p.back()) + ";");
    }

    void print_accelerations() override {
        if (is_first()) return Printer::print_accelerations();
        const auto& p = system_.products;
        print_orders();
        define(p.back().node, 'p', "orders * " + named('h', p.back().product));
        for (const Force& f : forces_) print_node(f.rest, 'x');
        define_four("rests", four_of(forces_, [&](const Force& f) { return rest_of(f); }));
        define_four("forces_before", "rests - (orders * numbers_of_forces) * products");
        define_four("pushes", "(" + named('g', forces_[0].product) + " + turned * forces) + factors * forces_before");
        for (int lane = 0; lane < width; ++lane) define(forces_[lane].product, 'p', lane_of("pushes", lane));
        print_solution();
        define_four("accelerations", four_of(p, [&](const ProductRate& q) { return x(q.acceleration); }));
        define_four("forces_k", "rests - numbers_of_forces * (orders * products + directions * accelerations)");
        for (int lane = 0; lane < width; ++lane) define(forces_[lane].node, 'x', lane_of("forces_k", lane));
    }

    void print_advance(const std::string& type) override {
        print_next_order(type);
        if (is_first()) return;
        line("turned = " + four_of(forces_, [&](const Force& f) { return named('a', f.direction); }) + ";");
        line("y = accelerations;");
    }

    // ---- what is kept of an order

    void print_states() override {
        if (is_first()) return Printer::print_states();
        for (std::size_t j = 0; j < state_size; ++j)
            if (!is_zero_[j]) print_quantity(j, state(j));
        for (std::size_t j = 0; j < 3; ++j)
            if (!is_zero_[works_at + j]) print_quantity(works_at + j, work(j));
        print_zeros();
    }
    void print_signals() override {
        if (is_first() || !system_.signals.empty()) Printer::print_signals();
    }

private:
    static constexpr int width = 4;

    static std::string lane_of(const std::string& name, std::ptrdiff_t lane) {
        return name + "[" + std::to_string(lane) + "]";
    }
    template <class List, class F>
    static std::string four_of(const List& list, F name) {
        return "side_by_side(" + name(list[0]) + ", " + name(list[1]) + ", " + name(list[2]) + ", " + name(list[3]) +
               ")";
    }
    void define_four(const std::string& name, const std::string& text) {
        line("const Pack<4> " + name + " = " + text + ";");
    }

    // The zeros that stand beside each other.
    void print_zeros() {
        for (std::size_t j = 0, count; j < quantities; j += std::max<std::size_t>(count, 1)) {
            for (count = 0; count < width && j + count < quantities && is_zero_[j + count];) ++count;
            if (count == width) line("Pack<4>(0.0).store(" + at_ + " + " + std::to_string(j) + ");");
            else
                for (std::size_t n = 0; n < count; ++n) print_quantity(j + n, "0.0");
        }
    }

    std::vector<int> forced_products() const {
        return {forces_[0].product, forces_[1].product, forces_[2].product, forces_[3].product};
    }
    std::vector<int> rate_products() const {
        const auto& p = system_.products;
        return {p[0].product, p[1].product, p[2].product, p[3].product};
    }

    // Four by four: those of the directions, then the others, by the time at which their factors are known.
    std::vector<std::vector<int>> groups_of(std::vector<int> products) const {
        std::vector<std::vector<int>> groups;
        for (const std::vector<int>& group : {forced_products(), rate_products()}) {
            if (!contains(products, group[0])) continue;
            groups.push_back(group);
            for (const int i : group) std::erase(products, i);
        }
        const auto times = [&](int i) { return std::pair(time_of(factor(i, false)), time_of(factor(i, true))); };
        std::stable_sort(products.begin(), products.end(), [&](int i, int j) { return times(i) < times(j); });
        for (auto next = products.begin(); next != products.end();) {
            const auto last = next + std::min<std::ptrdiff_t>(width, products.end() - next);
            groups.emplace_back(next, last);
            next = last;
        }
        return groups;
    }

    // When a factor is known: one order ahead, at the beginning of an order, or later.
    int time_of(int i) const {
        const auto& p = system_.products;
        const auto is_rate = [i](const ProductRate& q) { return q.rate == i; };
        if (ahead_.contains(i)) return 0;
        return series_.is_state(i) || std::any_of(p.begin(), p.end(), is_rate) ? 1 : 2;
    }
    // The one that is known first comes first.
    int factor(int product, bool second) const {
        const int a = series_[product].a, b = series_[product].b;
        return second == (time_of(a) > time_of(b)) ? a : b;
    }
    // Where there are less than four, that of the first fills the rest.
    std::vector<int> factors_of(const std::vector<int>& group, bool second) const {
        std::vector<int> factors;
        for (std::size_t lane = 0; lane < width; ++lane)
            factors.push_back(factor(group[lane < group.size() ? lane : 0], second));
        return factors;
    }
    bool are_ahead(const std::vector<int>& nodes) const {
        return std::all_of(nodes.begin(), nodes.end(), [&](int i) { return ahead_.contains(i); });
    }

    std::map<std::vector<int>, int> rows_;    // of four factors beside each other: the first row
    std::array<bool, quantities> is_zero_{};  // the quantities whose coefficients from order 1 on are zero
    std::set<std::pair<int, char>> known_;
};

}  // namespace arm3r

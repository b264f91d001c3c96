// elementary_table NAME: reads pairs of doubles (x, y), writes NAME(x, y) or NAME(x) for each; raw bytes both ways.
#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "arm3r/numbers/real.hpp"

using namespace arm3r;

int main(int, char** arguments) {
    const std::map<std::string, std::function<double(double, double)>> functions{
        {"sin", [](double x, double) { return sincos(x).sin; }},
        {"cos", [](double x, double) { return sincos(x).cos; }},
        {"rotated_sin", [](double x, double delta) { return sincos_rotated(sincos(x), delta).sin; }},
        {"rotated_cos", [](double x, double delta) { return sincos_rotated(sincos(x), delta).cos; }},
        {"tanh", [](double x, double) { return arm3r::tanh(x); }},
        {"atan2", [](double y, double x) { return arm3r::atan2(y, x); }},
        {"acos", [](double x, double) { return arm3r::acos(x); }},
        {"hypot2", [](double x, double y) { return hypot2(x, y); }},
        {"fifth_root", [](double x, double) { return fifth_root(x); }},
        {"exp", [](double x, double) { return arm3r::exp(x); }},
        {"log", [](double x, double) { return arm3r::log(x); }},
        {"power", [](double x, double p) { return power(x, p); }},
    };
    const auto& f = functions.at(arguments[1]);
    double pair[2];
    while (std::fread(pair, sizeof pair, 1, stdin) == 1) {
        const double result = f(pair[0], pair[1]);
        std::fwrite(&result, sizeof result, 1, stdout);
    }
}

#include "base/error.hpp"

#include "base/text.hpp"

namespace arm3r {

namespace {

constexpr std::size_t max_problems = 20;

std::string place(const Problem& problem) {
    std::string out = visible(problem.file, 4096);
    if (problem.line > 0) out += ':' + std::to_string(problem.line);
    if (problem.column > 0) out += ':' + std::to_string(problem.column);
    return out.empty() ? out : out + ": ";
}

std::vector<Problem> at_most(std::vector<Problem> problems) {
    if (problems.size() > max_problems) problems.resize(max_problems);
    return problems;
}

std::string lines(const std::vector<Problem>& problems) {
    std::string out;
    for (const Problem& problem : problems) out += (out.empty() ? "" : "\n") + describe(problem);
    return out;
}

}  // namespace

std::string describe(const Problem& problem) {
    std::string out = place(problem) + "error[" + problem.code + "]: ";
    if (!problem.path.empty()) out += visible(problem.path, 120) + ": ";
    out += visible(problem.message, 400);
    if (!problem.got.empty()) out += ", got " + visible(problem.got, 60);
    if (!problem.allowed.empty()) out += ", allowed " + visible(problem.allowed, 400);
    if (!problem.hint.empty()) out += "; " + visible(problem.hint, 400);
    return out;
}

Error::Error(arm3r_status status, std::vector<Problem> problems)
    : status_(status), problems_(at_most(std::move(problems))), text_(lines(problems_)) {}

Error::Error(arm3r_status status, std::string message) : status_(status), text_(std::move(message)) {}

}  // namespace arm3r

#pragma once
// A list of broken rules: with messages, or, if they are not needed, only the information whether it is empty.

#include <vector>

#include "base/error.hpp"

namespace arm3r {

class ProblemList {
public:
    enum Detail { messages, count_only };
    explicit ProblemList(Detail detail) : detail_(detail) {}

    template <class MakeProblem>
    void add(const MakeProblem& problem) {
        empty_ = false;
        if (detail_ == messages) problems.push_back(problem());
    }

    bool empty() const { return empty_; }

    std::vector<Problem> problems;

private:
    const Detail detail_;
    bool empty_ = true;
};

}  // namespace arm3r

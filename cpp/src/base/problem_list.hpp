#pragma once
// The rules that were found broken: with their messages, or, where nobody would read them, only whether there are any.

#include <vector>

#include "base/error.hpp"

namespace arm3r {

class Findings {
public:
    enum Detail { messages, verdict };
    explicit Findings(Detail detail) : detail_(detail) {}

    template <class MakeProblem>
    void add(const MakeProblem& problem) {
        none_ = false;
        if (detail_ == messages) problems.push_back(problem());
    }

    bool none() const { return none_; }

    std::vector<Problem> problems;

private:
    const Detail detail_;
    bool none_ = true;
};

}  // namespace arm3r

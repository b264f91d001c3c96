#pragma once
// An error message in the user's terms: which key, what was there, what is allowed, and how to fix it.

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "arm3r/arm3r.h"

namespace arm3r {

struct Problem {
    std::string code;          // stable, e.g. "scenario.unknown_key"
    std::string path = {};     // "wall.contact.stiffness", "initial.q[1]"; may be empty
    std::string message = {};  // the rule that was broken, one sentence
    std::string got = {};      // what stood there, as written; may be empty
    std::string allowed = {};  // what may stand there; may be empty
    std::string hint = {};     // the likely fix; may be empty
    std::string file = {};
    int line = 0;    // from 1; 0: not known
    int column = 0;  // from 1, in characters
};

// One line: file:line:column: error[code]: path: message, got X, allowed Y; hint
std::string describe(const Problem& problem);

// A failed call. All problems that were found, at most 20, in the order of the file.
class Error : public std::exception {
public:
    Error(arm3r_status status, std::vector<Problem> problems);
    Error(arm3r_status status, std::string message);
    const char* what() const noexcept override { return text_.c_str(); }
    arm3r_status status() const { return status_; }
    const std::vector<Problem>& problems() const { return problems_; }

private:
    arm3r_status status_;
    std::vector<Problem> problems_;
    std::string text_;
};

}  // namespace arm3r

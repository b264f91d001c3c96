#pragma once
// Who does which job how: what the program times and counts.

#include <functional>
#include <string>
#include <vector>

namespace bench {

using Work = std::function<void(int)>;  // does the job so many times

struct Contender {
    std::string job, who, build;
    std::function<Work()> prepare;
};

// Job by job, ours first. A peer that this program was built without has no `prepare`.
std::vector<Contender> contenders();

// Throws where the peers and ours do not come to the same numbers.
void check_agreement();

}  // namespace bench

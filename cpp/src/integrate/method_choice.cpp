#include "integrate/method_choice.hpp"

#include <algorithm>

#include "arm3r/numbers/elementary.hpp"
#include "base/number_text.hpp"

namespace arm3r {
namespace {

constexpr double accuracy_limit = 1.2;  // of h lambda: above it stability limits the step of the explicit method
constexpr int enough_signs = 40, enough_doubts = 6;

}  // namespace

bool MethodChoice::changes(bool is_stiff, double t, double measure) {
    if (!(is_stiff ? measure < accuracy_limit : measure > accuracy_limit)) {
        if (++doubts_ == enough_doubts) signs_ = 0;
        return false;
    }
    doubts_ = 0;
    if (++signs_ < enough_signs) return false;
    if (count_ < max_listed) listed_[count_] = {t, measure, !is_stiff};
    count_ += 1;
    signs_ = 0;
    return true;
}

std::string MethodChoice::text() const {
    if (count_ == 0) return "dopri5 throughout: h*lambda did not stay above 1.2";
    std::string text;
    for (std::size_t i = 0; i < std::min(count_, max_listed); ++i) {
        const Change& change = listed_[i];
        text += (i == 0 ? "" : "; ") + std::string(change.to_stiff ? "rodas4" : "dopri5") +
                " from t = " + shortest(change.t) + " s on: h*lambda stood " + (change.to_stiff ? "above" : "below") +
                " 1.2 in 40 steps, at last at " + shortest(nearest_integer(100 * change.measure) / 100);
    }
    if (count_ > max_listed) text += "; and " + std::to_string(count_ - max_listed) + " changes more";
    return text;
}

}  // namespace arm3r

#pragma once
// The choice between the explicit and the stiff method along a run, and why; docs/model.md (5.7).

#include <array>
#include <cstdint>
#include <string>

namespace arm3r {

class MethodChoice {
public:
    // After a step that ends at t, with h lambda of it; returns whether the next one is by the other method: after many
    // steps of the explicit method that stability limits, and back when its steps would be as long.
    bool changes(bool is_stiff, double t, double measure);
    std::string text() const;

private:
    struct Change {
        double t, measure;  // s, h lambda
        bool to_stiff;
    };
    static constexpr std::size_t max_listed = 8;

    int signs_ = 0, doubts_ = 0;  // consecutive signs for the other method, and against it
    std::array<Change, max_listed> listed_{};
    std::size_t count_ = 0;
};

}  // namespace arm3r

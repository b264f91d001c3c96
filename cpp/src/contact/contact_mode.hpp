#pragma once
// How the tip stands to the wall; docs/model.md (4.8).

namespace arm3r {

enum class ContactMode {  // (4.8)
    free,
    contact,
    separated,  // inside a wall that would have to pull to follow the tip
    embedded,   // behind the plate without having come through its face
};

// Whether the column `contact` is 1; events mark where this changes.
inline bool is_touching(ContactMode mode) { return mode == ContactMode::contact || mode == ContactMode::separated; }

}  // namespace arm3r

#pragma once
// How the tip stands to the wall; docs/model.md (4.8).

namespace arm3r {

enum class Mode {  // (4.8)
    free,
    contact,
    separated,  // inside a wall that would have to pull to follow the tip
    embedded,   // behind the plate without having come through its face
};

// What the column `contact` tells, and what begins and ends with events.
inline bool is_touching(Mode mode) { return mode == Mode::contact || mode == Mode::separated; }

}  // namespace arm3r

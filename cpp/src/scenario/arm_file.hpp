#pragma once
// The arm of a scenario that stands in a file of its own (arm.urdf). The file is read by a function that the caller of
// the library has set: the Python package has one, and the executable calls that.

#include <string>
#include <vector>

#include "arm3r/arm3r.h"
#include "files/yaml_tree.hpp"

namespace arm3r {

void set_arm_reader(arm3r_arm_reader reader, void* user);

// The tree with the keys of an elbow arm that the file gives; those beside arm.urdf stay. What is wrong is added to
// `problems`; the keys about the file are then marked as refused. Throws Error ARM3R_E_FILE where no reader is set.
Node with_arm_file(Node root, const std::string& scenario_file, std::vector<Problem>& problems);

}  // namespace arm3r

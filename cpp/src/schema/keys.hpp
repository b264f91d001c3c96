#pragma once
// The keys of a scenario by sections, in the order of the reference page. Each function appends its own.

#include <string>
#include <vector>

#include "schema/schema.hpp"

namespace arm3r {

void append_plant(std::vector<Key>& keys);
void append_arm(std::vector<Key>& keys, const std::string& arm);  // of the plant, or a controller's copy: their path
void append_start(std::vector<Key>& keys);
void append_wall(std::vector<Key>& keys);
void append_controller(std::vector<Key>& keys);
void append_reference(std::vector<Key>& keys);
void append_sampling(std::vector<Key>& keys);
void append_observer(std::vector<Key>& keys);
void append_push(std::vector<Key>& keys);
void append_solver(std::vector<Key>& keys);
void append_time(std::vector<Key>& keys);

}  // namespace arm3r

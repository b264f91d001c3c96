// Prints nothing: its exit code is the number of doubles in the widest registers of this processor.
#include "arm3r/numbers/widths.hpp"

int main() { return arm3r::max_lanes(); }

#pragma once
// How far people usually vary a number: what a slider shows. A key may have much wider bounds.

#include "schema/schema.hpp"

namespace arm3r {

struct UsualRange {
    double around_zero = 1;  // in the key's unit: how far a number goes that is 0
    double factor = 30;      // by which a positive number goes down and up
    bool is_signed = false;  // as sensible below zero as above
    bool is_turn = false;    // from -pi to pi, whatever it is
};

UsualRange usual_range(const Key& key);

}  // namespace arm3r

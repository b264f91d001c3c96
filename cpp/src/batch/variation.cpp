#include "batch/variation.hpp"

#include <string>
#include <vector>

#include "base/error.hpp"
#include "schema/schema.hpp"
#include "validate/validate.hpp"

namespace arm3r {

void check_variation(const Variation& variation) {
    refuse_unknown_choices(variation.params);
    std::vector<bool> seen(param_count());
    for (const std::size_t number : variation.varied) {
        if (number >= param_count())
            throw Error(ARM3R_E_INDEX, "varied: there is no number " + std::to_string(number) + "; there are " +
                                           std::to_string(param_count()));
        if (seen[number]) throw Error(ARM3R_E_INDEX, "varied: " + param_name(number) + " is named twice");
        seen[number] = true;
        const Key& key = key_at(number);
        if (key.kind == Kind::choice || key.kind == Kind::flag || key.kind == Kind::section)
            throw Error(ARM3R_E_INDEX, "varied: " + key.path + " is a choice, not a number; make a batch for each");
        if (key.kind == Kind::column)
            throw Error(ARM3R_E_INDEX,
                        "varied: " + key.path + " chooses columns of a log; arm3r_batch_rows chooses those of a batch");
        if (key.kind == Kind::file)
            throw Error(ARM3R_E_INDEX, "varied: " + key.path + " is a file, not a number; make a batch for each");
        const std::size_t length = key.any_length ? list_at(variation.params, key).size() : 0;
        if (length > key.size)
            throw Error(ARM3R_E_INDEX, "varied: " + key.path + " has " + std::to_string(length) +
                                           " numbers; a list can be varied up to " + std::to_string(key.size));
    }
}

}  // namespace arm3r

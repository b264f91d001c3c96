// The sizes of the structures that a host lays out in memory.

#include "arm3r/arm3r.h"

// bytes: of arm3r_run_options, arm3r_event, arm3r_batch_rows and arm3r_batch_options.
extern "C" ARM3R_API const uint32_t* arm3r_wasm_struct_sizes(void) {
    static const uint32_t sizes[] = {sizeof(arm3r_run_options), sizeof(arm3r_event), sizeof(arm3r_batch_rows),
                                     sizeof(arm3r_batch_options)};
    return sizes;
}

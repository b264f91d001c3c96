// CSV for a host that cannot hand over a function pointer.

#include <cstdlib>
#include <string>

#include "arm3r/arm3r.h"

// As arm3r_run_csv, into memory that the host gives back by free().
extern "C" ARM3R_API int32_t arm3r_wasm_csv(const arm3r_run* run, char** text, size_t* size) {
    std::string all;
    const arm3r_sink append = [](void* user, const char* data, size_t count) -> int32_t {
        static_cast<std::string*>(user)->append(data, count);
        return 0;
    };
    if (const int32_t status = arm3r_run_csv(run, append, &all); status != ARM3R_OK) return status;
    *text = static_cast<char*>(std::malloc(all.size()));
    if (!*text) return ARM3R_E_MEMORY;
    *size = all.copy(*text, all.size());
    return ARM3R_OK;
}

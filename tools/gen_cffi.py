"""Write what Python calls the library by, from the public header.

python gen_cffi.py CDEF OUTPUT.c           the source of the extension
python gen_cffi.py CDEF OUTPUT.py LIBRARY  a module that loads LIBRARY, a path seen from it: it needs no compiler
"""

import sys
from pathlib import Path

import cffi

CALLED_FROM_C = """
extern "Python" int32_t arm3r_python_progress(void *user, double t, double stop, int64_t steps);
extern "Python" int32_t arm3r_python_batch_progress(void *user, int64_t runs_done, int64_t runs);
extern "Python" int32_t arm3r_python_tick(double t);
extern "Python" int32_t arm3r_python_arm_reader(void *user, const char *request, const char **text);
int32_t arm3r_python_law(void *user, const arm3r_law_state *state, double *tau);
extern "Python" int32_t arm3r_python_batch_law(void *user, const arm3r_law_state *state, double *tau);
"""
# A law in Python: `user` holds the addresses of memory for the state and for the torque. Python is called with the time
# alone, so that it need not make objects of three addresses.
LAW = """
#include <string.h>

#include "arm3r/arm3r.h"

static int32_t arm3r_python_tick(double t);

static int32_t arm3r_python_law(void *user, const arm3r_law_state *state, double *tau) {
    void *const *memory = user;
    memcpy(memory[0], state, sizeof *state);
    const int32_t status = arm3r_python_tick(state->t);
    memcpy(tau, memory[1], 3 * sizeof *tau);
    return status;
}
"""
LOADED = """
from pathlib import Path as _Path

lib = ffi.dlopen(str(_Path(__file__).parent / {library!r}))
"""

cdef, output, *library = sys.argv[1:]
ffi = cffi.FFI()
if library:
    ffi.cdef(Path(cdef).read_text())
    ffi.set_source("arm3r_cpp._arm3r", None)
    ffi.emit_python_code(output)
    with open(output, "a") as module:
        module.write(LOADED.format(library=library[0]))
else:
    ffi.cdef(Path(cdef).read_text() + CALLED_FROM_C)
    ffi.set_source("arm3r_cpp._arm3r", LAW)
    ffi.emit_c_code(output)

"""Write the C source of the Python extension: python gen_cffi.py CDEF OUTPUT."""

import sys
from pathlib import Path

import cffi

CALLED_FROM_C = """
extern "Python" int32_t arm3r_python_progress(void *user, double t, double stop, int64_t steps);
extern "Python" int32_t arm3r_python_batch_progress(void *user, int64_t runs_done, int64_t runs);
extern "Python" int32_t arm3r_python_law(void *user, const arm3r_law_state *state, double *tau);
extern "Python" int32_t arm3r_python_batch_law(void *user, const arm3r_law_state *state, double *tau);
"""

cdef, output = sys.argv[1:]
ffi = cffi.FFI()
ffi.cdef(Path(cdef).read_text() + CALLED_FROM_C)
ffi.set_source("arm3r_cpp._arm3r", '#include "arm3r/arm3r.h"')
ffi.emit_c_code(output)

# WebAssembly by zig's clang: cmake -DCMAKE_TOOLCHAIN_FILE=cmake/wasm_toolchain.cmake -DARM3R_ZIG=...
#
# ARM3R_ZIG is the executable of the Python package ziglang. Two numbers go into a register (simd128). zig's own C++ library
# has no exceptions: cmake/wasm.cmake compiles its sources again, with them, and with threads that cannot be begun.

set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(ARM3R_WASM ON)
set(ARM3R_PCH OFF) # files are compiled with different options

set(CMAKE_C_COMPILER ${ARM3R_ZIG} cc)
set(CMAKE_CXX_COMPILER ${ARM3R_ZIG} c++)
foreach(_language C CXX) # said, not tried out: no program can be linked before the C++ library is compiled
  set(CMAKE_${_language}_COMPILER_ID_RUN ON)
  set(CMAKE_${_language}_COMPILER_ID Clang)
  set(CMAKE_${_language}_COMPILER_FRONTEND_VARIANT GNU)
  set(CMAKE_${_language}_COMPILER_VERSION 22)
  set(CMAKE_${_language}_COMPILER_WORKS ON)
  set(CMAKE_${_language}_ABI_COMPILED ON)
endforeach()
set(CMAKE_C_STANDARD_COMPUTED_DEFAULT 17)
set(CMAKE_CXX_STANDARD_COMPUTED_DEFAULT 17)
set(CMAKE_SIZEOF_VOID_P 4)
set(CMAKE_C_FLAGS_INIT "-g0 -target wasm32-wasi -mcpu=generic+exception_handling+simd128 -fwasm-exceptions")
set(CMAKE_CXX_FLAGS_INIT "${CMAKE_C_FLAGS_INIT}")
foreach(_has THREADS THREAD_API_PTHREAD FILESYSTEM)
  string(APPEND CMAKE_CXX_FLAGS_INIT " -U_LIBCPP_HAS_${_has} -D_LIBCPP_HAS_${_has}=1")
endforeach()
foreach(_language C CXX)
  set(CMAKE_${_language}_ARCHIVE_CREATE "${ARM3R_ZIG} ar qc <TARGET> <OBJECTS>")
  set(CMAKE_${_language}_ARCHIVE_APPEND "${ARM3R_ZIG} ar q <TARGET> <OBJECTS>")
  set(CMAKE_${_language}_ARCHIVE_FINISH "${ARM3R_ZIG} ranlib <TARGET>")
endforeach()

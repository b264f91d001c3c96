# Cross compilation by zig's clang: cmake -DCMAKE_TOOLCHAIN_FILE=cmake/zig.cmake -DARM3R_ZIG=... -DARM3R_ZIG_TARGET=...
#
# ARM3R_ZIG is the executable of the Python package ziglang, ARM3R_ZIG_TARGET one of zig's targets, for example
# x86_64-linux-gnu.2.28: the last part is the oldest glibc, or macOS, that the result runs on.

list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES ARM3R_ZIG ARM3R_ZIG_TARGET)
string(REGEX MATCH "^([a-z0-9_]+)-([a-z]+)" _match "${ARM3R_ZIG_TARGET}")
set(CMAKE_SYSTEM_PROCESSOR ${CMAKE_MATCH_1})
if(CMAKE_MATCH_2 STREQUAL "windows")
  set(CMAKE_SYSTEM_NAME Windows)
  set(CMAKE_RC_COMPILER ${ARM3R_ZIG}) # CMake asks for one; there is nothing to compile with it
elseif(CMAKE_MATCH_2 STREQUAL "macos")
  set(CMAKE_SYSTEM_NAME Darwin)
else()
  set(CMAKE_SYSTEM_NAME Linux)
endif()

set(CMAKE_C_COMPILER ${ARM3R_ZIG} cc -target ${ARM3R_ZIG_TARGET})
set(CMAKE_CXX_COMPILER ${ARM3R_ZIG} c++ -target ${ARM3R_ZIG_TARGET})
foreach(_language C CXX)
  set(CMAKE_${_language}_ARCHIVE_CREATE "${ARM3R_ZIG} ar qc <TARGET> <OBJECTS>")
  set(CMAKE_${_language}_ARCHIVE_APPEND "${ARM3R_ZIG} ar q <TARGET> <OBJECTS>")
  set(CMAKE_${_language}_ARCHIVE_FINISH "${ARM3R_ZIG} ranlib <TARGET>")
endforeach()

set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY) # what this machine has installed is for this machine

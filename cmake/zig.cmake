# Cross compilation by zig's clang: cmake -DCMAKE_TOOLCHAIN_FILE=cmake/zig.cmake -DARM3R_ZIG=... -DARM3R_ZIG_TARGET=...
#
# ARM3R_ZIG is the executable of the Python package ziglang, ARM3R_ZIG_TARGET one of zig's targets, for example
# x86_64-linux-gnu.2.28: the last part is the oldest glibc, or macOS, that the result runs on.

list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES ARM3R_ZIG ARM3R_ZIG_TARGET)
string(REGEX MATCH "^([a-z0-9_]+)-([a-z]+)" _match "${ARM3R_ZIG_TARGET}")
set(_processor ${CMAKE_MATCH_1})
set(_system Linux)
if(CMAKE_MATCH_2 STREQUAL "windows")
  set(_system Windows)
  set(CMAKE_RC_COMPILER ${ARM3R_ZIG}) # CMake asks for one; there is nothing to compile with it
elseif(CMAKE_MATCH_2 STREQUAL "macos")
  set(_system Darwin)
  set(CMAKE_BUILD_WITH_INSTALL_RPATH ON) # Linux has no tool that changes it when the files are installed
endif()
if(NOT _system STREQUAL CMAKE_HOST_SYSTEM_NAME OR NOT _processor STREQUAL CMAKE_HOST_SYSTEM_PROCESSOR)
  set(CMAKE_SYSTEM_NAME ${_system}) # a system named here is another one: CMake then takes no Python of this machine
  set(CMAKE_SYSTEM_PROCESSOR ${_processor})
endif()

set(CMAKE_C_COMPILER ${ARM3R_ZIG} cc -target ${ARM3R_ZIG_TARGET})
set(CMAKE_CXX_COMPILER ${ARM3R_ZIG} c++ -target ${ARM3R_ZIG_TARGET})
foreach(_language C CXX)
  set(CMAKE_${_language}_FLAGS_INIT -g0) # zig's own default holds the names of folders
  set(CMAKE_${_language}_ARCHIVE_CREATE "${ARM3R_ZIG} ar qc <TARGET> <OBJECTS>")
  set(CMAKE_${_language}_ARCHIVE_APPEND "${ARM3R_ZIG} ar q <TARGET> <OBJECTS>")
  set(CMAKE_${_language}_ARCHIVE_FINISH "${ARM3R_ZIG} ranlib <TARGET>")
endforeach()

foreach(_kind EXE SHARED MODULE)
  set(CMAKE_${_kind}_LINKER_FLAGS_INIT -s)
endforeach()

set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY) # what this machine has installed is for this machine

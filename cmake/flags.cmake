# How every file is compiled. Results are the same to the last bit at any optimisation level and on any CPU, so nothing
# may contract, reorder or assume; what is switched off below does not change a result.

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug, RelWithDebInfo" FORCE)
endif()

string(TOUPPER "${CMAKE_BUILD_TYPE}" _type)
foreach(_flags CMAKE_CXX_FLAGS CMAKE_CXX_FLAGS_${_type})
  if("${${_flags}}" MATCHES "-ffast-math|-Ofast|-funsafe-math|-fassociative-math|-ffp-contract=(fast|on)|-freciprocal-math")
    message(FATAL_ERROR "${_flags} holds ${CMAKE_MATCH_0}: it would change results. Remove it; -O3 is the default.")
  endif()
endforeach()

set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_BUILD_RPATH_USE_ORIGIN ON) # no path of the build folder in a library: the same bytes wherever it is built
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)

set(_numeric -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Pairing scalars up lengthens the chain of a step by a tenth, and numbers that were written one by one have to be waited
  # for when they are read in pairs. What is to be computed side by side is written as packs.
  # Only a loop that is marked for it becomes one of vectors.
  list(APPEND _numeric -fno-tree-vectorize -fopenmp-simd)
  set(_marked_loops ARM3R_MARKED_LOOPS)
  # g++ looks for memory to free from 250 MB on, and then at each growth by 60 %: a tenth of its time goes into looking,
  # and no file of the library takes more than 500 MB.
  set(_memory --param=ggc-min-heapsize=250000 --param=ggc-min-expand=60)
  if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13 AND NOT "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${_type}}" MATCHES "-O3")
    list(APPEND _numeric -fno-thread-jumps) # else g++ 12 breaks off at -O2 with an internal error: a mask of 8 on two ways
  endif()
  # A state of eight lanes is copied and cleared by the registers for it; else g++ takes instructions that begin slowly
  # (rep movs).
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
    set(_strategy vector_loop:4096:noalign,libcall:-1:noalign)
    set(_copies -mmemcpy-strategy=${_strategy} -mmemset-strategy=${_strategy})
  endif()
  set(_quicker -fno-gcse-after-reload) # a pass that takes g++ three per cent of its time, and gains nothing here
endif()
add_library(arm3r_flags INTERFACE)
target_compile_features(arm3r_flags INTERFACE cxx_std_20)
# Of g++ 12: over std::string, and over walls and forces that are only read where there is a wall.
set(_false_alarms -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds -Wno-maybe-uninitialized)
target_compile_options(arm3r_flags INTERFACE ${_numeric} ${_copies} ${_memory} ${_quicker} -Wall -Wextra
                       "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:${_false_alarms}>")
target_compile_definitions(arm3r_flags INTERFACE EIGEN_DONT_VECTORIZE EIGEN_MPL2_ONLY ARM3R_VERSION="${PROJECT_VERSION}"
                           ${_marked_loops})

# Results have the same bits for any lanes, and fewer widths compile faster. A build for one width runs on any processor:
# on one that lacks the registers, runs go one by one.
set(ARM3R_LANES all CACHE STRING "The runs that a batch steps side by side: all (2, 4 and 8 are compiled, and the processor
  decides), native (as many as this processor has registers for), or 8, 4, 2 or 1")
set_property(CACHE ARM3R_LANES PROPERTY STRINGS all native 8 4 2 1)
set(_lanes ${ARM3R_LANES})
if(ARM3R_LANES STREQUAL "native")
  unset(_native CACHE) # the folder may have come from another machine
  try_run(_native _compiled ${CMAKE_CURRENT_BINARY_DIR}/lanes ${CMAKE_CURRENT_SOURCE_DIR}/cmake/max_lanes.cpp
          CMAKE_FLAGS -DINCLUDE_DIRECTORIES=${CMAKE_CURRENT_SOURCE_DIR}/cpp/include
          COMPILE_DEFINITIONS -O1 -std=c++20 COMPILE_OUTPUT_VARIABLE _messages)
  if(NOT _compiled OR NOT _native MATCHES "^[248]$")
    message(FATAL_ERROR "ARM3R_LANES=native: this processor's registers are not known; take ARM3R_LANES=all. ${_messages}")
  endif()
  set(_lanes ${_native})
endif()
if(NOT _lanes MATCHES "^(all|8|4|2|1)$")
  message(FATAL_ERROR "ARM3R_LANES is ${ARM3R_LANES}; it can be all, native, 8, 4, 2 or 1")
elseif(NOT _lanes STREQUAL "all")
  target_compile_definitions(arm3r_flags INTERFACE ARM3R_LANES=${_lanes})
endif()

list(JOIN _numeric " " _numeric)
string(JOIN " " ARM3R_BUILD_INFO ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_SYSTEM_PROCESSOR}
       ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${_type}} ${_numeric} ARM3R_LANES=${_lanes})
message(STATUS "${ARM3R_BUILD_INFO}")

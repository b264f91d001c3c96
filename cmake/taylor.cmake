# The Taylor kernels: printed by a program of ours, compiled into the core.

set(ARM3R_TAYLOR_KERNELS "" CACHE FILEPATH "taylor_kernels.hpp of another build: where derive_taylor cannot run, being compiled for another system")
if(ARM3R_TAYLOR_KERNELS)
  get_filename_component(_folder ${ARM3R_TAYLOR_KERNELS} DIRECTORY)
  target_include_directories(arm3r_integrate PRIVATE ${_folder})
  return()
endif()

add_executable(derive_taylor cpp/src/integrate/derive_taylor.cpp)
target_include_directories(derive_taylor PRIVATE cpp/include cpp/src)
target_link_libraries(derive_taylor PRIVATE arm3r_flags Eigen3::Eigen)
target_compile_options(derive_taylor PRIVATE $<$<CONFIG:Release>:-O0>) # it runs for an instant

set(_kernels ${CMAKE_CURRENT_BINARY_DIR}/taylor/taylor_kernels.hpp)
file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/taylor)
add_custom_command(OUTPUT ${_kernels} COMMAND derive_taylor ${_kernels} DEPENDS derive_taylor VERBATIM)
target_sources(arm3r_integrate PRIVATE ${_kernels})
target_include_directories(arm3r_integrate PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/taylor)

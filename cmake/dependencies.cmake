# Eigen and yaml-cpp, from the system or from Python wheels.

foreach(_prefix IN LISTS CMAKE_PREFIX_PATH)
  if(IS_DIRECTORY "${_prefix}/cmeel.prefix") # wheels keep their headers, libraries and packages in here
    list(PREPEND CMAKE_PREFIX_PATH "${_prefix}/cmeel.prefix") # the build's own environment stands last: it wins
  endif()
endforeach()

# Asked for without a version: Debian's 3.4 refuses a range, and Eigen 5 refuses 3.4.
find_package(Eigen3 REQUIRED NO_MODULE)
if(Eigen3_VERSION VERSION_LESS 3.4)
  message(FATAL_ERROR "Eigen 3.4 or later is needed, found ${Eigen3_VERSION} in ${Eigen3_DIR}")
endif()

set(ARM3R_YAML_SOURCE "" CACHE PATH "Sources of yaml-cpp, compiled into the library (tools/yaml_cpp_source.py fetches them)")
if(ARM3R_YAML_SOURCE)
  file(GLOB _sources CONFIGURE_DEPENDS ${ARM3R_YAML_SOURCE}/src/*.cpp)
  if(NOT _sources)
    message(FATAL_ERROR "ARM3R_YAML_SOURCE=${ARM3R_YAML_SOURCE} holds no src/*.cpp: give the folder of yaml-cpp's sources")
  endif()
  add_library(arm3r_yaml STATIC ${_sources})
  set_target_properties(arm3r_yaml PROPERTIES CXX_STANDARD 17)
  target_include_directories(arm3r_yaml SYSTEM PUBLIC ${ARM3R_YAML_SOURCE}/include PRIVATE ${ARM3R_YAML_SOURCE}/src)
  target_compile_definitions(arm3r_yaml PUBLIC YAML_CPP_STATIC_DEFINE)
  return()
endif()

find_package(yaml-cpp 0.7 REQUIRED)
if(TARGET yaml-cpp::yaml-cpp)
  set(_yaml yaml-cpp::yaml-cpp)
else()
  set(_yaml yaml-cpp) # 0.7 knows no namespace
endif()

if(yaml-cpp_DIR MATCHES "/cmeel.prefix/")
  # A wheel's library travels with ours, under a name of its own: the loader goes by that name, and would otherwise
  # take whatever yaml-cpp the process holds already.
  find_program(PATCHELF patchelf REQUIRED)
  get_target_property(_headers ${_yaml} INTERFACE_INCLUDE_DIRECTORIES)
  get_target_property(_library ${_yaml} LOCATION)
  set(ARM3R_YAML_LIBRARY ${CMAKE_CURRENT_BINARY_DIR}/libarm3r-yaml-cpp.so)
  file(COPY_FILE ${_library} ${ARM3R_YAML_LIBRARY})
  execute_process(COMMAND ${PATCHELF} --set-soname libarm3r-yaml-cpp.so --remove-rpath ${ARM3R_YAML_LIBRARY}
                  COMMAND_ERROR_IS_FATAL ANY)
  add_library(arm3r_yaml SHARED IMPORTED)
  set_target_properties(arm3r_yaml PROPERTIES IMPORTED_LOCATION ${ARM3R_YAML_LIBRARY}
                        IMPORTED_SONAME libarm3r-yaml-cpp.so INTERFACE_INCLUDE_DIRECTORIES "${_headers}")
else()
  add_library(arm3r_yaml INTERFACE)
  target_link_libraries(arm3r_yaml INTERFACE ${_yaml})
endif()

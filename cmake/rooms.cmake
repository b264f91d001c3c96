# A room is a folder of cpp/src and a target of its own, arm3r_ROOM. It sees its own headers, those of the rooms after SEES
# and those that these see: an include of any other room does not compile.
#   ALONE: files compiled one by one and for speed: long templates, which g++ takes 5 to 25 s for, and what reads and
#          writes much; the others are compiled eight at a time
#   QUICKLY: those others are done once a run: compiled in half of the time, with the same bits

option(ARM3R_PCH "Read Eigen and the standard headers once" ON)
option(ARM3R_UNITY "Compile small files eight at a time, which saves half of their time" ON)
set(_quickly $<$<CONFIG:Release>:-O1>)

function(arm3r_room room)
  cmake_parse_arguments(PARSE_ARGV 1 _is QUICKLY "" "SEES;SOURCES;ALONE")
  set(target arm3r_${room})
  set(folder ${PROJECT_SOURCE_DIR}/cpp/src/${room})
  if(NOT _is_SOURCES)
    file(GLOB _is_SOURCES CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/*.cpp)
    list(FILTER _is_SOURCES EXCLUDE REGEX derive_) # a program that prints a source: cmake/taylor.cmake
  endif()
  list(TRANSFORM _is_SOURCES PREPEND ${folder}/)
  if(NOT TARGET ${target}) # an executable is made before it is filled
    add_library(${target} OBJECT)
    if(ARM3R_PCH AND _is_SEES AND NOT room STREQUAL base)
      target_precompile_headers(${target} REUSE_FROM arm3r_base)
    endif()
  endif()
  target_sources(${target} PRIVATE ${_is_SOURCES})

  set(root ${CMAKE_CURRENT_BINARY_DIR}/rooms/${room}) # a folder that holds this room alone
  file(MAKE_DIRECTORY ${root})
  file(CREATE_LINK ${folder} ${root}/${room} RESULT failure SYMBOLIC)
  if(failure) # as on Windows for users who may not make links: there the compiler finds every room
    set(root ${PROJECT_SOURCE_DIR}/cpp/src)
  endif()
  target_include_directories(${target} PUBLIC ${root})
  list(TRANSFORM _is_SEES PREPEND arm3r_)
  target_link_libraries(${target} PUBLIC arm3r_flags ${_is_SEES})

  list(TRANSFORM _is_ALONE PREPEND ${folder}/)
  set_source_files_properties(${_is_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${ARM3R_UNITY} UNITY_BUILD_BATCH_SIZE 8)
  if(NOT _is_QUICKLY)
    set_property(GLOBAL APPEND PROPERTY ARM3R_TEMPLATES ${_is_ALONE})
  elseif(NOT ARM3R_WASM) # cmake/wasm.cmake makes all but the templates small
    target_compile_options(${target} PRIVATE ${_quickly})
    set_source_files_properties(${_is_ALONE} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
  endif()
endfunction()

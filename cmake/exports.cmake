# What the library shows: the names arm3r_* of the C interface alone. And how a program finds it beside itself.

set(_exports ${CMAKE_CURRENT_SOURCE_DIR}/cpp/src/api)
if(WIN32) # the header's ARM3R_API marks what is exported
  target_compile_definitions(arm3r_api PRIVATE "ARM3R_API=__declspec(dllexport)")
elseif(APPLE)
  set(ARM3R_ORIGIN @loader_path)
  target_link_options(arm3r PRIVATE LINKER:-exported_symbols_list,${_exports}/arm3r.exports)
  set_target_properties(arm3r PROPERTIES LINK_DEPENDS ${_exports}/arm3r.exports)
else()
  set(ARM3R_ORIGIN $ORIGIN)
  target_link_options(arm3r PRIVATE LINKER:--version-script=${_exports}/arm3r.map LINKER:--no-undefined)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU") # the names of libstdc++ where it is linked statically; libc++'s are hidden
    target_link_options(arm3r PRIVATE LINKER:--exclude-libs,ALL)
  endif()
  set_target_properties(arm3r PROPERTIES LINK_DEPENDS ${_exports}/arm3r.map)
  if(ARM3R_ZIG)
    # The unwinder of the process, in the place of zig's own: exceptions of a function that is called back pass through
    # both its code and ours. This library has only the names, and that of the system's library, which is found at run time.
    add_library(arm3r_unwinder SHARED cmake/unwinder.c)
    set_target_properties(arm3r_unwinder PROPERTIES NO_SONAME ON C_VISIBILITY_PRESET default)
    target_link_options(arm3r_unwinder PRIVATE LINKER:-soname,libgcc_s.so.1)
    target_link_libraries(arm3r PRIVATE $<TARGET_FILE:arm3r_unwinder>)
    add_dependencies(arm3r arm3r_unwinder)
    target_link_options(arm3r PRIVATE LINKER:-z,nodelete) # zig's start files do not undo at dlclose what is done at exit
  endif()
endif()
set_target_properties(arm3r PROPERTIES INSTALL_RPATH "${ARM3R_ORIGIN}" INSTALL_NAME_DIR @rpath)

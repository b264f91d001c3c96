# What Python calls the library by, made by cffi from the public header itself: a compiled extension, or a module that
# loads the library, where the extension cannot be compiled from here (a system whose Python headers are missing).

set(ARM3R_CFFI extension CACHE STRING "extension, or module")
set_property(CACHE ARM3R_CFFI PROPERTY STRINGS extension module)
if(ARM3R_CFFI STREQUAL "extension")
  find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module ${SKBUILD_SABI_COMPONENT})
else() # the Python of this machine writes the module; that of the other system is not needed
  find_program(Python_EXECUTABLE NAMES python3 python REQUIRED)
endif()

set(_header ${CMAKE_CURRENT_SOURCE_DIR}/cpp/include/arm3r/arm3r.h)
set(_generator ${CMAKE_CURRENT_SOURCE_DIR}/tools/gen_cffi.py)
separate_arguments(_words UNIX_COMMAND "${CMAKE_C_COMPILER_ARG1}") # of a compiler that is called by several words
add_custom_command(
  OUTPUT arm3r_cdef.h
  COMMAND ${CMAKE_C_COMPILER} ${_words} -E -P -xc -DARM3R_CDEF -DARM3R_API= ${_header} -o arm3r_cdef.h
  DEPENDS ${_header})

if(ARM3R_CFFI STREQUAL "extension")
  add_custom_command(
    OUTPUT _arm3r.c
    COMMAND ${Python_EXECUTABLE} ${_generator} arm3r_cdef.h _arm3r.c
    DEPENDS arm3r_cdef.h ${_generator})
  if(SKBUILD_SABI_VERSION)
    set(_stable USE_SABI ${SKBUILD_SABI_VERSION})
  endif()
  python_add_library(_arm3r MODULE WITH_SOABI ${_stable} ${CMAKE_CURRENT_BINARY_DIR}/_arm3r.c)
  target_link_libraries(_arm3r PRIVATE arm3r)
  if(ARM3R_ZIG) # Debian's Python reads a header of the folder above, which g++ knows by itself
    foreach(_folder ${Python_INCLUDE_DIRS})
      cmake_path(GET _folder PARENT_PATH _above)
      target_compile_options(_arm3r PRIVATE "SHELL:-idirafter ${_above}")
    endforeach()
  endif()
  set_target_properties(_arm3r PROPERTIES INSTALL_RPATH "${ARM3R_ORIGIN}/${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS _arm3r LIBRARY DESTINATION .)
else()
  if(WIN32)
    set(_folder ${CMAKE_INSTALL_BINDIR})
  else()
    set(_folder ${CMAKE_INSTALL_LIBDIR})
  endif()
  add_custom_command(
    OUTPUT _arm3r.py
    COMMAND ${Python_EXECUTABLE} ${_generator} arm3r_cdef.h _arm3r.py ${_folder}/$<TARGET_FILE_NAME:arm3r>
    DEPENDS arm3r_cdef.h ${_generator})
  add_custom_target(arm3r_cffi_module ALL DEPENDS _arm3r.py)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/_arm3r.py DESTINATION .)
endif()

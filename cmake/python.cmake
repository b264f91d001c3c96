# The cffi extension, made from the public header itself.

find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module ${SKBUILD_SABI_COMPONENT})

set(_header ${CMAKE_CURRENT_SOURCE_DIR}/cpp/include/arm3r/arm3r.h)
set(_generator ${CMAKE_CURRENT_SOURCE_DIR}/cmake/gen_cffi.py)
add_custom_command(
  OUTPUT arm3r_cdef.h
  COMMAND ${CMAKE_C_COMPILER} -E -P -xc -DARM3R_CDEF -DARM3R_API= ${_header} -o arm3r_cdef.h
  DEPENDS ${_header})
add_custom_command(
  OUTPUT _arm3r.c
  COMMAND ${Python_EXECUTABLE} ${_generator} arm3r_cdef.h _arm3r.c
  DEPENDS arm3r_cdef.h ${_generator})

if(SKBUILD_SABI_VERSION)
  set(_stable USE_SABI ${SKBUILD_SABI_VERSION})
endif()
python_add_library(_arm3r MODULE WITH_SOABI ${_stable} ${CMAKE_CURRENT_BINARY_DIR}/_arm3r.c)
target_link_libraries(_arm3r PRIVATE arm3r)
set_target_properties(_arm3r PROPERTIES INSTALL_RPATH $ORIGIN/${CMAKE_INSTALL_LIBDIR})
install(TARGETS _arm3r LIBRARY DESTINATION .)

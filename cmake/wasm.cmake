# arm3r.wasm: the library for browsers and node. web/core/core.js calls it.

get_filename_component(_zig ${ARM3R_ZIG} DIRECTORY)
set(_zig ${_zig}/lib)

# ---- the C++ library, with exceptions: of LLVM's sources what the module uses
set(_cxx algorithm atomic call_once charconv chrono condition_variable condition_variable_destructor error_category exception functional future
    hash ios ios.instantiations iostream locale memory mutex mutex_destructor new_handler new_helpers optional ostream
    ryu/d2fixed ryu/d2s ryu/f2s stdexcept string strstream system_error thread typeinfo vector verbose_abort)
set(_abi abort_message cxa_aux_runtime cxa_default_handlers cxa_exception cxa_exception_storage cxa_guard cxa_handlers
    cxa_personality cxa_vector cxa_virtual fallback_malloc private_typeinfo stdlib_exception stdlib_new_delete
    stdlib_stdexcept stdlib_typeinfo)
list(TRANSFORM _cxx REPLACE "(.+)" "${_zig}/libcxx/src/\\1.cpp")
list(TRANSFORM _abi REPLACE "(.+)" "${_zig}/libcxxabi/src/\\1.cpp")
add_library(cxx_with_exceptions STATIC ${_cxx} ${_abi} ${_zig}/libunwind/src/Unwind-wasm.c)
set_target_properties(cxx_with_exceptions PROPERTIES CXX_STANDARD 23)
target_include_directories(cxx_with_exceptions PRIVATE ${_zig}/libcxx/src ${_zig}/libcxx/libc
                           ${_zig}/libcxxabi/src ${_zig}/libcxxabi/include ${_zig}/libunwind/include)
target_compile_definitions(cxx_with_exceptions PRIVATE _LIBCPP_BUILDING_LIBRARY _LIBCXXABI_BUILDING_LIBRARY
                           LIBCXX_BUILDING_LIBCXXABI _LIBCXXABI_HAS_NO_THREADS LIBCXXABI_NON_DEMANGLING_TERMINATE)
target_compile_options(cxx_with_exceptions PRIVATE -w)
set_source_files_properties(${_zig}/libunwind/src/Unwind-wasm.c PROPERTIES COMPILE_DEFINITIONS _LIBUNWIND_HIDE_SYMBOLS)

# ---- small where little time is spent: only the templates are compiled for speed, and what they inline is clang's choice
add_executable(arm3r_wasm)
arm3r_room(wasm SEES api)
foreach(_target arm3r_platform ${_core} ${_faces} arm3r_wasm arm3r_yaml cxx_with_exceptions)
  target_compile_options(${_target} PRIVATE -Os -ffunction-sections -fdata-sections)
endforeach()
get_property(_templates GLOBAL PROPERTY ARM3R_TEMPLATES)
set_source_files_properties(${_templates} PROPERTIES COMPILE_OPTIONS "-O2;-DARM3R_INLINE=inline;-DARM3R_INLINE_LAMBDA=")

# ---- the module: what core.js calls, and what that needs
set(_binding ${PROJECT_SOURCE_DIR}/web/core/core.js)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${_binding})
file(READ ${_binding} _calls)
string(REGEX MATCHALL "\"(arm3r_[a-z_]+|malloc|free)\"" _calls "${_calls}")
list(TRANSFORM _calls REPLACE "\"(.+)\"" "LINKER:--export=\\1")
list(REMOVE_DUPLICATES _calls)
target_link_libraries(arm3r_wasm PUBLIC ${_faces} arm3r_core cxx_with_exceptions)
target_link_options(arm3r_wasm PRIVATE -mexec-model=reactor -nostdlib++ -s ${_calls} LINKER:--gc-sections
                    LINKER:-z,stack-size=4194304 LINKER:--initial-memory=16777216 LINKER:--max-memory=4294901760)
set_target_properties(arm3r_wasm PROPERTIES OUTPUT_NAME arm3r SUFFIX .wasm)

include(CMakePackageConfigHelpers)

set(_package ${CMAKE_INSTALL_LIBDIR}/cmake/arm3r)
install(TARGETS arm3r EXPORT arm3r LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}) # on Windows the library lies beside the executable
install(TARGETS arm3r_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(SKBUILD)
  install(TARGETS arm3r_launcher RUNTIME DESTINATION ${SKBUILD_SCRIPTS_DIR})
endif()
# The scenarios, and the schemas that editors read: their relative places are those of the repository, as the scenarios name
# the schema by its relative path.
set(_data ${CMAKE_INSTALL_DATADIR}/arm3r)
install(DIRECTORY scenarios DESTINATION ${_data} FILES_MATCHING PATTERN "*.yaml")
install(FILES docs/scenario.schema.json docs/sweep.schema.json DESTINATION ${_data}/docs)
# The pages that `arm3r docs` prints; their pictures stay in the repository.
file(GLOB _pages CONFIGURE_DEPENDS docs/*.md)
install(FILES ${_pages} DESTINATION ${_data}/docs)
install(FILES README.md CHANGELOG.md DESTINATION ${_data})
# The live page, where `make page` has built it.
install(DIRECTORY build/page/ DESTINATION ${_data}/live OPTIONAL)
set(ARM3R_LICENSES "" CACHE FILEPATH "The licences of what is compiled in, as tools/core_licenses.py prints them")
install(FILES ${ARM3R_LICENSES} DESTINATION ${_data})
install(DIRECTORY cpp/include/arm3r DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} PATTERN README.md EXCLUDE)
install(FILES ${ARM3R_YAML_LIBRARY} DESTINATION ${CMAKE_INSTALL_LIBDIR})

install(EXPORT arm3r NAMESPACE arm3r:: FILE arm3rConfig.cmake DESTINATION ${_package})
write_basic_package_version_file(arm3rConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/arm3rConfigVersion.cmake DESTINATION ${_package})

# How the executable finds the parts beside it.
file(RELATIVE_PATH _package_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/cmake/arm3r)
file(RELATIVE_PATH _data_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/arm3r)
target_compile_definitions(arm3r_cli PRIVATE ARM3R_CMAKE_FROM_BIN="${_package_from_bin}" ARM3R_DATA_FROM_BIN="${_data_from_bin}")

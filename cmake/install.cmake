include(CMakePackageConfigHelpers)

set(_package ${CMAKE_INSTALL_LIBDIR}/cmake/arm3r)
install(TARGETS arm3r EXPORT arm3r LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS arm3r_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(SKBUILD)
  install(TARGETS arm3r_launcher RUNTIME DESTINATION ${SKBUILD_SCRIPTS_DIR})
endif()
install(DIRECTORY cpp/include/arm3r DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} PATTERN README.md EXCLUDE)
install(FILES ${ARM3R_YAML_LIBRARY} DESTINATION ${CMAKE_INSTALL_LIBDIR})

install(EXPORT arm3r NAMESPACE arm3r:: FILE arm3rConfig.cmake DESTINATION ${_package})
write_basic_package_version_file(arm3rConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/arm3rConfigVersion.cmake DESTINATION ${_package})

# `cmake --install BUILD --component client --prefix P`: library, headers, CMake package `liloc`, pkg-config file,
# liloc-client and, where it was built, the Python module. All paths inside are relative: P may be moved.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/liloc)
install(TARGETS liloc_client_shared EXPORT liloc-client
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT client NAMELINK_COMPONENT client)
install(FILES liloc/client.h liloc/client.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/liloc COMPONENT client)
install(EXPORT liloc-client FILE liloc-targets.cmake NAMESPACE liloc:: DESTINATION ${package_dir} COMPONENT client)

set(made ${CMAKE_CURRENT_BINARY_DIR})
configure_package_config_file(liloc-config.cmake.in ${made}/liloc-config.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${made}/liloc-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${made}/liloc-config.cmake ${made}/liloc-config-version.cmake DESTINATION ${package_dir}
  COMPONENT client)

# pkg-config counts from its own folder, lib/.../pkgconfig.
file(RELATIVE_PATH prefix_from_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" prefix_from_pc "${prefix_from_pc}")
configure_file(liloc-client.pc.in ${made}/liloc-client.pc @ONLY)
install(FILES ${made}/liloc-client.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT client)

# Installation: library, its headers, the command line, strahlConfig.cmake and strahl.pc. Headers of
# strahl::io stay behind, as that library belongs to the tools.
include(CMakePackageConfigHelpers)

install(TARGETS strahl EXPORT strahlTargets)
if(TARGET strahl_cli)
  install(TARGETS strahl_cli)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/strahl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING
        PATTERN "*.h"
        PATTERN "*.def"
        PATTERN "*_test.h" EXCLUDE
        PATTERN "strahl/io" EXCLUDE
        PATTERN "strahl/render" EXCLUDE
        PATTERN "strahl/measure" EXCLUDE)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/strahl)
install(EXPORT strahlTargets NAMESPACE strahl:: DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/strahlConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/strahlConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/strahlConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/strahlConfig.cmake
              ${PROJECT_BINARY_DIR}/strahlConfigVersion.cmake DESTINATION ${package_dir})

# A static library needs its dependencies on the user's link line, a shared one does not.
set(pc_requires "qhull_r libhwy")
if(STRAHL_USES_TBB)
  string(APPEND pc_requires " tbb")
endif()
get_target_property(library_type strahl TYPE)
if(library_type STREQUAL "STATIC_LIBRARY")
  set(pc_requires_key "Requires")
else()
  set(pc_requires_key "Requires.private")
endif()
# Relocatable: every path follows from where strahl.pc lies.
set(pc_folder /${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH pc_up ${pc_folder} /)
configure_file(${PROJECT_SOURCE_DIR}/cmake/strahl.pc.in ${PROJECT_BINARY_DIR}/strahl.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/strahl.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# strahl::io: readers, generators, writers, images and measurements. Part of the tools, not of the
# installed library.
find_package(PNG REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
# Debian's CMake files of these two also look for programs and bindings that are packaged apart.
find_package(PkgConfig REQUIRED)
pkg_check_modules(libzip REQUIRED IMPORTED_TARGET libzip)
pkg_check_modules(openexr REQUIRED IMPORTED_TARGET OpenEXR)

strahl_glob_sources(io_sources io render measure)
add_library(strahl_io STATIC ${io_sources} ${STRAHL_GENERATED_DIR}/strahl_version.h)
add_library(strahl::io ALIAS strahl_io)
strahl_configure_target(strahl_io)
set_target_properties(strahl_io PROPERTIES LINKER_LANGUAGE CXX)
target_link_libraries(strahl_io PUBLIC strahl::strahl PRIVATE PNG::PNG
                      PkgConfig::openexr PkgConfig::libzip nlohmann_json::nlohmann_json fmt::fmt)

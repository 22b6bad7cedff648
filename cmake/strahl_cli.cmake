# The command line. All of it but main.cpp is an object library, so that its tests can link it.
find_package(CLI11 REQUIRED)

strahl_glob(cli_sources apps/strahl/*.cpp)
list(FILTER cli_sources EXCLUDE REGEX "(_test|/main)\\.cpp$")
set(cli_main ${PROJECT_SOURCE_DIR}/apps/strahl/main.cpp)

if(cli_sources)
  add_library(strahl_cli_objects OBJECT ${cli_sources})
  strahl_configure_target(strahl_cli_objects)
  target_include_directories(strahl_cli_objects PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(strahl_cli_objects PUBLIC strahl::io CLI11::CLI11 fmt::fmt
                                                  nlohmann_json::nlohmann_json)
endif()
if(EXISTS ${cli_main})
  add_executable(strahl_cli ${cli_main})
  strahl_configure_target(strahl_cli)
  set_target_properties(strahl_cli PROPERTIES OUTPUT_NAME strahl
                                              RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  target_link_libraries(strahl_cli PRIVATE strahl::io CLI11::CLI11 fmt::fmt
                                           nlohmann_json::nlohmann_json)
  if(TARGET strahl_cli_objects)
    target_link_libraries(strahl_cli PRIVATE strahl_cli_objects)
  endif()
endif()

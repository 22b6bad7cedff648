# The command line. All of it but main.cpp is an object library, so that its tests can link it.
find_package(CLI11 REQUIRED)
# The peer of `strahl bench`, x86 only: its rays are written by SSE.
option(STRAHL_WITH_EMBREE "Let `strahl bench` race Embree 3.13 when it is found" ON)
if(STRAHL_WITH_EMBREE AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  find_package(embree 3.13 CONFIG QUIET)
endif()

strahl_glob(cli_sources apps/strahl/*.cpp apps/strahl/peer/*.cpp)
list(FILTER cli_sources EXCLUDE REGEX "(_test|/main)\\.cpp$")
if(embree_FOUND)
  list(FILTER cli_sources EXCLUDE REGEX "/no_peer\\.cpp$")
  set_source_files_properties(apps/strahl/peer/embree_peer.cpp PROPERTIES COMPILE_OPTIONS -msse4.1)
else()
  list(FILTER cli_sources EXCLUDE REGEX "/embree_peer\\.cpp$")
endif()
set(cli_main ${PROJECT_SOURCE_DIR}/apps/strahl/main.cpp)

if(cli_sources)
  add_library(strahl_cli_objects OBJECT ${cli_sources})
  strahl_configure_target(strahl_cli_objects)
  target_include_directories(strahl_cli_objects PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(strahl_cli_objects PUBLIC strahl::io CLI11::CLI11 fmt::fmt
                                                  nlohmann_json::nlohmann_json)
  if(embree_FOUND)
    target_link_libraries(strahl_cli_objects PUBLIC embree)
  endif()
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

# Writes <strahl_version.h> into the build tree: version and, where the sources are a git checkout
# of their own, the commit. Configures again when HEAD moves.
set(STRAHL_GENERATED_DIR ${PROJECT_BINARY_DIR}/generated)
set(STRAHL_GIT_COMMIT "unknown")
find_package(Git QUIET)

# strahl_git(<out> <argument...>): output of a git command in the source folder, empty on failure.
function(strahl_git out)
  execute_process(COMMAND ${GIT_EXECUTABLE} ${ARGN} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                  OUTPUT_VARIABLE text OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                  RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    set(text "")
  endif()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# A .git of our own: a copy inside another project's repository must not report that one's commit.
if(GIT_FOUND AND EXISTS ${PROJECT_SOURCE_DIR}/.git)
  strahl_git(commit rev-parse --short=12 HEAD)
  if(commit)
    set(STRAHL_GIT_COMMIT ${commit})
    strahl_git(head_log rev-parse --git-path logs/HEAD)
    cmake_path(ABSOLUTE_PATH head_log BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    if(EXISTS ${head_log})
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${head_log})
    endif()
  endif()
endif()

configure_file(${PROJECT_SOURCE_DIR}/cmake/strahl_version.h.in
               ${STRAHL_GENERATED_DIR}/strahl_version.h @ONLY)

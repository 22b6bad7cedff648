# Compiler flags: one function for every target of the project, sanitizers for the whole build.
# Never -ffast-math nor -march=native: both change answers.

# A user of the library gets none of this; sanitizers concern whoever asked for them, so they apply
# to all targets of the directory, test frameworks included.
if(STRAHL_SANITIZE)
  add_compile_options(-fsanitize=${STRAHL_SANITIZE} -fno-sanitize-recover=all
                      -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${STRAHL_SANITIZE})
  # Sanitized code makes g++ warn of uninitialised values inside std::regex and std::function.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
if(STRAHL_BUILD_FUZZERS)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "STRAHL_BUILD_FUZZERS needs clang (libFuzzer); use the preset 'fuzz'")
  endif()
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# strahl_configure_target(<target>): language level and warnings of everything in this project.
function(strahl_configure_target target)
  set_target_properties(${target} PROPERTIES CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON
                                             CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE -ffp-contract=off -fno-math-errno)
  if(PROJECT_IS_TOP_LEVEL)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -Wpedantic)
    # g++ 12 reports overlapping copies inside std::string where there are none (GCC PR 105651).
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  endif()
  if(STRAHL_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

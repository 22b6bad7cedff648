// tests/support/shared.h - where tests find the scenes and reference tables kept beside the
// repository, and how they step aside when those are absent.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string_view>

#include <gtest/gtest.h>

namespace strahl::test {

/// Folder of the shared data: $STRAHL_SHARED, else the default compiled in (../shared beside the
/// repository). Need not exist.
inline std::filesystem::path shared_dir() {
  const char* from_environment = std::getenv("STRAHL_SHARED");
  return from_environment != nullptr ? from_environment : STRAHL_SHARED_DEFAULT;
}

/// How thorough long tests are: STRAHL_CONFORMANCE=full, as `test.sh --full` sets for release
/// builds, or =smoke, as the presets with sanitizers set, which look at memory and threads and are
/// up to twenty times slower. Without it, what every change must pass.
inline bool has_thoroughness(std::string_view mode) {
  const char* wanted = std::getenv("STRAHL_CONFORMANCE");
  return wanted != nullptr && wanted == mode;
}
inline bool is_full_run() { return has_thoroughness("full"); }
inline bool is_smoke_run() { return has_thoroughness("smoke"); }

}  // namespace strahl::test

/// Skips the running test, with a message, where `relative` (below the shared data) is absent.
#define STRAHL_REQUIRE_SHARED(relative)                                        \
  do {                                                                         \
    const auto required_ = ::strahl::test::shared_dir() / (relative);          \
    if (!std::filesystem::exists(required_)) {                                 \
      GTEST_SKIP() << "shared data absent (set STRAHL_SHARED): " << required_; \
    }                                                                          \
  } while (false)

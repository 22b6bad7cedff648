// tests/support/memory_file.h - files that exist only in memory, and what a reader says of them.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/io/file_bytes.h>

namespace strahl::test {

/// A file with this content, which it owns, so that readers may use it in place.
inline FileBytes memory_file(std::string content, std::string name = "file") {
  const auto owner = std::make_shared<const std::string>(std::move(content));
  return {std::as_bytes(std::span(*owner)), std::move(name), {}, owner};
}

/// What the error thrown by action says; "no error" if it throws none.
template <class Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace strahl::test

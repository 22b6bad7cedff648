// base/error.h - the one exception type of the library: everything a user can cause.
//
// Thread safety: values; safe to throw from tasks (the executor rethrows on the calling thread).
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace strahl {

/// What kind of mistake or event an Error reports. The command line maps them to exit codes:
/// usage 2, bad_input 3, resource and cancelled 4, unsupported 2.
enum class ErrorCode { usage, bad_input, resource, cancelled, unsupported };

/// An error a user can cause, thrown at the boundary before work starts.
/// what() reads "<which>: <where>: <reason>", empty parts left out.
class Error : public std::runtime_error {
 public:
  /// @param reason what is wrong, in words
  /// @param which  the file, option or argument concerned; may be empty
  /// @param where  the place in it ("line 12", "byte 84"); may be empty
  Error(ErrorCode code, const std::string& reason, std::string which = {}, std::string where = {})
      : std::runtime_error(join(which, where, reason)),
        code_(code),
        reason_(reason),
        which_(std::move(which)),
        where_(std::move(where)) {}

  ErrorCode code() const noexcept { return code_; }
  const std::string& reason() const noexcept { return reason_; }
  const std::string& which() const noexcept { return which_; }
  const std::string& where() const noexcept { return where_; }

 private:
  static std::string join(const std::string& which, const std::string& where,
                          const std::string& reason) {
    std::string text = which;
    for (const std::string* part : {&where, &reason}) {
      if (part->empty()) continue;
      if (!text.empty()) text += ": ";
      text += *part;
    }
    return text;
  }

  ErrorCode code_;
  std::string reason_, which_, where_;
};

}  // namespace strahl

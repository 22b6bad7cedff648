// apps/strahl/run_test.h - runs the command line as a user would.
#pragma once

#include <cstdlib>
#include <string>
#include <sys/wait.h>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <strahl/io/npy.h>
#include <strahl/io/temp_folder_test.h>
#include <strahl/math/vec3.h>

namespace strahl::test {

struct Finished {
  int code;
  std::string out, err;
  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// A test with a folder of its own, in which the program runs.
class CommandTest : public testing::Test {
 protected:
  /// Runs "strahl ARGUMENTS" through the shell.
  Finished run(const std::string& arguments) const {
    const std::string in_folder = "cd '" + (folder_ / "").string() + "' && ";
    const int status =
        std::system((in_folder + STRAHL_CLI_PATH + " " + arguments + " > .out 2> .err").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, folder_.read(".out"),
            folder_.read(".err")};
  }

  /// Expects the exit code and an error that contains `text`.
  void expect_error(const std::string& arguments, int code, const std::string& text) const {
    const Finished finished = run(arguments);
    EXPECT_EQ(finished.code, code) << arguments << "\n" << finished.err;
    EXPECT_EQ(finished.err.rfind("strahl: error: ", 0), 0u) << finished.err;
    EXPECT_NE(finished.err.find(text), std::string::npos) << finished.err;
    EXPECT_EQ(finished.out, "") << arguments;
  }

  /// Writes `count` rays from all around towards points near the origin, the same every time.
  void write_rays(const std::string& name, std::size_t count) const {
    std::vector<double> rows;
    for (std::size_t i = 0; i < count; ++i) {
      const auto x = static_cast<double>(i * 7919 % 1009) / 504.5 - 1.0;
      const auto y = static_cast<double>(i * 104729 % 997) / 498.5 - 1.0;
      const Vec3d from{4.0 * x, 4.0 * y, i % 2 == 0 ? 5.0 : -5.0};
      const Vec3d to{0.5 * y, 0.5 * x, 0.2 * x * y};
      for (const Vec3d& v : {from, to - from}) rows.insert(rows.end(), {v.x, v.y, v.z});
    }
    write_npy(folder_ / name, npy_array(rows, 6));
  }

  TempFolder folder_;
};

}  // namespace strahl::test

// apps/strahl/version.cpp - what this program was made of.
#include <strahl_version.h>
#include <string>
#include <thread>

#include <CLI/Version.hpp>
#include <fmt/core.h>
#if __has_include(<oneapi/tbb/version.h>)
#include <oneapi/tbb/version.h>
#endif

#include <apps/strahl/commands.h>

#include <strahl/base/executor.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>

namespace strahl::cli {
namespace {

/// The instruction set that wide_bvh uses here, and those it could.
std::string isa_text() {
  std::string others;
  for (const WideKernel* kernel : wide_kernels()) others += fmt::format(" {}", kernel->isa);
  return fmt::format("{} (STRAHL_ISA chooses one of:{})", wide_kernel_of_environment().isa, others);
}

std::string tbb_version() {
#if defined(TBB_VERSION_MAJOR)
  if (Executor::threads_available())
    return fmt::format("{}.{}.{}", TBB_VERSION_MAJOR, TBB_VERSION_MINOR, TBB_VERSION_PATCH);
#endif
  return "not used";
}

}  // namespace

std::string version_text(bool verbose) {
  std::string text = fmt::format("strahl {}\n", STRAHL_VERSION);
  if (!verbose) return text;
  text += fmt::format("commit         {}\n", STRAHL_GIT_COMMIT);
  text += fmt::format("compiler       {}\n", __VERSION__);
  text += fmt::format("isa            {}\n", isa_text());
  text += fmt::format("threads        {}{}\n", std::thread::hardware_concurrency(),
                      Executor::threads_available() ? "" : ", but built without oneTBB: 1");
  text += fmt::format("oneTBB         {}\n", tbb_version());
  text += fmt::format("CLI11          {}\n", CLI11_VERSION);
  text += fmt::format("fmt            {}.{}.{}\n", FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                      FMT_VERSION % 100);
  text += fmt::format("nlohmann-json  {}.{}.{}\n", NLOHMANN_JSON_VERSION_MAJOR,
                      NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH);
  return text;
}

}  // namespace strahl::cli

// tests/fuzz/motion_fuzz.cpp - no bytes make the reader of motions crash, hang or throw anything
// but Error, and what it reads can be posed.
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/io/motion_file.h>

namespace strahl {
namespace {

/// A chain of three nodes, the last placed by a matrix, with one instance each.
Rig small_rig() {
  Rig rig;
  rig.nodes = {{"a", RigNode::kNoParent, {}}, {"b", 0, {}}, {"b", 1, {}}};
  rig.nodes[2].rest.matrix = Affine::scaling({2, 2, 2});
  rig.order = {0, 1, 2};
  for (std::uint32_t n = 0; n < 3; ++n) rig.mounts.push_back(Mount{n, {}});
  return rig;
}

void read_and_pose(const FileBytes& file) {
  Motion motion = read_motion(file, small_rig());
  const Poser poser(small_rig(), std::move(motion), std::vector<Affine>(3));
  for (const double part : {0.0, 0.4, 1.0}) {
    const std::vector<Affine> pose = poser.at(part * poser.duration());
    for (const Affine& map : pose)
      if (!is_well_conditioned(map)) std::abort();
  }
}

}  // namespace
}  // namespace strahl

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const strahl::FileBytes file{std::as_bytes(std::span(data, size)), "fuzz", {}, nullptr};
  try {
    strahl::read_and_pose(file);
  } catch (const strahl::Error& error) {
    if (error.reason().empty() || error.which().empty() || error.where().empty()) std::abort();
  }
  return 0;
}

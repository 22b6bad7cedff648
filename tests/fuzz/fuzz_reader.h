// tests/fuzz/fuzz_reader.h - what the fuzzers of all readers do with one input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include <strahl/base/error.h>
#include <strahl/geometry/scene.h>
#include <strahl/io/file_bytes.h>

namespace strahl {

/// Reads the bytes as a file without siblings, then touches every vertex of what was read.
/// Errors are expected; an Error that does not say where and why is a finding.
inline int fuzz_reader(SceneData (*reader)(const FileBytes&), const std::uint8_t* data,
                       std::size_t size) {
  // The owner points nowhere: libFuzzer keeps the bytes alive for the call.
  const FileBytes file{std::as_bytes(std::span(data, size)),
                       "fuzz",
                       {},
                       std::shared_ptr<const void>(data, [](const void*) {})};
  try {
    const SceneData scene = reader(file);
    [[maybe_unused]] volatile double touched = 0;
    for (const Geometry& geometry : scene.geometries) {
      if (geometry.kind != PrimitiveKind::triangle) continue;
      if (!geometry.face_ids.empty() && geometry.face_ids.size() != geometry.size()) std::abort();
      for (std::size_t i = 0; i < geometry.size(); ++i) {
        const TriangleVertices t = geometry.mesh[i];
        touched = t.a.x + t.b.y + t.c.z;
      }
    }
  } catch (const Error& error) {
    if (error.reason().empty() || error.which().empty() || error.where().empty()) std::abort();
  }
  return 0;
}

}  // namespace strahl

// measure/thinned.h - a smaller scene that resembles a large one, for trials.
//
// Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <memory>

#include <strahl/geometry/scene.h>

namespace strahl {

/// A scene of about `count` references, at least one: every k-th primitive of each geometry, and of
/// very many instances every j-th. The scene itself when it has no more. O(count + geometries +
/// instances).
std::shared_ptr<const Scene> thinned(const std::shared_ptr<const Scene>& scene,
                                     std::uint32_t count);

}  // namespace strahl

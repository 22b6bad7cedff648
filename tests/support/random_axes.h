// tests/support/random_axes.h - rotations that oriented boxes are compared with.
#pragma once

#include <cmath>

#include <strahl/base/rng.h>
#include <strahl/bounds/obb_fit.h>
#include <strahl/math/affine.h>

namespace strahl::test {

/// A uniformly random rotation, from a random unit quaternion.
inline ObbAxes random_axes(Rng& rng) {
  double q[4], squared;
  do {
    squared = 0.0;
    for (double& v : q) v = rng.uniform(-1, 1), squared += v * v;
  } while (squared > 1.0 || squared < 1e-3);
  const double norm = std::sqrt(squared);
  const Affine turn = Affine::rotation(q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm);
  return {turn.vector({1, 0, 0}), turn.vector({0, 1, 0}), turn.vector({0, 0, 1})};
}

}  // namespace strahl::test

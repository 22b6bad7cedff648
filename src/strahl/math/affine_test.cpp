#include <cmath>

#include <gtest/gtest.h>

#include <strahl/math/affine.h>

namespace strahl {
namespace {

Affine sample() {
  return Affine::translation({1, -2, 3}) * Affine::rotation(0, 0, std::sqrt(0.5), std::sqrt(0.5)) *
         Affine::scaling({2, 3, -4});
}

TEST(Affine, CompositionAppliesTheRightFactorFirst) {
  const Affine a = Affine::translation({1, 0, 0}), b = Affine::scaling({2, 2, 2});
  EXPECT_EQ((a * b).point({1, 1, 1}), (Vec3d{3, 2, 2}));
  EXPECT_EQ((b * a).point({1, 1, 1}), (Vec3d{4, 2, 2}));
}

TEST(Affine, AQuarterTurnAboutZMapsXToY) {
  const Affine turn = Affine::rotation(0, 0, std::sqrt(0.5), std::sqrt(0.5));
  const Vec3d y = turn.vector({1, 0, 0});
  EXPECT_NEAR(y.x, 0, 1e-15);
  EXPECT_NEAR(y.y, 1, 1e-15);
}

TEST(Affine, TheInverseUndoesPointsAndKeepsTheIdentityExact) {
  const Affine a = sample();
  const Vec3d p{0.3, -7, 11}, back = inverse(a).point(a.point(p));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(back[i], p[i], 1e-13);
  EXPECT_TRUE(inverse(Affine{}).is_identity());
  EXPECT_DOUBLE_EQ(determinant(a), -24.0);
}

TEST(Affine, NormalsMapByTheTransposedInverse) {
  const Affine a = sample();
  const Vec3d along_1 = a.vector({1, -1, 0}), along_2 = a.vector({0, 0, 1});
  const Vec3d normal = inverse(a).transposed_vector({1, 1, 0});
  EXPECT_NEAR(dot(normal, along_1), 0, 1e-14);
  EXPECT_NEAR(dot(normal, along_2), 0, 1e-14);
}

TEST(Affine, NearlySingularMapsAreRecognised) {
  EXPECT_TRUE(is_well_conditioned(sample()));
  EXPECT_TRUE(is_well_conditioned(Affine::scaling({1e-30, 1e-30, 1e-30})));
  EXPECT_TRUE(is_well_conditioned(Affine::scaling({1, 1, 0x1p-29})));
  EXPECT_FALSE(is_well_conditioned(Affine::scaling({1, 1, 0x1p-31})));
  EXPECT_FALSE(is_well_conditioned(Affine::scaling({1, 1, 0})));
  EXPECT_FALSE(is_well_conditioned(Affine::translation({std::nan(""), 0, 0})));
}

}  // namespace
}  // namespace strahl

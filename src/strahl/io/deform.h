// io/deform.h - what deforms the meshes of a scene over time: shapes that are blended, and joints
// that carry vertices along.
//
// Source: morph targets and skins of glTF 2.0 (Khronos specification, sections 3.7.2.2, 3.7.3):
//   linear blending. Positions are summed in double, in the order given, and rounded once to float,
//   so vertices that coincide with equal weights still coincide, and a pose has the same bits
//   wherever it is computed.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <strahl/geometry/deform.h>
#include <strahl/io/motion.h>

namespace strahl {

struct Influence {
  std::uint32_t joint;  ///< index into Deformer::joints
  double weight;
};

/// Of vertex i: influences[starts[i]] .. influences[starts[i + 1]], at least one; where all weights
/// are zero the first joint alone carries it.
struct SkinWeights {
  std::vector<std::uint32_t> starts{0};
  std::vector<Influence> influences;
};

/// One geometry: blended by weights, then carried by joints from the mesh's space to the world.
struct Deformer {
  std::uint32_t geometry = 0;               ///< index into those of the scene
  std::uint32_t node = 0;                   ///< whose weights blend the targets
  std::vector<Vec3d> base;                  ///< one per vertex
  std::vector<std::vector<Vec3d>> targets;  ///< differences to the base; empty: no difference
  std::vector<double> weights;              ///< at rest, one per target or none
  std::vector<std::uint32_t> joints;        ///< nodes; none: no skin
  std::vector<Affine> inverse_binds;        ///< one per joint, or none
  SkinWeights skin;

  /// @param blend      one per target, or fewer: the others are 0
  /// @param node_world world transforms of all nodes
  std::vector<Vec3f> positions(std::span<const double> blend,
                               std::span<const Affine> node_world) const;
};

/// A scene with all that can move it.
struct RiggedScene {
  SceneData scene;
  Rig rig;
  std::vector<Deformer> deformers;
  std::vector<Motion> animations;  ///< of the file
};

/// Moves the vertices of a rig's meshes.
class Shaper {
 public:
  /// Only deformers that the poser's motion touches count. The poser must outlive it.
  Shaper(const Poser& poser, std::vector<Deformer> deformers);

  /// Geometries that are deformed at all.
  std::size_t moving() const { return deformers_.size(); }
  /// For strahl::deformed(). O(vertices * influences).
  std::vector<MovedVertices> at(double seconds) const;

 private:
  const Poser& poser_;
  std::vector<Deformer> deformers_;
};

}  // namespace strahl

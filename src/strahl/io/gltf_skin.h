// io/gltf_skin.h - deformation of glTF primitives at rest: morph targets, then skins.
//
// Positions are summed in double and rounded once to float32 by whoever stores them, so vertices
// that coincide with equal weights still coincide.
// Thread safety: one thread.
#pragma once

#include <optional>
#include <vector>

#include <strahl/io/gltf_accessor.h>
#include <strahl/io/gltf_nodes.h>

namespace strahl::gltf {

/// The `weights` of a mesh or node; empty where absent or all zero.
std::vector<double> read_morph_weights(const JsonValue& holder);

/// POSITION of the primitive plus weights[i] times that of its target i.
/// Throws Error{bad_input}: more weights than targets, a target of another vertex count.
std::vector<Vec3d> morphed_positions(Accessors& accessors, const JsonValue& primitive,
                                     const std::vector<double>& weights);

/// Per skin of the file, the maps of its joints from the mesh's space to the world.
class Skins {
 public:
  Skins(Accessors& accessors, const NodeTree& tree)
      : accessors_(accessors), tree_(tree), skins_(accessors.document().count("skins")) {}

  /// The skin that `reference` gives the index of: joint's node transform times its inverse bind
  /// matrix. Throws Error{bad_input}: unknown nodes, too few matrices.
  const std::vector<Affine>& joints(const JsonValue& reference);

 private:
  std::vector<Affine> read(const JsonValue& skin);

  Accessors& accessors_;
  const NodeTree& tree_;
  std::vector<std::optional<std::vector<Affine>>> skins_;
};

/// Moves positions to the world: each is the mean of its joints' images, weighted by all sets
/// JOINTS_n, WEIGHTS_n of the primitive. One without any weight follows its first joint.
/// Throws Error{bad_input}: no or mismatched sets, a weighted joint the skin does not have.
void apply_skin(Accessors& accessors, const JsonValue& primitive, const std::vector<Affine>& joints,
                std::vector<Vec3d>& positions);

}  // namespace strahl::gltf

// io/gltf_skin.h - what deforms glTF primitives: morph targets, then skins.
//
// Format: Khronos glTF 2.0, sections 3.7.2.2 (morph targets) and 3.7.3 (skins). The arithmetic is
//   that of io/deform.h.
// Thread safety: one thread.
#pragma once

#include <optional>
#include <vector>

#include <strahl/io/deform.h>
#include <strahl/io/gltf_accessor.h>
#include <strahl/io/gltf_nodes.h>

namespace strahl::gltf {

/// The `weights` of a mesh or node; empty where absent or all zero.
std::vector<double> read_morph_weights(const JsonValue& holder);

/// POSITION of the primitive and its targets, for these weights at rest.
/// @param has_all keeps the targets whose weight is zero, too: others may come
/// Throws Error{bad_input}: more weights than targets, a target of another vertex count.
Deformer read_shapes(Accessors& accessors, const JsonValue& primitive, std::vector<double> weights,
                     bool has_all);

/// What a skin of the file is made of.
struct Skin {
  std::vector<std::uint32_t> joints;  ///< nodes
  std::vector<Affine> inverse_binds;  ///< one per joint, or none
};

/// The skins of the file, each read once.
class Skins {
 public:
  explicit Skins(Accessors& accessors)
      : accessors_(accessors), skins_(accessors.document().count("skins")) {}

  /// The skin that `reference` gives the index of. Throws Error{bad_input}: unknown nodes, too few
  /// matrices.
  const Skin& get(const JsonValue& reference);

 private:
  Skin read(const JsonValue& skin);

  Accessors& accessors_;
  std::vector<std::optional<Skin>> skins_;
};

/// All sets JOINTS_n, WEIGHTS_n of the primitive. Weights of zero are left out; a vertex without
/// any weight follows its first joint.
/// Throws Error{bad_input}: no or mismatched sets, a weighted joint the skin does not have.
SkinWeights read_skin_weights(Accessors& accessors, const JsonValue& primitive,
                              std::size_t vertex_count, std::size_t joint_count);

}  // namespace strahl::gltf

// io/gltf_animation.h - the animations of a glTF file as motions of its nodes.
//
// Format: Khronos glTF 2.0, section 3.11: channels move the translation, rotation or scale of a
//   node, or the morph weights of its mesh, by a sampler of keys.
// Thread safety: none needed; one document at a time.
#pragma once

#include <set>
#include <vector>

#include <strahl/io/gltf_accessor.h>
#include <strahl/io/motion.h>

namespace strahl::gltf {

/// Nodes whose morph weights some animation moves. What is malformed is left to read_animations().
std::set<std::uint32_t> find_blended_nodes(const Document& document);

/// Reads all animations in file order. Channels without a node are ignored. Throws Error{bad_input}
/// citing the place: unknown paths and interpolations, indices out of range, times that are
/// negative or do not ascend, numbers of values that do not fit the times, values that are not
/// finite, rotations of no length, weights for a mesh that has no targets or another number of
/// them; Error{resource}: as Document::charge.
std::vector<Motion> read_animations(Accessors& accessors);

}  // namespace strahl::gltf

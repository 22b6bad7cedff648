// io/gltf_animation.h - the animations of a glTF file as motions of its nodes.
//
// Format: Khronos glTF 2.0, section 3.11: channels move the translation, rotation or scale of a
//   node by a sampler of keys.
// Thread safety: none needed; one document at a time.
#pragma once

#include <vector>

#include <strahl/io/gltf_accessor.h>
#include <strahl/io/motion.h>

namespace strahl::gltf {

/// Reads all animations in file order. Channels without a node are ignored; morph weights are not
/// followed, which leaves a warning. Throws Error{bad_input} citing the place: unknown paths and
/// interpolations, indices out of range, times that are negative or do not ascend, numbers of
/// values that do not fit the times, values that are not finite, rotations of no length;
/// Error{resource}: as Document::charge.
std::vector<Motion> read_animations(Accessors& accessors);

}  // namespace strahl::gltf

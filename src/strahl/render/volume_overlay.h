// render/volume_overlay.h - the bounding volumes of one level of a tree, drawn over a picture.
//
// Method: 2 x 2 rays per pixel find the volume that each enters first. As the rays go one unit
//   deep per unit of t, 1/t is linear in the picture where a face is flat, and its slope is the
//   face's normal. Lines are where the volume changes or the normal turns.
// Thread safety: pure functions.
#pragma once

#include <strahl/catalog/accelerator.h>
#include <strahl/io/image.h>

namespace strahl {

/// Volumes are translucent, each of a hue of its own; those that the eye is in are left out. Their
/// margins (docs/adr/0004) are far below a pixel. The same for any executor.
/// @param image of the view
/// Throws Error: unsupported unless the structure shows its volumes; usage for an impossible view;
///   cancelled.
void draw_volumes(const Accelerator& accelerator, const View& view, int depth, Image& image,
                  const BuildContext& context = {});

}  // namespace strahl

// io/spd.h - the Standard Procedural Databases (E. Haines, SPD 3.14), written from their
// published description: sizes, geometry, order of primitives, views, lights and fills.
//
// Each function makes one scene in full double precision; round_to_six_digits() turns it into what
// the SPD program prints. The order of primitives is that of the SPD program's NFF output.
// Thread safety: pure functions (libm: last digits may differ between platforms).
#pragma once

#include <strahl/io/nff_scene.h>

namespace strahl {

/// Sphereflake over a square: (9^(size+1) - 1) / 8 spheres, 1 polygon.
NffScene spd_balls(int size);
/// size^3 gears over a square: 146 size^3 + 1 polygons, two of each gear with 144 corners.
NffScene spd_gears(int size);
/// (8^size - 1) / 7 jacks of 6 spheres and 3 cylinders.
NffScene spd_jacks(int size);
/// (size+1)^3 spheres, 3 size (size+1)^2 cylinders between neighbours.
NffScene spd_lattice(int size);
/// Fractal mountain of 2 * 4^size triangles below 4 glass spheres.
NffScene spd_mount(int size);
/// Pyramid of ringed dodecahedra: 5 size (size+1) (2 size+1) spheres and as many cylinders, a
/// square.
NffScene spd_rings(int size);
/// Damped cosine over a grid of n = 32 * 2^(size-1) samples a side: 2 (n-1)^2 triangles.
NffScene spd_sombrero(int size);
/// Teapot on a checkerboard: 64 size^2 - 8 size patches (smooth triangles), size^2 squares.
NffScene spd_teapot(int size);
/// Sierpinski tetrahedron of 4^size triangles.
NffScene spd_tetra(int size);
/// Binary tree: 2^(size+1) - 1 cones and as many spheres, 1 square.
NffScene spd_tree(int size);
/// Spiral of 180 * 2^size + 1 overlapping spheres.
NffScene spd_shells(int size);

}  // namespace strahl

// io/nff.h - reader of NFF text, the format of the Standard Procedural Databases.
//
// Format:   [Haines1987]: view `v`, background `b`, lights `l`, materials `f`, polygons `p` and
//           `pp`, spheres `s`, cones and cylinders `c`; `#` starts a comment.
// Thread safety: pure function of the file.
#pragma once

#include <strahl/geometry/scene.h>
#include <strahl/io/file_bytes.h>

namespace strahl {

/// Geometries, each only if it has primitives: id 0 triangles, 1 spheres, 2 cones and cylinders
/// (`c`, without end caps), in file order and double precision. face_ids count `p` and `pp`
/// together from 0 and exist only if one was not a triangle; polygons of fewer than 3 corners are
/// skipped with a warning; corner normals of `pp` are read and dropped. Material i is the i-th `f`,
/// preceded by the default one if primitives come before the first `f`; every primitive has its
/// index. The view is the last `v` (`hither` is ignored); light colours are dropped. Blanks and
/// line ends separate numbers alike, except that the colour of a light stands on its line.
/// Coordinates that are not finite are kept, so that primitive ids stay those of the file.
/// Throws Error{bad_input} with the line: an unknown statement, a number missing or malformed, a
/// view
///   that is incomplete, not finite, with an angle outside 0..180 or a resolution outside 1..65536.
/// Complexity: O(bytes) plus triangulate_polygon per polygon; memory a small multiple of the file.
SceneData read_nff(const FileBytes& file);

}  // namespace strahl

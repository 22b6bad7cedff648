// io/obj.h - reader of Wavefront OBJ text: vertices, polygons, diffuse colours of materials.
//
// Thread safety: pure function of the file (and of the material libraries beside it).
#pragma once

#include <strahl/geometry/scene.h>
#include <strahl/io/file_bytes.h>

namespace strahl {

/// All faces of the file, in order, as one geometry with id 0 and vertices in double precision;
/// none if there are no faces (a warning says so, also for an empty file). face_ids count the `f`
/// statements from 0 and exist only if one of them was not a triangle. Faces may come before their
/// vertices; negative indices count back from the last vertex read. Faces of fewer than 3 corners
/// are skipped with a warning; repeated and not finite vertices are kept, so that primitive ids
/// stay those of the file. Texture and normal indices, w, colours, lines, points and curves are
/// ignored. Materials: index 0 is the default one, those of `usemtl` follow; without any found
/// there are none. Material libraries that are missing or malformed only give a warning. Numbers: a
/// token with a valid beginning ("3.1+e2") is read as that (3.1) with a warning. Throws
/// Error{bad_input} with the line: text that has NUL bytes or no OBJ statement at all, a
///   missing coordinate or one without a valid beginning, an index that is 0, malformed or out of
///   range.
/// Complexity: O(bytes) plus triangulate_polygon per face; memory a small multiple of the file.
SceneData read_obj(const FileBytes& file);

}  // namespace strahl

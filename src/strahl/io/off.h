// io/off.h - reader of OFF files.
#pragma once

#include <strahl/geometry/scene.h>
#include <strahl/io/file_bytes.h>

namespace strahl {

/// Reads an ascii OFF file as one geometry of triangles; face_ids name the polygon.
/// The first word is OFF with any of the prefixes ST, C and N; the counts follow it on the same
/// or the next line, the count of edges may lack. Each vertex and each face starts a line; what
/// follows x y z or the indices (normals, colours) is ignored, as are comments (#). Coordinates
/// are float64. Faces of fewer than 3 vertices are skipped with a warning; no triangles: an empty
/// scene with a warning.
/// Throws Error{bad_input} naming the file and "line N": another header (also 4OFF, nOFF, BINARY),
/// counts that do not fit the file, a missing or malformed number, an index out of range.
/// Memory: a small multiple of the file size.
SceneData read_off(const FileBytes& file);

}  // namespace strahl

// io/ply.h - reader of PLY files.
#pragma once

#include <strahl/geometry/scene.h>
#include <strahl/io/file_bytes.h>

namespace strahl {

/// Reads a PLY file: ascii or binary of either byte order, elements and properties in any order,
/// unknown ones skipped. Float vertices of binary files in this machine's byte order are used in
/// place where file.owner keeps them alive.
/// - element "face" with a list "vertex_indices" or "vertex_index", and element "tristrips" (-1
///   starts a new strip), give one geometry of triangles; faces of fewer than 3 vertices are
///   skipped with a warning, face_ids name the face, or the triangle of the strips, from 0;
/// - without faces, vertices with a property "radius" are spheres;
/// - neither: an empty scene with a warning.
/// Coordinates are float32 if x, y and z fit it by type, else float64.
/// Throws Error{bad_input} naming the file and "line N" or "byte N": a malformed header, x, y or z
/// missing, a body that ends early, a vertex index out of range, a malformed number.
/// Memory: a small multiple of the file size; counts are checked against the bytes left.
SceneData read_ply(const FileBytes& file);

}  // namespace strahl

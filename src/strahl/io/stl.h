// io/stl.h - reader of STL files.
#pragma once

#include <strahl/geometry/scene.h>
#include <strahl/io/file_bytes.h>

namespace strahl {

/// Reads an STL file, binary or ascii, as one geometry of triangles in file order with three
/// vertices of their own each; nothing is welded or left out. Binary coordinates are float32,
/// those of text float64. Normals, attributes and names are ignored.
/// Binary is what has the size that its count of triangles demands, whatever its header says; else
/// a text starting with "solid" (any case) is ascii; else more bytes than the count demands are a
/// warning. No triangles: an empty scene with a warning.
/// Ascii: any number of solids, keywords in any case, a missing endsolid is accepted.
/// Throws Error{bad_input} naming the file and "line N" or "byte N": fewer bytes than the count
/// demands, neither form, a facet without exactly 3 vertices, a malformed number or keyword.
/// Memory: a small multiple of the file size.
SceneData read_stl(const FileBytes& file);

}  // namespace strahl

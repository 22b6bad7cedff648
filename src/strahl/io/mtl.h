// io/mtl.h - material libraries of OBJ files: the names and their diffuse colours.
//
// Thread safety: pure function.
#pragma once

#include <map>
#include <string>

#include <strahl/geometry/scene.h>
#include <strahl/io/file_bytes.h>

namespace strahl {

/// Reads `newmtl` and `Kd` with three numbers; all else is ignored. A name keeps its first
/// definition; one without colour keeps Material's.
/// Throws Error{bad_input} with the line of a colour that is not three finite numbers or stands
/// before the first name.
std::map<std::string, Material, std::less<>> read_mtl(const FileBytes& file);

}  // namespace strahl

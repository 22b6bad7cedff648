// io/load.h - a scene from what a user names: a file of any known format or a generator.
//
// Thread safety: functions without state.
#pragma once

#include <string>
#include <vector>

#include <strahl/geometry/scene.h>
#include <strahl/io/deform.h>

namespace strahl {

/// The scene that `scene` names: "gen:NAME[:SIZE[,key=value...]]" (io/generators.h), else a file
/// whose format its extension tells, in any case.
/// Throws Error{bad_input} naming the file: unknown extension, cannot be opened, malformed; those
/// of generate_scene().
SceneData load_scene_data(const std::string& scene);

/// The same with all that can move it: the nodes and animations of glTF; for other formats each
/// instance is a node without a name.
RiggedScene load_rigged_scene(const std::string& scene);

/// The known extensions, lower case, with their dot, sorted.
std::vector<std::string> supported_extensions();

}  // namespace strahl

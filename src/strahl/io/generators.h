// io/generators.h - standard scenes made by the program: "gen:NAME[:SIZE[,key=value...]]".
//
// SPD scenes are in spd.h, all others in generator_shapes.h; this file knows them by name.
// Thread safety: functions without state.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <strahl/base/options.h>
#include <strahl/io/nff_scene.h>

namespace strahl {

/// What a user may know about a generator.
struct GeneratorInfo {
  std::string name;
  int default_size = 0, min_size = 0, max_size = 0;
  std::string size_help;  ///< what the size counts
  std::string help;
  std::vector<OptionInfo> options;  ///< the keys it takes
};

/// All generators in the order in which they are listed.
std::vector<GeneratorInfo> generator_list();

/// Makes a scene. The same text gives the same scene; SPD scenes use libm, so their last digits may
/// differ between platforms with precision=full.
/// @param spec NAME[:SIZE[,key=value...]], with or without "gen:" before it
/// Throws Error{usage} naming an unknown generator (and the known ones), a size or option out of
/// its range; Error{resource} above 100 million primitives, before anything is allocated.
SceneData generate_scene(std::string_view spec);

/// An SPD scene with its polygons and fills, as generate_scene() triangulates it; nothing for other
/// generators. Throws like generate_scene().
std::optional<NffScene> generate_nff_scene(std::string_view spec);

}  // namespace strahl

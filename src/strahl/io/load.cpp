// io/load.cpp - readers by extension.
#include <array>
#include <filesystem>
#include <string_view>

#include <strahl/base/error.h>
#include <strahl/io/file_bytes.h>
#include <strahl/io/generators.h>
#include <strahl/io/gltf.h>
#include <strahl/io/load.h>
#include <strahl/io/nff.h>
#include <strahl/io/obj.h>
#include <strahl/io/off.h>
#include <strahl/io/ply.h>
#include <strahl/io/stl.h>
#include <strahl/io/text_cursor.h>

namespace strahl {
namespace {

struct Format {
  std::string_view extension;
  SceneData (*read)(const FileBytes&);
};

constexpr std::array<Format, 7> kFormats{{{".glb", read_gltf},
                                          {".gltf", read_gltf},
                                          {".nff", read_nff},
                                          {".obj", read_obj},
                                          {".off", read_off},
                                          {".ply", read_ply},
                                          {".stl", read_stl}}};

}  // namespace

SceneData load_scene_data(const std::string& scene) {
  if (scene.starts_with("gen:")) return generate_scene(scene);
  const std::filesystem::path path(scene);
  const std::string extension = to_lower(path.extension().string());
  std::string known = "gen:NAME";
  for (const Format& format : kFormats) {
    if (format.extension == extension) return format.read(map_file(path));
    known.append(" ").append(format.extension);
  }
  throw Error(ErrorCode::bad_input,
              "unknown scene format " + quote(extension) + "; known: " + known, scene);
}

RiggedScene load_rigged_scene(const std::string& scene) {
  const std::filesystem::path path(scene);
  const std::string extension = to_lower(path.extension().string());
  if (!scene.starts_with("gen:") && (extension == ".glb" || extension == ".gltf"))
    return read_rigged_gltf(map_file(path));
  RiggedScene result;
  result.scene = load_scene_data(scene);
  // As a Scene would add it: one instance of all geometries.
  if (result.scene.instances.empty() && !result.scene.geometries.empty())
    result.scene.instances.push_back(
        {0, static_cast<std::uint32_t>(result.scene.geometries.size()), {}, 0});
  result.rig = flat_rig(result.scene);
  return result;
}

std::vector<std::string> supported_extensions() {
  std::vector<std::string> extensions;
  extensions.reserve(std::size(kFormats));
  for (const Format& format : kFormats) extensions.emplace_back(format.extension);
  return extensions;
}

}  // namespace strahl

// io/scene_writer.cpp - generated scenes straight to a file.
#include <algorithm>
#include <optional>
#include <string>

#include <strahl/base/error.h>
#include <strahl/io/generators.h>
#include <strahl/io/scene_writer.h>

namespace strahl {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return extension;
}

}  // namespace

void write_generated(std::string_view spec, const std::filesystem::path& path,
                     const Progress& progress) {
  const std::string extension = lower_extension(path);
  if (extension == ".ply") {
    write_ply(generate_scene(spec), path, progress);
  } else if (extension == ".nff") {
    const std::optional<NffScene> scene = generate_nff_scene(spec);
    write_nff(scene ? *scene : to_nff_scene(generate_scene(spec)), path, progress);
  } else {
    throw Error(ErrorCode::usage, "scenes are written as .ply or .nff", path.string());
  }
}

}  // namespace strahl

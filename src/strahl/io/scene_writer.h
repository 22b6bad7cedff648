// io/scene_writer.h - scenes written to PLY and NFF files.
//
// Both formats keep every coordinate exactly and appear under their name only when complete.
// Progress is asked before the file is created and again and again while it is written; when it
// returns false, Error{cancelled} is thrown and nothing is left behind.
// Thread safety: functions without state.
#pragma once

#include <filesystem>
#include <string_view>

#include <strahl/base/build_context.h>
#include <strahl/io/nff_scene.h>

namespace strahl {

/// Binary little-endian PLY: the triangles of all geometries in order of instance, geometry and
/// primitive, in world space; or spheres as vertices with a radius. Float where that is exact, else
/// double. Throws Error{usage} for cones, for triangles mixed with spheres (write NFF), and for
/// spheres under an instance that moves them; Error{resource} when writing fails or there are more
/// than 2^31 - 1 vertices.
void write_ply(const SceneData& data, const std::filesystem::path& path,
               const Progress& progress = {});

/// Text. Numbers have the fewest digits that read back to the same double, as %g prints where six
/// suffice; those that are not finite are written as inf and nan. Throws Error{resource} when
/// writing fails.
void write_nff(const NffScene& scene, const std::filesystem::path& path,
               const Progress& progress = {});

/// The same for any scene, see to_nff_scene().
void write_nff(const SceneData& data, const std::filesystem::path& path,
               const Progress& progress = {});

/// Generates a scene (see generate_scene) and writes it in the format of the extension, .ply or
/// .nff in any case. SPD scenes keep their polygons and patches in NFF.
/// Throws Error{usage} for another extension, before anything is generated.
void write_generated(std::string_view spec, const std::filesystem::path& path,
                     const Progress& progress = {});

}  // namespace strahl

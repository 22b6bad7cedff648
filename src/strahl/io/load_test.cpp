// io/load_test.cpp - scenes by name: extensions, generators, what cannot be loaded.
#include <filesystem>
#include <fstream>
#include <regex>
#include <tests/support/memory_file.h>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/io/load.h>
#include <strahl/io/temp_folder_test.h>

namespace strahl {
namespace {

using test::error_of;
using test::TempFolder;

std::size_t primitive_count(const SceneData& scene) {
  std::size_t count = 0;
  for (const Geometry& geometry : scene.geometries) count += geometry.size();
  return count;
}

// The size a row of the table states: "| a.ply | 10 | 4520 tris |"; 0 if it is no such row.
std::size_t stated_size(const std::string& row) {
  std::smatch match;
  const std::regex pattern(R"(^\| \S+ \| \d+ \| (\d+) (tris|spheres) \|.*)");
  return std::regex_match(row, match, pattern) ? std::stoul(match[1]) : 0;
}

TEST(Load, KnowsTheFormatsByExtensionInAnyCase) {
  const TempFolder folder;
  const std::string facet =
      "solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid\n";
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const auto& [name, text] : {std::pair{"a.STL", facet}, {"b.Obj", obj}, {"c.off", off}}) {
    const SceneData scene = load_scene_data(folder.write(name, text).string());
    EXPECT_EQ(primitive_count(scene), 1u) << name;
    EXPECT_EQ(scene.source, (folder / name).string());
  }
}

TEST(Load, ListsItsExtensionsSorted) {
  EXPECT_EQ(supported_extensions(),
            (std::vector<std::string>{".glb", ".gltf", ".nff", ".obj", ".off", ".ply", ".stl"}));
}

TEST(Load, UnknownFormatsAreErrorsThatNameTheKnownOnes) {
  EXPECT_EQ(error_of([] { load_scene_data("some.3ds"); }),
            "some.3ds: unknown scene format '.3ds'; known: gen:NAME .glb .gltf .nff .obj .off .ply "
            ".stl");
  EXPECT_NE(error_of([] { load_scene_data("ply"); }).find("unknown scene format ''"),
            std::string::npos);
}

TEST(Load, FilesThatCannotBeOpenedAreErrorsThatNameThem) {
  const TempFolder folder;
  const std::string missing = (folder / "missing.ply").string();
  const std::string no_file = error_of([&] { load_scene_data(missing); });
  EXPECT_TRUE(no_file.starts_with(missing + ": ")) << no_file;
  EXPECT_TRUE(no_file.ends_with("No such file or directory")) << no_file;
  const std::string directory = (folder / "folder.ply").string();
  std::filesystem::create_directory(directory);
  const std::string no_regular_file = error_of([&] { load_scene_data(directory); });
  EXPECT_TRUE(no_regular_file.starts_with(directory + ": ")) << no_regular_file;
  EXPECT_TRUE(no_regular_file.ends_with("not a regular file")) << no_regular_file;
}

TEST(Load, MakesGeneratedScenes) {
  EXPECT_GT(primitive_count(load_scene_data("gen:icosphere:1")), 0u);
  EXPECT_NE(error_of([] { load_scene_data("gen:nothing_of_this_name"); }), "no error");
}

TEST(Load, TheSharedScenesHaveTheirPublishedSizes) {
  STRAHL_REQUIRE_SHARED("scenes/MANIFEST.md");
  const std::filesystem::path folder = test::shared_dir() / "scenes";
  std::ifstream manifest(folder / "MANIFEST.md");
  std::size_t checked = 0;
  for (std::string row; std::getline(manifest, row);) {
    const std::size_t expected = stated_size(row);
    if (expected == 0) continue;
    const std::string name = row.substr(2, row.find(" |", 2) - 2);
    EXPECT_EQ(primitive_count(load_scene_data((folder / name).string())), expected) << name;
    ++checked;
  }
  EXPECT_GT(checked, 20u);
}

}  // namespace
}  // namespace strahl

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <strahl/io/gltf.h>
#include <strahl/io/gltf_animation.h>
#include <strahl/io/gltf_instancing.h>
#include <strahl/io/gltf_mesh.h>
#include <strahl/io/gltf_nodes.h>
#include <strahl/io/gltf_skin.h>

namespace strahl {
namespace {

using gltf::JsonValue;

// A run of SceneData::geometries.
struct Range {
  std::uint32_t first = 0, count = 0;
};

Material read_material(const JsonValue& material) {
  Material result;
  result.color = {1, 1, 1};
  const std::optional<JsonValue> pbr = material.find("pbrMetallicRoughness");
  const std::optional<JsonValue> factor = pbr ? pbr->find("baseColorFactor") : std::nullopt;
  if (!factor) return result;
  const auto [red, green, blue, alpha] = factor->numbers<4>();
  result.color = {red, green, blue};
  return result;
}

// A camera looks along -z with +y up.
std::optional<View> read_camera(const JsonValue& camera, const Affine& to_world) {
  const std::optional<JsonValue> perspective = camera.find("perspective");
  if (!perspective || !is_well_conditioned(to_world)) return std::nullopt;
  const std::optional<JsonValue> aspect = perspective->find("aspectRatio");
  const double fov = perspective->at("yfov").number(), ratio = aspect ? aspect->number() : 1.0;
  // Beyond these no sensible picture comes out.
  if (!(fov > 0 && fov < std::numbers::pi && ratio >= 1.0 / 16 && ratio <= 16)) return std::nullopt;
  View view;
  view.from = to_world.point({0, 0, 0});
  view.at = view.from + to_world.vector({0, 0, -1});
  view.up = to_world.vector({0, 1, 0});
  view.fov_degrees = fov * 180 / std::numbers::pi;
  view.width = static_cast<int>(std::lround(view.height * ratio));
  return view;
}

class SceneReader {
 public:
  explicit SceneReader(const FileBytes& file)
      : document_(file), accessors_(document_), meshes_(accessors_) {
    scene_.source = file.name;
  }

  SceneData read() {
    // First what needs no buffers: a mistake there is not hidden by a missing file.
    tree_ = gltf::read_nodes(document_);
    read_materials();
    for (std::size_t m = 0; m < document_.count("meshes"); ++m)
      read_mesh(document_.item("meshes", m));
    for (const std::uint32_t n : tree_.order) place_node(n);
    find_view();
    if (scene_.instances.empty()) document_.warn(document_.root(), "the scene shows no mesh");
    drop_unused_geometries();
    scene_.warnings = document_.take_warnings();
    return std::move(scene_);
  }

  RiggedScene read_rigged() {
    RiggedScene result;
    keeps_deformers_ = true;
    blended_ = gltf::find_blended_nodes(document_);
    result.scene = read();
    result.animations = gltf::read_animations(accessors_);
    result.deformers = std::move(deformers_);
    for (std::string& warning : document_.take_warnings())
      result.scene.warnings.push_back(std::move(warning));
    result.rig = std::move(tree_.rig);
    result.rig.mounts = std::move(mounts_);
    return result;
  }

 private:
  void read_materials();
  void read_mesh(const JsonValue& mesh);
  Geometry read_primitive(const JsonValue& primitive, const std::vector<double>& weights);
  void assign_material(Geometry& geometry, const JsonValue& primitive);
  void place_node(std::uint32_t n);
  Range deform(std::uint32_t n, const JsonValue& mesh, Range base);
  Geometry deformed(std::uint32_t n, const Geometry& base, const JsonValue& primitive,
                    const std::vector<double>& weights);
  void place(const JsonValue& node, Range range, const Affine& to_world,
             const std::optional<Mount>& mount);
  void find_view();
  void drop_unused_geometries();

  gltf::Document document_;
  gltf::Accessors accessors_;
  gltf::MeshReader meshes_;
  gltf::NodeTree tree_;
  gltf::Skins skins_{accessors_};
  std::vector<Deformer> deformers_;
  bool keeps_deformers_ = false;
  std::set<std::uint32_t> blended_;  ///< nodes whose morph weights are animated
  std::vector<Range> mesh_ranges_;
  std::vector<std::optional<Mount>> mounts_;  ///< per instance of the scene
  std::uint32_t next_instance_id_ = 0;
  SceneData scene_;
};

// The material of primitives that name none comes last.
void SceneReader::read_materials() {
  for (std::size_t i = 0; i < document_.count("materials"); ++i)
    scene_.materials.push_back(read_material(document_.item("materials", i)));
  scene_.materials.push_back({{1, 1, 1}});
}

void SceneReader::read_mesh(const JsonValue& mesh) {
  const JsonValue primitives = mesh.at("primitives");
  const std::string name = gltf::string_or(mesh, "name", "");
  const std::vector<double> weights = gltf::read_morph_weights(mesh);
  const auto first = static_cast<std::uint32_t>(scene_.geometries.size());
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    Geometry geometry = read_primitive(primitives[p], weights);
    geometry.name = name;
    geometry.geometry_id = static_cast<std::uint32_t>(scene_.geometries.size());
    scene_.geometries.push_back(std::move(geometry));
  }
  mesh_ranges_.push_back({first, static_cast<std::uint32_t>(primitives.size())});
}

Geometry SceneReader::read_primitive(const JsonValue& primitive,
                                     const std::vector<double>& weights) {
  Geometry geometry;
  geometry.mesh = meshes_.read(primitive);
  if (!weights.empty() && geometry.mesh.size() > 0)
    geometry.mesh = gltf::with_positions(
        geometry.mesh,
        gltf::read_shapes(accessors_, primitive, weights, false).positions(weights, {}));
  assign_material(geometry, primitive);
  return geometry;
}

void SceneReader::assign_material(Geometry& geometry, const JsonValue& primitive) {
  const auto count = static_cast<std::uint32_t>(scene_.materials.size() - 1);
  const std::optional<JsonValue> reference = primitive.find("material");
  const std::uint32_t material = reference ? reference->index(count, "materials") : count;
  if (material == 0) return;
  document_.charge(geometry.size(), sizeof(std::uint32_t), primitive);
  geometry.materials.assign(geometry.size(), material);
}

void SceneReader::place_node(std::uint32_t n) {
  const JsonValue node = document_.item("nodes", n);
  const std::optional<JsonValue> reference = node.find("mesh");
  if (!reference) return;
  const std::uint32_t m = reference->index(mesh_ranges_.size(), "meshes");
  Range range = mesh_ranges_[m];
  const bool is_skinned = node.find("skin").has_value();
  if (is_skinned || node.find("weights") || blended_.count(n) != 0)
    range = deform(n, document_.item("meshes", m), range);
  // A skin takes the mesh to the world by its joints alone.
  if (is_skinned) return place(node, range, Affine{}, std::nullopt);
  for (const Affine& copy : gltf::read_copies(accessors_, node))
    place(node, range, tree_.to_world[n] * copy, Mount{n, copy});
}

// Copies of the mesh's geometries with the node's own shape.
Range SceneReader::deform(std::uint32_t n, const JsonValue& mesh, Range base) {
  const JsonValue node = document_.item("nodes", n);
  const std::vector<double> weights = gltf::read_morph_weights(node.find("weights") ? node : mesh);
  const Range result{static_cast<std::uint32_t>(scene_.geometries.size()), base.count};
  for (std::uint32_t p = 0; p < base.count; ++p)
    scene_.geometries.push_back(
        deformed(n, scene_.geometries[base.first + p], mesh.at("primitives")[p], weights));
  return result;
}

// The next geometry of the scene.
Geometry SceneReader::deformed(std::uint32_t n, const Geometry& base, const JsonValue& primitive,
                               const std::vector<double>& weights) {
  document_.charge(base.materials.size(), sizeof(std::uint32_t), primitive);
  Geometry copy = base;
  if (base.mesh.size() == 0) return copy;
  Deformer deformer = gltf::read_shapes(accessors_, primitive, weights, blended_.count(n) != 0);
  deformer.geometry = static_cast<std::uint32_t>(scene_.geometries.size());
  deformer.node = n;
  if (const std::optional<JsonValue> skin = document_.item("nodes", n).find("skin")) {
    const gltf::Skin& own = skins_.get(*skin);
    deformer.joints = own.joints, deformer.inverse_binds = own.inverse_binds;
    deformer.skin =
        gltf::read_skin_weights(accessors_, primitive, deformer.base.size(), own.joints.size());
  }
  copy.mesh = gltf::with_positions(base.mesh, deformer.positions(deformer.weights, tree_.to_world));
  if (keeps_deformers_) deformers_.push_back(std::move(deformer));
  return copy;
}

void SceneReader::place(const JsonValue& node, Range range, const Affine& to_world,
                        const std::optional<Mount>& mount) {
  const std::uint32_t id = next_instance_id_++;
  document_.charge(range.count, sizeof(Part), node);
  if (is_well_conditioned(to_world)) {
    scene_.instances.push_back({range.first, range.count, to_world, id});
    mounts_.push_back(mount);
  } else {
    document_.warn(node, "instance " + std::to_string(id) +
                             " dropped: its transform is singular or not finite");
  }
}

void SceneReader::find_view() {
  for (const std::uint32_t n : tree_.order) {
    const std::optional<JsonValue> reference = document_.item("nodes", n).find("camera");
    if (!reference) continue;
    scene_.view = read_camera(document_.item("cameras", *reference), tree_.to_world[n]);
    if (scene_.view) return;
  }
}

// Geometries without an instance (meshes off the scene, undeformed shapes) would be counted, and
// a scene without instances would show them all.
void SceneReader::drop_unused_geometries() {
  std::vector<bool> is_used(scene_.geometries.size());
  for (const Instance& instance : scene_.instances)
    std::fill_n(is_used.begin() + instance.first_geometry, instance.geometry_count, true);
  std::vector<std::uint32_t> new_index(is_used.size());
  std::vector<Geometry> kept;
  for (std::size_t g = 0; g < is_used.size(); ++g) {
    new_index[g] = static_cast<std::uint32_t>(kept.size());
    if (is_used[g]) kept.push_back(std::move(scene_.geometries[g]));
  }
  for (Instance& instance : scene_.instances)
    instance.first_geometry = instance.geometry_count > 0 ? new_index[instance.first_geometry] : 0;
  scene_.geometries = std::move(kept);
  std::erase_if(deformers_, [&](const Deformer& d) { return !is_used[d.geometry]; });
  for (Deformer& deformer : deformers_) deformer.geometry = new_index[deformer.geometry];
}

}  // namespace

SceneData read_gltf(const FileBytes& file) { return SceneReader(file).read(); }

RiggedScene read_rigged_gltf(const FileBytes& file) { return SceneReader(file).read_rigged(); }

}  // namespace strahl

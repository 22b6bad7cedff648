#include <algorithm>
#include <string>
#include <utility>

#include <strahl/io/gltf_mesh.h>
#include <strahl/io/gltf_skin.h>

namespace strahl::gltf {
namespace {

Vec3d vector_at(const Array& array, std::size_t i) {
  return {array.number(i, 0), array.number(i, 1), array.number(i, 2)};
}

const Array& same_length(const Array& array, std::size_t count, const JsonValue& place) {
  if (array.count != count)
    place.fail(std::to_string(array.count) + " elements for " + std::to_string(count) +
               " vertices");
  return array;
}

/// Differences to the base; nothing where the target moves no positions.
std::vector<Vec3d> read_target(Accessors& accessors, const JsonValue& target, std::size_t count) {
  const std::optional<JsonValue> reference = target.find("POSITION");
  if (!reference) return {};
  const Array& deltas = same_length(read_positions(accessors, *reference), count, *reference);
  accessors.document().charge(deltas.count, sizeof(Vec3d), *reference);
  std::vector<Vec3d> differences;
  differences.reserve(count);
  for (std::size_t i = 0; i < count; ++i) differences.push_back(vector_at(deltas, i));
  return differences;
}

// One pair JOINTS_n, WEIGHTS_n of vertex attributes: four influences each.
struct Influences {
  const Array& joints;
  const Array& weights;
  JsonValue place;
};

std::optional<Influences> read_influences(Accessors& accessors, const JsonValue& attributes,
                                          std::size_t set, std::size_t vertex_count) {
  const std::string suffix = "_" + std::to_string(set);
  const std::optional<JsonValue> joints = attributes.find(("JOINTS" + suffix).c_str());
  if (!joints) return std::nullopt;
  const JsonValue weights = attributes.at(("WEIGHTS" + suffix).c_str());
  const Array& joint_array = same_length(accessors.get(*joints, 4), vertex_count, *joints);
  if (!joint_array.is_unsigned()) joints->fail("joints must be unsigned integers");
  accessors.document().charge(vertex_count, 4 * sizeof(double), *joints);
  return Influences{joint_array, same_length(accessors.get(weights, 4), vertex_count, weights),
                    *joints};
}

std::vector<Influences> read_all_influences(Accessors& accessors, const JsonValue& primitive,
                                            std::size_t vertex_count) {
  const JsonValue attributes = primitive.at("attributes");
  std::vector<Influences> sets;
  while (std::optional<Influences> set =
             read_influences(accessors, attributes, sets.size(), vertex_count))
    sets.push_back(*std::move(set));
  if (sets.empty()) primitive.fail("the mesh has a skin, but the primitive has no JOINTS_0");
  return sets;
}

Influence influence_of(const Influences& set, std::size_t vertex, std::size_t k,
                       std::size_t joint_count) {
  // Joint indices are small integers, so the number is exact.
  const auto joint = static_cast<std::size_t>(set.joints.number(vertex, k));
  if (joint >= joint_count)
    set.place.fail("joint " + std::to_string(joint) + " of vertex " + std::to_string(vertex) +
                   ", but the skin has " + std::to_string(joint_count));
  return {static_cast<std::uint32_t>(joint), set.weights.number(vertex, k)};
}

}  // namespace

std::vector<double> read_morph_weights(const JsonValue& holder) {
  std::vector<double> weights;
  const std::optional<JsonValue> list = holder.find("weights");
  for (std::size_t i = 0; list && i < list->size(); ++i) weights.push_back((*list)[i].number());
  if (std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0; })) return {};
  return weights;
}

Deformer read_shapes(Accessors& accessors, const JsonValue& primitive, std::vector<double> weights,
                     bool has_all) {
  const JsonValue reference = primitive.at("attributes").at("POSITION");
  const Array& base = read_positions(accessors, reference);
  accessors.document().charge(base.count, sizeof(Vec3d) + sizeof(Vec3f), reference);
  Deformer deformer;
  deformer.base.reserve(base.count);
  for (std::size_t i = 0; i < base.count; ++i) deformer.base.push_back(vector_at(base, i));

  const std::optional<JsonValue> targets = primitive.find("targets");
  const std::size_t count = targets ? targets->size() : 0;
  if (weights.size() > count)
    primitive.fail("has fewer morph targets than the " + std::to_string(weights.size()) +
                   " weights of its mesh or node");
  deformer.targets.resize(has_all ? count : weights.size());
  for (std::size_t t = 0; t < deformer.targets.size(); ++t)
    if (has_all || weights[t] != 0.0)
      deformer.targets[t] = read_target(accessors, (*targets)[t], base.count);
  deformer.weights = std::move(weights);
  return deformer;
}

const Skin& Skins::get(const JsonValue& reference) {
  const std::size_t i = reference.index(skins_.size(), "skins");
  if (!skins_[i]) skins_[i] = read(accessors_.document().item("skins", i));
  return *skins_[i];
}

Skin Skins::read(const JsonValue& skin) {
  const JsonValue list = skin.at("joints");
  const std::optional<JsonValue> reference = skin.find("inverseBindMatrices");
  const Array* inverse_binds = reference ? &accessors_.get(*reference, 16) : nullptr;
  if (inverse_binds != nullptr && inverse_binds->count < list.size())
    reference->fail(std::to_string(inverse_binds->count) + " matrices for " +
                    std::to_string(list.size()) + " joints");
  Skin result;
  for (std::size_t j = 0; j < list.size(); ++j) {
    result.joints.push_back(list[j].index(accessors_.document().count("nodes"), "nodes"));
    if (inverse_binds == nullptr) continue;
    std::array<double, 16> columns{};
    for (std::size_t c = 0; c < 16; ++c) columns[c] = inverse_binds->number(j, c);
    result.inverse_binds.push_back(from_columns(columns, *reference));
  }
  return result;
}

SkinWeights read_skin_weights(Accessors& accessors, const JsonValue& primitive,
                              std::size_t vertex_count, std::size_t joint_count) {
  const std::vector<Influences> sets = read_all_influences(accessors, primitive, vertex_count);
  SkinWeights skin;
  for (std::size_t i = 0; i < vertex_count; ++i) {
    for (const Influences& set : sets)
      for (std::size_t k = 0; k < 4; ++k)
        if (set.weights.number(i, k) != 0.0)
          skin.influences.push_back(influence_of(set, i, k, joint_count));
    if (skin.influences.size() == skin.starts.back())
      skin.influences.push_back(influence_of(sets[0], i, 0, joint_count));
    skin.starts.push_back(static_cast<std::uint32_t>(skin.influences.size()));
  }
  return skin;
}

}  // namespace strahl::gltf

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

void add_target(Accessors& accessors, const JsonValue& target, double weight,
                std::vector<Vec3d>& positions) {
  const std::optional<JsonValue> reference = target.find("POSITION");
  if (weight == 0 || !reference) return;
  const Array& deltas =
      same_length(read_positions(accessors, *reference), positions.size(), *reference);
  accessors.document().charge(deltas.count, sizeof(Vec3f), *reference);
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = positions[i] + weight * vector_at(deltas, i);
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

const Affine& joint_of(const Influences& set, std::size_t vertex, std::size_t k,
                       const std::vector<Affine>& joints) {
  // Joint indices are small integers, so the number is exact.
  const auto joint = static_cast<std::size_t>(set.joints.number(vertex, k));
  if (joint >= joints.size())
    set.place.fail("joint " + std::to_string(joint) + " of vertex " + std::to_string(vertex) +
                   ", but the skin has " + std::to_string(joints.size()));
  return joints[joint];
}

Vec3d skinned(const std::vector<Influences>& sets, std::size_t vertex, const Vec3d& position,
              const std::vector<Affine>& joints) {
  Vec3d sum;
  double total = 0;
  for (const Influences& set : sets)
    for (std::size_t k = 0; k < 4; ++k) {
      const double weight = set.weights.number(vertex, k);
      if (weight == 0) continue;
      sum = sum + weight * joint_of(set, vertex, k, joints).point(position);
      total += weight;
    }
  // Stored weights add up to 1 only within rounding.
  return total == 0 ? joint_of(sets[0], vertex, 0, joints).point(position) : sum / total;
}

}  // namespace

std::vector<double> read_morph_weights(const JsonValue& holder) {
  std::vector<double> weights;
  const std::optional<JsonValue> list = holder.find("weights");
  for (std::size_t i = 0; list && i < list->size(); ++i) weights.push_back((*list)[i].number());
  if (std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0; })) return {};
  return weights;
}

std::vector<Vec3d> morphed_positions(Accessors& accessors, const JsonValue& primitive,
                                     const std::vector<double>& weights) {
  const JsonValue reference = primitive.at("attributes").at("POSITION");
  const Array& base = read_positions(accessors, reference);
  accessors.document().charge(base.count, sizeof(Vec3d) + sizeof(Vec3f), reference);
  std::vector<Vec3d> positions;
  positions.reserve(base.count);
  for (std::size_t i = 0; i < base.count; ++i) positions.push_back(vector_at(base, i));

  const std::optional<JsonValue> targets = primitive.find("targets");
  if (weights.size() > (targets ? targets->size() : 0))
    primitive.fail("has fewer morph targets than the " + std::to_string(weights.size()) +
                   " weights of its mesh or node");
  for (std::size_t t = 0; t < weights.size(); ++t)
    add_target(accessors, (*targets)[t], weights[t], positions);
  return positions;
}

const std::vector<Affine>& Skins::joints(const JsonValue& reference) {
  const std::size_t i = reference.index(skins_.size(), "skins");
  if (!skins_[i]) skins_[i] = read(accessors_.document().item("skins", i));
  return *skins_[i];
}

std::vector<Affine> Skins::read(const JsonValue& skin) {
  const JsonValue list = skin.at("joints");
  const std::optional<JsonValue> reference = skin.find("inverseBindMatrices");
  const Array* inverse_binds = reference ? &accessors_.get(*reference, 16) : nullptr;
  if (inverse_binds != nullptr && inverse_binds->count < list.size())
    reference->fail(std::to_string(inverse_binds->count) + " matrices for " +
                    std::to_string(list.size()) + " joints");
  std::vector<Affine> joints;
  for (std::size_t j = 0; j < list.size(); ++j) {
    Affine to_world = tree_.to_world[list[j].index(tree_.to_world.size(), "nodes")];
    if (inverse_binds != nullptr) {
      std::array<double, 16> columns{};
      for (std::size_t c = 0; c < 16; ++c) columns[c] = inverse_binds->number(j, c);
      to_world = to_world * from_columns(columns, *reference);
    }
    joints.push_back(to_world);
  }
  return joints;
}

void apply_skin(Accessors& accessors, const JsonValue& primitive, const std::vector<Affine>& joints,
                std::vector<Vec3d>& positions) {
  const std::vector<Influences> sets = read_all_influences(accessors, primitive, positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = skinned(sets, i, positions[i], joints);
}

}  // namespace strahl::gltf

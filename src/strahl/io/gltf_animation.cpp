#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <strahl/io/gltf_animation.h>

namespace strahl::gltf {
namespace {

/// Keys of one channel are read into doubles.
class ChannelReader {
 public:
  ChannelReader(Accessors& accessors, const JsonValue& animation)
      : accessors_(accessors), samplers_(animation.find("samplers")) {}

  /// Nothing for channels that name no node.
  std::optional<Track> read(const JsonValue& channel) {
    const JsonValue target = channel.at("target");
    const std::optional<JsonValue> node = target.find("node");
    const Channel path = read_path(target.at("path"));
    if (!node) return std::nullopt;
    Track track;
    track.node = node->index(accessors_.document().count("nodes"), "nodes");
    track.channel = path;
    if (path == Channel::weights) track.count = count_targets(*node);
    const JsonValue sampler = sampler_of(channel.at("sampler"));
    track.interpolation = read_interpolation(sampler);
    track.times = read_times(sampler.at("input"));
    track.values = read_values(sampler.at("output"), track);
    return track;
  }

 private:
  JsonValue sampler_of(const JsonValue& reference) const {
    const std::size_t i = reference.index(samplers_ ? samplers_->size() : 0, "samplers");
    return (*samplers_)[i];
  }

  Channel read_path(const JsonValue& path) {
    const std::string& name = path.string();
    if (name == "translation") return Channel::translation;
    if (name == "rotation") return Channel::rotation;
    if (name == "scale") return Channel::scale;
    if (name == "weights") return Channel::weights;
    path.fail("unknown path '" + printable(name) + "'");
  }

  /// Morph targets of what a node shows.
  std::size_t count_targets(const JsonValue& node_reference) const {
    const Document& document = accessors_.document();
    const std::optional<JsonValue> mesh = document.item("nodes", node_reference).find("mesh");
    if (!mesh) node_reference.fail("the node has no mesh whose weights could move");
    std::size_t most = 0;
    const JsonValue primitives = document.item("meshes", *mesh).at("primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p)
      if (const std::optional<JsonValue> targets = primitives[p].find("targets"))
        most = std::max(most, targets->size());
    if (most == 0) node_reference.fail("the mesh of the node has no morph targets");
    return most;
  }

  static Interpolation read_interpolation(const JsonValue& sampler) {
    const std::string name = string_or(sampler, "interpolation", "LINEAR");
    if (name == "LINEAR") return Interpolation::linear;
    if (name == "STEP") return Interpolation::step;
    if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
    sampler.at("interpolation").fail("unknown interpolation '" + printable(name) + "'");
  }

  std::vector<double> read_times(const JsonValue& reference) {
    const Array& array = accessors_.get(reference, 1);
    accessors_.document().charge(array.count, sizeof(double), reference);
    if (array.count == 0) reference.fail("a sampler without times");
    std::vector<double> times;
    for (std::size_t i = 0; i < array.count; ++i) {
      const double time = array.number(i, 0);
      if (!(std::isfinite(time) && time >= 0.0))
        reference.fail("time " + std::to_string(i) + " is negative or not finite");
      if (i > 0 && !(time > times.back()))
        reference.fail("time " + std::to_string(i) + " is not after the one before");
      times.push_back(time);
    }
    return times;
  }

  std::vector<double> read_values(const JsonValue& reference, const Track& track) {
    const std::size_t width = components(track.channel);
    const Array& array = accessors_.get(reference, width);
    const std::size_t per_key = track.interpolation == Interpolation::cubic_spline ? 3 : 1;
    const std::size_t per_time =
        track.channel == Channel::weights ? per_key * track.count : per_key;
    if (array.count != per_time * track.times.size())
      reference.fail(std::to_string(array.count) + " values for " +
                     std::to_string(track.times.size()) + " times");
    accessors_.document().charge(array.count, width * sizeof(double), reference);
    std::vector<double> values;
    for (std::size_t i = 0; i < array.count; ++i) {
      double length = 0.0;
      for (std::size_t c = 0; c < width; ++c) {
        values.push_back(array.number(i, c));
        length += std::abs(values.back());
      }
      const bool is_tangent = per_key == 3 && i % 3 != 1;
      const bool needs_length = track.channel == Channel::rotation && !is_tangent;
      if (!std::isfinite(length) || (needs_length && length == 0.0))
        reference.fail("value " + std::to_string(i) +
                       (std::isfinite(length) ? " has no length" : " is not finite"));
    }
    return values;
  }

  Accessors& accessors_;
  std::optional<JsonValue> samplers_;
};

Motion read_animation(Accessors& accessors, const JsonValue& animation) {
  Motion motion;
  motion.name = string_or(animation, "name", "");
  motion.source = accessors.document().file().name;
  ChannelReader reader(accessors, animation);
  const JsonValue channels = animation.at("channels");
  for (std::size_t i = 0; i < channels.size(); ++i) {
    std::optional<Track> track = reader.read(channels[i]);
    if (!track) continue;
    motion.duration = std::max(motion.duration, track->times.back());
    motion.tracks.push_back(*std::move(track));
  }
  return motion;
}

}  // namespace

std::set<std::uint32_t> find_blended_nodes(const Document& document) {
  std::set<std::uint32_t> nodes;
  for (std::size_t i = 0; i < document.count("animations"); ++i) {
    const std::optional<JsonValue> channels = document.item("animations", i).find("channels");
    for (std::size_t c = 0; channels && c < channels->size(); ++c) {
      const std::optional<JsonValue> target = (*channels)[c].find("target");
      const std::optional<JsonValue> node = target ? target->find("node") : std::nullopt;
      if (node && string_or(*target, "path", "") == "weights")
        nodes.insert(node->index(document.count("nodes"), "nodes"));
    }
  }
  return nodes;
}

std::vector<Motion> read_animations(Accessors& accessors) {
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < accessors.document().count("animations"); ++i)
    motions.push_back(read_animation(accessors, accessors.document().item("animations", i)));
  return motions;
}

}  // namespace strahl::gltf

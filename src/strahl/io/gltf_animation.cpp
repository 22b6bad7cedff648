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

  /// Nothing for channels that move no node's place.
  std::optional<Track> read(const JsonValue& channel) {
    const JsonValue target = channel.at("target");
    const std::optional<JsonValue> node = target.find("node");
    const std::optional<Channel> path = read_path(target.at("path"));
    if (!node || !path) return std::nullopt;
    Track track;
    track.node = node->index(accessors_.document().count("nodes"), "nodes");
    track.channel = *path;
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

  std::optional<Channel> read_path(const JsonValue& path) {
    const std::string& name = path.string();
    if (name == "translation") return Channel::translation;
    if (name == "rotation") return Channel::rotation;
    if (name == "scale") return Channel::scale;
    if (name != "weights") path.fail("unknown path '" + printable(name) + "'");
    accessors_.document().warn(path, "animated morph weights keep their values at rest");
    return std::nullopt;
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
    const std::size_t per_time = track.interpolation == Interpolation::cubic_spline ? 3 : 1;
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
      const bool is_tangent = per_time == 3 && i % 3 != 1;
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

std::vector<Motion> read_animations(Accessors& accessors) {
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < accessors.document().count("animations"); ++i)
    motions.push_back(read_animation(accessors, accessors.document().item("animations", i)));
  return motions;
}

}  // namespace strahl::gltf

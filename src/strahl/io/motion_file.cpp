#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <strahl/io/gltf_json.h>
#include <strahl/io/motion_file.h>

namespace strahl {
namespace {

using gltf::JsonValue;

double finite(const JsonValue& number) {
  const double value = number.number();
  if (!std::isfinite(value)) number.fail("must be finite");
  return value;
}

/// One entry of "tracks": all channels of a node share its times.
class TrackReader {
 public:
  TrackReader(const JsonValue& track, const Rig& rig, const std::string& source)
      : track_(track), rig_(rig), source_(source) {}

  void read(std::vector<Track>& out) {
    shared_.node = read_node();
    shared_.interpolation = read_interpolation();
    shared_.times = read_times();
    const std::size_t before = out.size();
    read_channel("translations", Channel::translation, out);
    read_channel("rotations", Channel::rotation, out);
    read_channel("scales", Channel::scale, out);
    read_angles(out);
    if (out.size() == before)
      track_.fail("moves nothing: needs translations, rotations, scales, degrees or radians");
  }

 private:
  std::uint32_t read_node() const {
    const JsonValue node = track_.at("node");
    if (node.is_string()) return find_node(rig_, node.string(), source_, node.pointer());
    return node.index(rig_.nodes.size(), "nodes");
  }

  Interpolation read_interpolation() const {
    const std::optional<JsonValue> word = track_.find("interpolation");
    if (!word || word->string() == "linear") return Interpolation::linear;
    if (word->string() != "step") word->fail("must be linear or step");
    return Interpolation::step;
  }

  std::vector<double> read_times() const {
    const JsonValue list = track_.at("times");
    if (list.size() == 0) list.fail("must not be empty");
    std::vector<double> times;
    for (std::size_t i = 0; i < list.size(); ++i) {
      times.push_back(finite(list[i]));
      if (times.back() < 0.0) list[i].fail("must not be negative");
      if (i > 0 && !(times[i] > times[i - 1])) list[i].fail("must be after the time before");
    }
    return times;
  }

  /// The list of that name, one element per time.
  std::optional<JsonValue> find_values(const char* name) const {
    std::optional<JsonValue> list = track_.find(name);
    if (list && list->size() != shared_.times.size())
      list->fail(std::to_string(list->size()) + " values for " +
                 std::to_string(shared_.times.size()) + " times");
    return list;
  }

  void read_channel(const char* name, Channel channel, std::vector<Track>& out) {
    const std::optional<JsonValue> list = find_values(name);
    if (!list) return;
    Track track = shared_;
    track.channel = channel;
    for (std::size_t i = 0; i < list->size(); ++i) append(channel, (*list)[i], track.values);
    out.push_back(std::move(track));
  }

  static void append(Channel channel, const JsonValue& element, std::vector<double>& values) {
    const std::size_t width = components(channel);
    if (element.size() != width) element.fail("must hold " + std::to_string(width) + " numbers");
    double squares = 0.0;
    for (std::size_t c = 0; c < width; ++c) {
      values.push_back(finite(element[c]));
      squares += values.back() * values.back();
    }
    if (channel == Channel::rotation && !(squares > 0.0 && std::isfinite(squares)))
      element.fail("must have a length");
  }

  void read_angles(std::vector<Track>& out) {
    const std::optional<JsonValue> degrees = find_values("degrees"),
                                   radians = find_values("radians");
    if (degrees && radians) track_.fail("give degrees or radians, not both");
    const std::optional<JsonValue>& list = degrees ? degrees : radians;
    if (!list) {
      if (const std::optional<JsonValue> axis = track_.find("axis"))
        axis->fail("an axis needs degrees or radians");
      return;
    }
    Track track = shared_;
    track.channel = Channel::angle;
    track.axis = read_axis();
    for (std::size_t i = 0; i < list->size(); ++i)
      track.values.push_back(finite((*list)[i]) * (degrees ? std::numbers::pi / 180 : 1.0));
    out.push_back(std::move(track));
  }

  Vec3d read_axis() const {
    const JsonValue place = track_.at("axis");
    const auto [x, y, z] = place.numbers<3>();
    const Vec3d axis{x, y, z};
    const double size = length(axis);
    if (!(size > 0.0 && std::isfinite(size))) place.fail("must have a length");
    return axis;
  }

  const JsonValue& track_;
  const Rig& rig_;
  const std::string& source_;
  Track shared_;
};

}  // namespace

Motion read_motion(const FileBytes& file, const Rig& rig) {
  const nlohmann::json json = gltf::parse_json(file.text(), file.name, 0);
  const JsonValue root(json, file.name);
  Motion motion;
  motion.source = file.name;
  const JsonValue tracks = root.at("tracks");
  root.allow_only({"duration", "tracks", "comment"});
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const JsonValue track = tracks[i];
    track.allow_only({"node", "interpolation", "times", "translations", "rotations", "scales",
                      "axis", "degrees", "radians", "comment"});
    TrackReader(track, rig, file.name).read(motion.tracks);
    motion.duration = std::max(motion.duration, motion.tracks.back().times.back());
  }
  if (const std::optional<JsonValue> duration = root.find("duration")) {
    motion.duration = finite(*duration);
    if (motion.duration < 0.0) duration->fail("must not be negative");
  }
  return motion;
}

}  // namespace strahl

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/base/fp_env.h>
#include <strahl/io/motion.h>

namespace strahl {
namespace {

using Value = std::array<double, 4>;

double dot(const Value& a, const Value& b) {
  return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
}

/// a * x + b * y
Value mix(double a, const Value& x, double b, const Value& y) {
  Value sum;
  for (std::size_t c = 0; c < 4; ++c) sum[c] = a * x[c] + b * y[c];
  return sum;
}

Value normalized(const Value& v) { return mix(1.0 / std::sqrt(dot(v, v)), v, 0.0, v); }

/// Along the shorter arc between two unit quaternions.
Value slerp(const Value& from, Value to, double s) {
  double cosine = dot(from, to);
  if (cosine < 0.0) {
    to = mix(-1.0, to, 0.0, to);
    cosine = -cosine;
  }
  if (cosine > 0.9999995) return normalized(mix(1.0 - s, from, s, to));
  const double angle = std::acos(cosine), sine = std::sin(angle);
  return normalized(mix(std::sin((1.0 - s) * angle) / sine, from, std::sin(s * angle) / sine, to));
}

/// Two keys and the way between them: s from 0 to 1, `seconds` apart.
struct Segment {
  std::size_t from, to;
  double s, seconds;
};

Segment segment_at(const std::vector<double>& times, double seconds) {
  const auto next = std::upper_bound(times.begin(), times.end(), seconds);
  const auto to = static_cast<std::size_t>(next - times.begin());
  if (to == 0) return {0, 0, 0.0, 0.0};
  if (to == times.size()) return {to - 1, to - 1, 0.0, 0.0};
  const double length = times[to] - times[to - 1];
  return {to - 1, to, (seconds - times[to - 1]) / length, length};
}

class Sampler {
 public:
  explicit Sampler(const Track& track)
      : track_(track), width_(components(track.channel)), stride_(width_) {}
  /// Of one weight.
  Sampler(const Track& track, std::size_t weight)
      : track_(track), width_(1), stride_(track.count), offset_(weight) {}

  Value at(double seconds) const {
    const Segment segment = segment_at(track_.times, seconds);
    if (segment.from == segment.to || track_.interpolation == Interpolation::step)
      return finished(key(segment.from));
    if (track_.interpolation == Interpolation::cubic_spline) return finished(spline(segment));
    const Value a = key(segment.from), b = key(segment.to);
    if (track_.channel == Channel::rotation) return slerp(normalized(a), normalized(b), segment.s);
    return mix(1.0 - segment.s, a, segment.s, b);
  }

 private:
  Value element(std::size_t i) const {
    Value v{};
    for (std::size_t c = 0; c < width_; ++c) v[c] = track_.values[i * stride_ + offset_ + c];
    return v;
  }
  bool is_cubic() const { return track_.interpolation == Interpolation::cubic_spline; }
  Value key(std::size_t i) const { return element(is_cubic() ? 3 * i + 1 : i); }
  Value finished(const Value& v) const {
    return track_.channel == Channel::rotation ? normalized(v) : v;
  }

  /// Hermite's; tangents are per second.
  Value spline(const Segment& g) const {
    const double s = g.s, s2 = s * s, s3 = s2 * s;
    const Value ends = mix(2 * s3 - 3 * s2 + 1, key(g.from), -2 * s3 + 3 * s2, key(g.to));
    const Value tangents = mix((s3 - 2 * s2 + s) * g.seconds, element(3 * g.from + 2),
                               (s3 - s2) * g.seconds, element(3 * g.to));
    return mix(1.0, ends, 1.0, tangents);
  }

  const Track& track_;
  std::size_t width_, stride_, offset_ = 0;
};

/// q * r: the rotation r first, in the space that q turns.
Value product(const Value& q, const Value& r) {
  return {(q[3] * r[0] + q[0] * r[3]) + (q[1] * r[2] - q[2] * r[1]),
          (q[3] * r[1] + q[1] * r[3]) + (q[2] * r[0] - q[0] * r[2]),
          (q[3] * r[2] + q[2] * r[3]) + (q[0] * r[1] - q[1] * r[0]),
          (q[3] * r[3] - q[0] * r[0]) - (q[1] * r[1] + q[2] * r[2])};
}

Value turn(const Vec3d& axis, double angle) {
  const Vec3d n = std::sin(angle / 2) / length(axis) * axis;
  return {n.x, n.y, n.z, std::cos(angle / 2)};
}

/// Turns what hangs below the node: before its scale, after its own rotation.
void turn_place(NodePlace& place, const Value& rotation) {
  if (place.matrix)
    place.matrix =
        *place.matrix * Affine::rotation(rotation[0], rotation[1], rotation[2], rotation[3]);
  else
    place.rotation = product(normalized(place.rotation), rotation);
}

void apply(const Track& track, double seconds, NodePlace& place) {
  if (track.channel == Channel::weights) return;
  const Value v = track.at(seconds);
  switch (track.channel) {
    case Channel::translation:
      if (place.matrix)
        for (std::size_t r = 0; r < 3; ++r) place.matrix->m[r][3] = v[r];
      place.translation = {v[0], v[1], v[2]};
      break;
    case Channel::rotation:
      place.rotation = v;
      break;
    case Channel::scale:
      place.scale = {v[0], v[1], v[2]};
      break;
    case Channel::angle:
      turn_place(place, turn(track.axis, v[0]));
      break;
    case Channel::weights:
      break;
  }
}

}  // namespace

std::size_t components(Channel channel) {
  if (channel == Channel::angle || channel == Channel::weights) return 1;
  return channel == Channel::rotation ? 4 : 3;
}

std::array<double, 4> Track::at(double seconds) const { return Sampler(*this).at(seconds); }

std::vector<double> Track::weights_at(double seconds) const {
  std::vector<double> weights;
  for (std::size_t w = 0; w < count; ++w) weights.push_back(Sampler(*this, w).at(seconds)[0]);
  return weights;
}

Poser::Poser(Rig rig, Motion motion, std::vector<Affine> rest)
    : rig_(std::move(rig)), motion_(std::move(motion)), rest_(std::move(rest)) {
  // Angles turn what the other channels give.
  std::stable_sort(motion_.tracks.begin(), motion_.tracks.end(),
                   [](const Track& a, const Track& b) { return a.channel < b.channel; });
  check_tracks();
  moves_.resize(rig_.nodes.size());
  for (const Track& track : motion_.tracks)
    if (track.channel != Channel::weights) moves_[track.node] = true;
  for (const RigNode& node : rig_.nodes) rest_places_.push_back(node.rest);
  for (const std::uint32_t n : rig_.order) {
    const std::uint32_t parent = rig_.nodes[n].parent;
    if (parent != RigNode::kNoParent && moves_[parent]) moves_[n] = true;
  }
  for (std::uint32_t i = 0; i < rig_.mounts.size(); ++i)
    if (rig_.mounts[i] && moves_[rig_.mounts[i]->node]) moving_.push_back(i);
}

std::string Poser::place_of(std::uint32_t node) const {
  const std::string& name = rig_.nodes[node].name;
  return "node " + std::to_string(node) + (name.empty() ? "" : " '" + name + "'");
}

void Poser::check_tracks() const {
  std::set<std::pair<std::uint32_t, Channel>> known;
  for (const Track& track : motion_.tracks) {
    const auto refuse = [&](const char* reason) {
      throw Error(ErrorCode::bad_input, reason, motion_.source, place_of(track.node));
    };
    if (!known.insert({track.node, track.channel}).second)
      refuse("two tracks move the same channel of it");
    const bool replaces = track.channel == Channel::rotation || track.channel == Channel::scale;
    if (replaces && rig_.nodes[track.node].rest.matrix)
      refuse("it is placed by a matrix, which has no rotation and scale to move");
  }
}

std::vector<Affine> Poser::nodes_at(double seconds) const {
  const FpEnvGuard environment;
  std::vector<NodePlace> places = rest_places_;
  for (const Track& track : motion_.tracks) apply(track, seconds, places[track.node]);
  return rig_.to_world(places);
}

const Track* Poser::weights_of(std::uint32_t node) const {
  for (const Track& track : motion_.tracks)
    if (track.channel == Channel::weights && track.node == node) return &track;
  return nullptr;
}

std::vector<Affine> Poser::at(double seconds) const {
  const FpEnvGuard environment;
  const std::vector<Affine> world = nodes_at(seconds);
  std::vector<Affine> pose = rest_;
  for (const std::uint32_t i : moving_) {
    pose[i] = world[rig_.mounts[i]->node] * rig_.mounts[i]->copy;
    if (!is_well_conditioned(pose[i]))
      throw Error(ErrorCode::bad_input,
                  "at " + std::to_string(seconds) +
                      " s its transformation is singular or nearly so (condition above 2^30)",
                  motion_.source, place_of(rig_.mounts[i]->node));
  }
  return pose;
}

}  // namespace strahl

// io/motion.h - how the nodes of a rig move over time, and where that puts the instances.
//
// Source: the animations of glTF 2.0 (Khronos specification, appendix C: step, linear, cubic
//   spline; rotations by the shorter arc), and joints that turn by an angle about a fixed axis.
// Layout: a track per node and channel; times ascend; values are packed, for cubic splines three
//   per time (tangent in, value, tangent out).
// Invariants: at most one track per node and channel; before the first and after the last time the
//   end values hold.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <strahl/io/rig.h>

namespace strahl {

enum class Channel : std::uint8_t { translation, rotation, scale, angle, weights };
enum class Interpolation : std::uint8_t { linear, step, cubic_spline };

/// Numbers per value: 3, 4 (x, y, z, w), 3, 1 (radians); of weights as many as the track says.
std::size_t components(Channel channel);

struct Track {
  std::uint32_t node = 0;
  Channel channel = Channel::translation;
  Interpolation interpolation = Interpolation::linear;
  Vec3d axis{0, 0, 1};        ///< of angle, in the node's own space; any length but 0
  std::size_t count = 0;      ///< of weights: how many
  std::vector<double> times;  ///< seconds, at least one, strictly ascending
  std::vector<double> values;

  /// The value at a time; rotations are of unit length.
  std::array<double, 4> at(double seconds) const;
  std::vector<double> weights_at(double seconds) const;
};

/// One animation.
struct Motion {
  std::string name;
  std::vector<Track> tracks;
  double duration = 0.0;  ///< seconds
  std::string source;     ///< for messages
};

/// Places the instances of a rig at any time.
class Poser {
 public:
  /// Throws Error{bad_input}: two tracks for one channel of a node; a rotation or scale of a node
  ///   placed by a matrix, which has none to replace.
  Poser(Rig rig, Motion motion, std::vector<Affine> rest);

  double duration() const { return motion_.duration; }
  /// Instances that move at all.
  std::size_t moving() const { return moving_.size(); }

  /// World transform of every instance: of those that do not move, as given. O(instances + nodes).
  /// Throws Error{bad_input} naming node and time where a transform is singular or nearly so.
  std::vector<Affine> at(double seconds) const;

  /// Whether the node or one above it is moved.
  bool moves(std::uint32_t node) const { return moves_[node]; }
  /// World transforms of all nodes.
  std::vector<Affine> nodes_at(double seconds) const;
  /// What blends the shapes of a node's mesh; null where nothing does.
  const Track* weights_of(std::uint32_t node) const;

 private:
  void check_tracks() const;
  std::string place_of(std::uint32_t node) const;

  Rig rig_;
  Motion motion_;
  std::vector<Affine> rest_;            ///< per instance
  std::vector<NodePlace> rest_places_;  ///< per node
  std::vector<std::uint32_t> moving_;   ///< instances
  std::vector<bool> moves_;             ///< per node
};

}  // namespace strahl

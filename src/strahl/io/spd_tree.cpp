// io/spd_tree.cpp - SPD "tree": a branch ends in a ball and two smaller branches.
#include <strahl/io/spd.h>
#include <strahl/io/spd_parts.h>

namespace strahl {
namespace {

constexpr double kTaper = 0.67;  // of the radius, from one end of a branch to the other

struct Tree {
  NffScene& scene;
  Affine first_child, second_child;

  // The branch from (0,0,0) to (0,0,1) of the local frame and all that grows on it.
  void add(int levels, const Affine& frame, double thickness) {
    const Vec3d base = frame.point({0, 0, 0}), tip = frame.point({0, 0, 1});
    const double radius = 0.15 * thickness, tip_radius = radius * kTaper;
    scene.add_cone({base, radius, tip, tip_radius});
    scene.add_sphere(tip, tip_radius);
    if (levels == 0) return;
    add(levels - 1, frame * first_child, thickness * kTaper);
    add(levels - 1, frame * second_child, thickness * kTaper);
  }
};

// A branch on the tip of its parent: made shorter, tilted about x, turned about z.
Affine child_frame(double length, double tilt_degrees, double turn_degrees) {
  const auto radians = [](double degrees) { return degrees * spd::kPi / 180.0; };
  return Affine::translation({0, 0, 1}) * spd::rotation(2, radians(turn_degrees)) *
         spd::rotation(0, radians(tilt_degrees)) * Affine::scaling(Vec3d::all(length));
}

}  // namespace

NffScene spd_tree(int size) {
  NffScene scene = spd::stage({4.5, 0.4, 2.0}, {0, 0, 1.5}, {0, 0, 1}, 45.0, 1.0,
                              {{-5, 5, 50},
                               {30, -30, 30},
                               {-40, -30, 20},
                               {10, 30, 40},
                               {-30, 40, 10},
                               {50, 25, 20},
                               {-10, -60, 30}});
  scene.add_fill({{0.2, 0.7, 0.2}, 1.0, 0.0, spd::kDull, 0.0, 0.0});
  spd::add_ground(scene, 50.0, 0.0);
  scene.add_fill({{0.55, 0.4, 0.2}, 1.0, 0.0, spd::kDull, 0.0, 0.0});
  Tree{scene, child_frame(0.65, 40.0, 90.0), child_frame(0.70, 25.0, 230.0)}.add(size, Affine{},
                                                                                 1.0);
  return scene;
}

}  // namespace strahl

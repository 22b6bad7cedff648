// structures/two_level/two_level_test.cpp - sharing, moving, limits, and planted faults.
#include <cmath>
#include <tests/support/against_brute.h>
#include <tests/support/mesh_maker.h>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/structures/two_level/run_level.h>
#include <strahl/structures/two_level/two_level.h>

namespace strahl {

class TwoLevelBreaker {
 public:
  static void keep_old_top(TwoLevel& built, const Scene& pose) {
    built.instances_ = InstanceSource(pose, built.instances_);
  }
  static void keep_old_places(TwoLevel& built, const Scene& pose) {
    built.top_ = built.make_top(InstanceSource(pose), {});
  }
  static void swap_levels(TwoLevel& built) { std::swap(built.level_of_[0], built.level_of_[1]); }
  static void forget_level(TwoLevel& built) { built.level_of_.pop_back(); }
  static void swap_levels(RunLevel& built) { std::swap(built.level_of_[0], built.level_of_[1]); }
  static void shift_runs(RunLevel& built) { ++built.starts_[1]; }
};

namespace {

using test::point_in;

/// Two objects, one of triangles and spheres; 24 instances of the one or the other.
SceneData two_objects() {
  SceneData data;
  data.geometries = {test::soup(400, 0.3, 1).geometry(), {}, test::walls(4, 0.4, {}).geometry()};
  data.geometries[1].kind = PrimitiveKind::sphere;
  Rng rng(8);
  for (int i = 0; i < 100; ++i)
    data.geometries[1].spheres.push_back(
        {{rng.uniform(), rng.uniform(), rng.uniform()}, 0.05 * rng.uniform()});
  for (std::uint32_t g = 0; g < 3; ++g) data.geometries[g].geometry_id = 10 * g;
  const std::uint32_t first = 2;
  for (std::uint32_t i = 0; i < 24; ++i) {
    const Vec3d at{3.0 * (i % 6), 3.0 * (i / 6), 0.1 * i};
    const Affine map =
        Affine::translation(at) * Affine::rotation(0, 0, std::sin(0.1 * i), std::cos(0.1 * i));
    data.instances.push_back(i % 2 ? Instance{0, first, map, i}
                                   : Instance{first, 1, map * Affine::scaling({-1, 2, 1}), i});
  }
  return data;
}

std::shared_ptr<const Scene> scene() {
  static const auto made = std::make_shared<const Scene>(two_objects());
  return made;
}

/// Places of the instances after some seconds; every third stays.
std::vector<Affine> places(double seconds) {
  std::vector<Affine> maps;
  for (std::uint32_t i = 0; i < scene()->instances().size(); ++i) {
    const Affine& rest = scene()->instances()[i].to_world;
    const Affine turn = Affine::rotation(std::sin(seconds), 0, 0, std::cos(seconds));
    maps.push_back(i % 3 == 0 ? rest
                              : Affine::translation({seconds * i, -seconds, 0}) * rest * turn);
  }
  return maps;
}

std::shared_ptr<const Scene> pose(double seconds) {
  return std::make_shared<const Scene>(scene()->posed(places(seconds)));
}

/// The same pose as a file would hold it.
std::shared_ptr<const Scene> fresh(double seconds) {
  SceneData data = two_objects();
  const std::vector<Affine> maps = places(seconds);
  for (std::size_t i = 0; i < maps.size(); ++i) data.instances[i].to_world = maps[i];
  return std::make_shared<const Scene>(std::move(data));
}

std::vector<Ray> rays_of(const Scene& of, int count) {
  Rng rng(5);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3d from = point_in(of.total_bounds(), rng);
    rays.push_back({from, point_in(of.total_bounds(), rng) - from});
  }
  return rays;
}

void expect_same_hits(const Accelerator& got, const Accelerator& expected) {
  const std::vector<Ray> rays = rays_of(expected.scene(), 2000);
  const AllHits a = test::all_hits(got, make_batch(rays)),
                b = test::all_hits(expected, make_batch(rays));
  ASSERT_EQ(a.splits, b.splits);
  ASSERT_GT(b.hits.size(), rays.size() / 2);
  for (std::size_t i = 0; i < b.hits.size(); ++i)
    ASSERT_TRUE(test::same_bits(a.hits[i], b.hits[i]));
}

std::string error_of_spec(const std::string& spec) {
  try {
    build(std::make_shared<const Scene>(SceneData{}), spec);
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

TEST(TwoLevel, BuildsEachObjectOnce) {
  SceneData data = two_objects();
  const auto all = build(scene(), "two_level");
  data.instances.resize(2);
  const auto two = build(std::make_shared<const Scene>(std::move(data)), "two_level");
  EXPECT_LT(all->report().bytes, two->report().bytes + 24 * 120);
  EXPECT_LT(all->report().references, two->report().references + 24);
  EXPECT_LT(all->report().bytes * 5, build(scene(), "bvh")->report().bytes);
}

TEST(TwoLevel, AMistakeInAnInnerSpecIsAnErrorEvenWithoutInstances) {
  EXPECT_NE(error_of_spec("two_level:top=tree").find("unknown structure 'tree'"),
            std::string::npos);
  EXPECT_NE(error_of_spec("two_level:bottom=tree").find("unknown structure 'tree'"),
            std::string::npos);
  EXPECT_NE(error_of_spec("two_level:bottom=(grid:speed=3)").find("speed"), std::string::npos);
  EXPECT_NE(
      error_of_spec("two_level:bottom=(two_level:bottom=(bvh:leaf_size=0))").find("leaf_size"),
      std::string::npos);
  EXPECT_EQ(error_of_spec("two_level:top=grid,bottom=(kd_tree:split=sah_sweep)"), "accepted");
}

TEST(TwoLevel, SpecNamesBothLevels) {
  EXPECT_EQ(build(scene(), "two_level:bottom=(bvh),top=(grid)")->spec(), "two_level:top=grid");
  EXPECT_EQ(build(scene(), "two_level:bottom=(bvh:leaf_size=2)")->spec(),
            "two_level:bottom=(bvh:leaf_size=2)");
}

TEST(TwoLevel, MovingGivesWhatABuildOverThePoseGives) {
  for (const char* spec : {"two_level", "two_level:top=grid,bottom=kd_tree",
                           "two_level:top=(two_level:top=grid),bottom=two_level"}) {
    const auto moving = build(scene(), spec);
    for (const double seconds : {0.3, 2.0, 0.0, -7.5}) {
      SCOPED_TRACE(seconds);
      const auto at = pose(seconds);
      moving->update(at, {});
      EXPECT_EQ(&moving->scene(), at.get());
      ASSERT_NO_THROW(moving->validate());
      EXPECT_EQ(moving->tree_hash(), build(at, spec)->tree_hash());
      expect_same_hits(*moving, *build(fresh(seconds), "bvh"));
    }
  }
}

TEST(TwoLevel, MovesOnlyToPosesOfItsScene) {
  const auto moving = build(scene(), "two_level");
  EXPECT_THROW(moving->update(fresh(1.0), {}), Error);
  expect_same_hits(*moving, *build(scene(), "bvh"));
  EXPECT_THROW(build(scene(), "kd_tree")->update(pose(1.0), {}), Error);
}

TEST(TwoLevel, AFailedMoveChangesNothing) {
  const auto moving = build(scene(), "two_level");
  BuildContext context;
  context.memory_limit = moving->report().bytes / 2;
  EXPECT_THROW(moving->update(pose(1.0), context), Error);
  EXPECT_EQ(&moving->scene(), scene().get());
  ASSERT_NO_THROW(moving->validate());
  expect_same_hits(*moving, *build(scene(), "bvh"));
}

TEST(TwoLevel, MemoryIsThatOfBothLevels) {
  const std::uint64_t bytes = build(scene(), "two_level")->report().bytes;
  BuildContext context;
  context.memory_limit = 16 * bytes;  // a build needs more than what it leaves
  const auto limited = build(scene(), "two_level", context);
  EXPECT_EQ(limited->report().bytes, bytes);
  EXPECT_EQ(limited->tree_hash(), build(scene(), "two_level")->tree_hash());
  context.memory_limit = bytes - 1;
  EXPECT_THROW(build(scene(), "two_level", context), Error);
}

TEST(TwoLevel, ThreadsDoNotChangeLevels) {
  BuildContext two;
  two.executor = Executor::with_threads(2);
  for (const char* spec : {"two_level", "two_level:bottom=(two_level:bottom=grid)"})
    EXPECT_EQ(build(scene(), spec, two)->tree_hash(), build(scene(), spec)->tree_hash());
}

TEST(TwoLevel, ProgressOfTheBottomsNeverGoesBack) {
  double last = 0.0;
  int calls = 0, backwards = 0;
  BuildContext context;
  context.progress = [&](double fraction, std::string_view) {
    backwards += fraction < last;
    last = fraction;
    return ++calls > 0;
  };
  const auto built = build(scene(), "two_level", context);
  EXPECT_GT(calls, 2);
  EXPECT_LE(backwards, 1) << "the top begins anew";
}

TEST(TwoLevel, CountsTheWorkOfBothLevels) {
  const std::vector<Ray> rays = rays_of(*scene(), 500);
  const Counters both = test::work_of(*build(scene(), "two_level"), rays);
  const Counters lists =
      test::work_of(*build(scene(), "two_level:top=brute_force,bottom=brute_force"), rays);
  EXPECT_EQ(lists.primitives, rays.size() * scene()->size());
  EXPECT_GT(both.primitives, 0u);
  EXPECT_LT(both.primitives * 5, lists.primitives);
  EXPECT_GT(both.traversal_steps, rays.size());
}

// --- planted faults ---

TwoLevel levels() { return TwoLevel(*scene(), {}, {}, &build_level); }

TEST(TwoLevel, ValidateFindsPlantedFaults) {
  const auto moved = pose(1.0);
  ASSERT_NO_THROW(levels().validate(*scene()));
  TwoLevel stale_top = levels();
  TwoLevelBreaker::keep_old_top(stale_top, *moved);
  EXPECT_THROW(stale_top.validate(*moved), std::logic_error);
  TwoLevel stale_places = levels();
  TwoLevelBreaker::keep_old_places(stale_places, *moved);
  EXPECT_THROW(stale_places.validate(*moved), std::logic_error);
  TwoLevel swapped = levels();
  TwoLevelBreaker::swap_levels(swapped);
  EXPECT_THROW(swapped.validate(*scene()), std::logic_error);
  TwoLevel short_of_one = levels();
  TwoLevelBreaker::forget_level(short_of_one);
  EXPECT_THROW(short_of_one.validate(*scene()), std::logic_error);
}

TEST(RunLevel, ValidateFindsPlantedFaults) {
  const RunLevel sound(*scene(), {}, {}, &build_level);
  ASSERT_NO_THROW(sound.validate(*scene()));
  RunLevel swapped(*scene(), {}, {}, &build_level);
  TwoLevelBreaker::swap_levels(swapped);
  EXPECT_THROW(swapped.validate(*scene()), std::logic_error);
  RunLevel shifted(*scene(), {}, {}, &build_level);
  TwoLevelBreaker::shift_runs(shifted);
  EXPECT_THROW(shifted.validate(*scene()), std::logic_error);
}

}  // namespace
}  // namespace strahl

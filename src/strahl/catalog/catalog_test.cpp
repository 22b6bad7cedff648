#include <set>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>

namespace strahl {
namespace {

std::string refusal(std::string_view text) {
  try {
    parse_spec(text);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::usage);
    return e.what();
  }
  return "accepted";
}

std::shared_ptr<const Scene> square() {
  SceneData data;
  data.geometries.emplace_back();
  data.geometries[0].mesh =
      make_mesh(std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3});
  return std::make_shared<const Scene>(std::move(data));
}

TEST(Spec, NamesAndOptionsAreTakenApart) {
  const Spec spec = parse_spec("two_level:top=grid,bottom=(kd_tree:split=sah_sweep,bins=8)");
  EXPECT_EQ(spec.name, "two_level");
  ASSERT_EQ(spec.options.size(), 2u);
  EXPECT_EQ(spec.options[0].value, "grid");
  EXPECT_EQ(spec.options[1].key, "bottom");
  EXPECT_EQ(spec.options[1].value, "(kd_tree:split=sah_sweep,bins=8)");
}

TEST(Spec, MistakesAreNamedWithTheirColumn) {
  EXPECT_EQ(refusal(""), "SPEC '': column 1: expected the name of a structure");
  EXPECT_EQ(refusal("Grid"), "SPEC 'Grid': column 1: expected the name of a structure");
  EXPECT_EQ(refusal("grid:"), "SPEC 'grid:': column 6: expected key=value");
  EXPECT_EQ(refusal("grid:a"), "SPEC 'grid:a': column 6: expected key=value");
  EXPECT_EQ(refusal("grid:a=1,a=2"), "SPEC 'grid:a=1,a=2': column 10: option 'a' is given twice");
  EXPECT_EQ(refusal("grid:a=(b"), "SPEC 'grid:a=(b': column 8: this parenthesis is never closed");
  EXPECT_EQ(refusal("grid a"), "SPEC 'grid a': column 5: expected ':' and options after the name");
  EXPECT_EQ(refusal("grid:a=1;"), "SPEC 'grid:a=1;': column 9: expected ',' or the end");
}

TEST(Spec, ListsSplitOnCommasThatStartANewStructure) {
  EXPECT_EQ(
      split_specs("grid:a=1,b=2,bvh,two_level:top=(kd_tree:x=1,y=2),c=3"),
      (std::vector<std::string>{"grid:a=1,b=2", "bvh", "two_level:top=(kd_tree:x=1,y=2),c=3"}));
  EXPECT_TRUE(split_specs("").empty());
}

TEST(Catalog, NamesAreUniqueAndDescribed) {
  std::set<std::string> names;
  for (const StructureEntry& entry : all_structures()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_FALSE(std::string(entry.title).empty());
    for (const OptionInfo& option : entry.options())
      EXPECT_FALSE(option.help.empty()) << option.name;
  }
  EXPECT_TRUE(names.count("brute_force"));
  EXPECT_TRUE(names.count(std::string(kDefaultSpec)));
}

TEST(Catalog, UnknownStructuresAndOptionsAreUsageErrors) {
  const auto code = [](std::string_view spec) {
    try {
      build(square(), spec);
    } catch (const Error& e) {
      return e.code();
    }
    return ErrorCode::unsupported;
  };
  EXPECT_EQ(code("no_such"), ErrorCode::usage);
  EXPECT_EQ(code("bvh:no_such=1"), ErrorCode::usage);
  EXPECT_EQ(code("bvh:leaf_size=0"), ErrorCode::usage);
}

TEST(Catalog, TheSpecOfAnAcceleratorIsCanonical) {
  EXPECT_EQ(build(square(), "bvh:leaf_size=4")->spec(), "bvh");
  EXPECT_EQ(build(square(), "bvh:leaf_size=7")->spec(), "bvh:leaf_size=7");
}

class EveryStructure : public testing::TestWithParam<std::string> {};

TEST_P(EveryStructure, HonoursCancelAndMemoryLimit) {
  SceneData data;
  data.geometries.emplace_back();
  std::vector<Vec3f> v;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < 60000; ++i) {
    v.push_back({float(i % 251), float(i % 241), float(i % 239)});
    indices.push_back(i);
  }
  data.geometries[0].mesh = make_mesh(std::move(v), std::move(indices));
  const auto scene = std::make_shared<const Scene>(std::move(data));
  BuildContext cancelling;
  int calls = 0;
  cancelling.progress = [&](double fraction, std::string_view stage) {
    EXPECT_GE(fraction, 0.0);
    EXPECT_LE(fraction, 1.0);
    EXPECT_FALSE(stage.empty());
    return ++calls < 2;
  };
  try {
    build(scene, GetParam(), cancelling);
    ADD_FAILURE() << "was not cancelled";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::cancelled);
  }
  BuildContext limited;
  limited.memory_limit = 10000;
  try {
    build(scene, GetParam(), limited);
    ADD_FAILURE() << "passed the memory limit";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::resource);
  }
}

TEST_P(EveryStructure, ReportsWhatItBuilt) {
  const auto accelerator = build(square(), GetParam());
  const BuildReport report = accelerator->report();
  EXPECT_GE(report.nodes, report.leaves);
  EXPECT_GE(report.references, 2u);
  EXPECT_GT(report.bytes, 0u);
  EXPECT_GE(report.seconds, 0.0);
  EXPECT_GT(report.sah_cost, 0.0);
}

TEST_P(EveryStructure, RefusesToMoveVerticesUntilItCan) {
  const auto accelerator = build(square(), GetParam());
  EXPECT_THROW(accelerator->update(square(), {}), Error);
}

std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const StructureEntry& entry : all_structures()) list.emplace_back(entry.name);
  return list;
}
INSTANTIATE_TEST_SUITE_P(Catalogue, EveryStructure, testing::ValuesIn(names()),
                         [](const auto& p) { return p.param; });

}  // namespace
}  // namespace strahl

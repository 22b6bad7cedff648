// The matrix of SPECs covers what it claims to.
#include <algorithm>
#include <set>
#include <tests/conformance/variants.h>

#include <gtest/gtest.h>

namespace strahl::test {
namespace {

std::vector<OptionInfo> toy_options() {
  const auto word = [](const char* name, std::vector<std::string> values) {
    OptionInfo info;
    info.name = name, info.type = "enum", info.default_value = values[0];
    info.values = std::move(values);
    return info;
  };
  OptionInfo number;
  number.name = "n", number.type = "int";
  number.default_value = "8", number.min = "1", number.max = "1024";
  return {word("a", {"x", "y", "z"}), word("b", {"on", "off"}), number, word("c", {"p", "q"})};
}

const StructureEntry kToy{"toy", "", &toy_options, nullptr};

/// The choices a SPEC makes, defaults included.
std::vector<std::string> choices(const std::string& spec) {
  std::vector<std::string> all;
  const Spec parsed = parse_spec(spec);
  for (const OptionInfo& info : toy_options()) {
    std::string value = info.default_value;
    for (const OptionValue& given : parsed.options)
      if (given.key == info.name) value = given.value;
    all.push_back(info.name + "=" + value);
  }
  return all;
}

std::set<std::vector<std::string>> tuples_of(const std::vector<std::string>& specs,
                                             std::size_t strength) {
  std::set<std::vector<std::string>> tuples;
  for (const std::string& spec : specs) {
    const std::vector<std::string> all = choices(spec);
    std::vector<bool> chosen(all.size());
    std::fill_n(chosen.begin(), strength, true);
    do {
      std::vector<std::string> tuple;
      for (std::size_t i = 0; i < all.size(); ++i)
        if (chosen[i]) tuple.push_back(all[i]);
      tuples.insert(tuple);
    } while (std::prev_permutation(chosen.begin(), chosen.end()));
  }
  return tuples;
}

// Values: a 3, b 2, n 4 (8, 1, 2 or so, and one above), c 2.
TEST(Variants, CoveringHoldsEveryPairAndTriple) {
  EXPECT_EQ(tuples_of(covering(kToy, 2), 2).size(), 3u * 2 + 3 * 4 + 3 * 2 + 2 * 4 + 2 * 2 + 4 * 2);
  EXPECT_EQ(tuples_of(covering(kToy, 3), 3).size(), 3u * 2 * 4 + 3 * 2 * 2 + 3 * 4 * 2 + 2 * 4 * 2);
  EXPECT_LE(covering(kToy, 2).size(), 14u);
  EXPECT_EQ(covering(kToy, 4).size(), 3u * 2 * 4 * 2);
}

TEST(Variants, OneAtATimeNamesEveryValueOnce) {
  const std::vector<std::string> specs = one_at_a_time(kToy);
  EXPECT_EQ(specs.size(), 1u + 2 + 1 + 3 + 1);
  EXPECT_EQ(specs.front(), "toy");
  EXPECT_EQ(std::set<std::string>(specs.begin(), specs.end()).size(), specs.size());
}

TEST(Variants, FullProductHoldsAllWordsWithTwoNumbers) {
  const std::vector<std::string> specs = full_product(kToy, 100);
  EXPECT_EQ(std::set<std::string>(specs.begin(), specs.end()).size(), 3u * 2 * 2 * 2);
  EXPECT_TRUE(full_product(kToy, 23).empty());
}

TEST(Variants, AStructureWithoutOptionsHasOneSpec) {
  const auto none = [] { return std::vector<OptionInfo>{}; };
  const StructureEntry bare{"bare", "", none, nullptr};
  EXPECT_EQ(one_at_a_time(bare), std::vector<std::string>{"bare"});
  EXPECT_EQ(full_product(bare, 10), std::vector<std::string>{"bare"});
  EXPECT_TRUE(covering(bare, 2).empty());
}

}  // namespace
}  // namespace strahl::test

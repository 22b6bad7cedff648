// The matrix of SPECs covers what it claims to.
#include <algorithm>
#include <cstdlib>
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

OptionInfo whole_number(const char* name, const char* first, const char* standard,
                        const char* last) {
  OptionInfo info;
  info.name = name, info.type = "int";
  info.min = first, info.default_value = standard, info.max = last;
  return info;
}

TEST(Variants, FewNumbersAreAllTriedAndOfMoreTheLast) {
  const auto options = [] {
    return std::vector{whole_number("few", "0", "0", "3"), whole_number("more", "1", "3", "8"),
                       whole_number("depth", "0", "0", "64"), whole_number("size", "1", "8", "99")};
  };
  const StructureEntry entry{"numbers", "", +options, nullptr};
  EXPECT_EQ(outer_values(entry).size(), 3u + 7 + 1);
  EXPECT_EQ(std::ranges::count(outer_values(entry), "numbers:depth=64"), 1);
  EXPECT_EQ(std::ranges::count(one_at_a_time(entry), "numbers:few=2"), 1);
}

/// Values of an option that a matrix which names all has to name.
std::set<std::string> values_to_try(const OptionInfo& info) {
  std::set<std::string> values(info.values.begin(), info.values.end());
  values.insert(info.default_value);
  if (info.min.empty()) return values;
  values.insert(info.min);
  const double first = std::strtod(info.min.c_str(), nullptr),
               last = std::strtod(info.max.c_str(), nullptr);
  if (info.type == "double" || last - first > 64) return values;
  values.insert(info.max);
  for (double value = first; last - first < 9 && value < last; ++value)
    values.insert(std::to_string(static_cast<int>(value)));
  return values;
}

/// Values of an option in SPECs, its default where they do not name it.
std::set<std::string> values_tried(const OptionInfo& info, const std::vector<std::string>& specs) {
  std::set<std::string> values;
  for (const std::string& spec : specs) {
    std::string value = info.default_value;
    for (const OptionValue& given : parse_spec(spec).options)
      if (given.key == info.name) value = given.value;
    values.insert(value);
  }
  return values;
}

/// Of the quick matrix and of what the full one adds to it for the scene files.
TEST(Variants, EveryListedOptionValueIsInTheMatrix) {
  for (const StructureEntry& entry : all_structures()) {
    for (std::vector<std::string> specs : {covering(entry, 2), one_at_a_time(entry)}) {
      for (const std::string& spec : outer_values(entry)) specs.push_back(spec);
      for (const OptionInfo& info : entry.options()) {
        const std::set<std::string> tried = values_tried(info, specs);
        for (const std::string& value : values_to_try(info))
          EXPECT_TRUE(tried.contains(value)) << entry.name << ':' << info.name << '=' << value;
      }
    }
  }
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

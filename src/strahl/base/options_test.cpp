// base/options_test.cpp - option tables: what is read, refused, described and printed.
#include <clocale>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/base/options.h>

namespace strahl {
namespace {

enum class Rule { woo, cubic };

struct SampleOptions {
  double density = 3.0;
  bool mailbox = true;
  int max_cells = 1000;
  std::uint64_t budget = 0;
  Rule rule = Rule::woo;
  std::string top = "bvh";
  double shift = 0.0;
};

OptionTable<SampleOptions> option_fields(const SampleOptions*) {
  return {option("density", &SampleOptions::density, 0.001, 1000.0, "cells per primitive"),
          option("mailbox", &SampleOptions::mailbox, "test each primitive once per ray"),
          option("max_cells", &SampleOptions::max_cells, 1, 4096, "cells along an axis"),
          option("budget", &SampleOptions::budget, "bytes"),
          option("rule", &SampleOptions::rule, {{"woo", Rule::woo}, {"cubic", Rule::cubic}},
                 "how many cells"),
          option_spec("top", &SampleOptions::top, "structure above"),
          option("shift", &SampleOptions::shift, "any number")};
}

struct NoOptions {};

OptionTable<NoOptions> option_fields(const NoOptions*) { return {}; }

using Pairs = std::vector<OptionValue>;

SampleOptions parse(const Pairs& given) { return parse_options<SampleOptions>(given, "sample"); }

std::string refusal(const Pairs& given) {
  try {
    parse(given);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "accepted";
}

TEST(Options, KeepDefaultsForWhatIsNotGiven) {
  const SampleOptions options = parse({});
  EXPECT_EQ(options.density, 3.0);
  EXPECT_TRUE(options.mailbox);
  EXPECT_EQ(options.top, "bvh");
}

TEST(Options, ReadEveryType) {
  const SampleOptions options = parse({{"rule", "cubic"},
                                       {"density", "2.5e1"},
                                       {"mailbox", "off"},
                                       {"max_cells", "64"},
                                       {"budget", "18446744073709551615"},
                                       {"top", "(kd_tree:split=sah_sweep)"},
                                       {"shift", "-1e-300"}});
  EXPECT_EQ(options.density, 25.0);
  EXPECT_FALSE(options.mailbox);
  EXPECT_EQ(options.max_cells, 64);
  EXPECT_EQ(options.budget, 18446744073709551615u);
  EXPECT_EQ(options.rule, Rule::cubic);
  EXPECT_EQ(options.top, "kd_tree:split=sah_sweep");
  EXPECT_EQ(options.shift, -1e-300);
}

TEST(Options, ReadSwitchesInThreeSpellings) {
  for (const char* on : {"on", "true", "1"}) EXPECT_TRUE(parse({{"mailbox", on}}).mailbox) << on;
  for (const char* off : {"off", "false", "0"}) {
    EXPECT_FALSE(parse({{"mailbox", off}}).mailbox) << off;
  }
  EXPECT_EQ(refusal({{"mailbox", "yes"}}), "sample.mailbox: got 'yes', expected one of on, off");
}

TEST(Options, AcceptTheEndsOfARangeAndRefuseWhatLiesOutside) {
  EXPECT_EQ(parse({{"max_cells", "1"}}).max_cells, 1);
  EXPECT_EQ(parse({{"max_cells", "4096"}}).max_cells, 4096);
  EXPECT_EQ(parse({{"density", "1000"}}).density, 1000.0);
  EXPECT_EQ(refusal({{"max_cells", "0"}}),
            "sample.max_cells: got '0', expected a whole number in 1..4096");
  EXPECT_EQ(refusal({{"max_cells", "4097"}}),
            "sample.max_cells: got '4097', expected a whole number in 1..4096");
  EXPECT_EQ(refusal({{"density", "1000.0001"}}),
            "sample.density: got '1000.0001', expected a number in 0.001..1000");
}

TEST(Options, RefuseTextThatIsNotWhollyANumber) {
  for (const char* bad : {"", "x", "3x", " 3", "3 ", "+3", "3,0", "nan", "inf", "-inf", "1e999",
                          "0x10", "infinity"}) {
    EXPECT_NE(refusal({{"density", bad}}), "accepted") << bad;
    EXPECT_NE(refusal({{"shift", bad}}), "accepted") << bad;
  }
  for (const char* bad : {"", "1.0", "1e3", "99999999999", "-1", "3x"}) {
    EXPECT_NE(refusal({{"max_cells", bad}}), "accepted") << bad;
  }
  for (const char* bad : {"-1", "18446744073709551616", "1.5"}) {
    EXPECT_NE(refusal({{"budget", bad}}), "accepted") << bad;
  }
}

TEST(Options, RefuseInfinityEvenWhereTheRangeHasNoEnd) {
  double value = 7;
  EXPECT_FALSE(option_detail::read("inf", value));
  EXPECT_FALSE(option_detail::read("nan", value));
  EXPECT_EQ(value, 7);
}

TEST(Options, NameTheWordsOfAnEnumWhenItIsNotOneOfThem) {
  EXPECT_EQ(refusal({{"rule", "wooo"}}), "sample.rule: got 'wooo', expected one of woo, cubic");
}

TEST(Options, NameTheKnownOptionsForAnUnknownOne) {
  EXPECT_EQ(refusal({{"dens", "3"}}),
            "sample: unknown option 'dens'; known options: density, mailbox, max_cells, budget, "
            "rule, top, shift");
  const Pairs given{{"n", "1"}};
  try {
    parse_options<NoOptions>(given, "none");
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "none: unknown option 'n'; it takes no options");
  }
}

TEST(Options, RefuseAKeyGivenTwiceEvenWithTheSameValue) {
  EXPECT_EQ(refusal({{"density", "3"}, {"mailbox", "on"}, {"density", "3"}}),
            "sample.density: given more than once");
}

TEST(Options, RefuseSpecsThatAreNotOne) {
  for (const char* bad : {"", "()", "(bvh", "bvh)", "(a)(b)", ")(", "Bvh", "b vh", "(bvh)x", "1bvh",
                          "a:b=(c", ",a"}) {
    EXPECT_NE(refusal({{"top", bad}}), "accepted") << bad;
  }
  EXPECT_EQ(parse({{"top", "grid"}}).top, "grid");
  EXPECT_EQ(parse({{"top", "(grid)"}}).top, "grid");
  EXPECT_EQ(parse({{"top", "(two_level:top=(grid:n=3),bottom=bih)"}}).top,
            "two_level:top=(grid:n=3),bottom=bih");
}

TEST(Options, DescribeTheTableWithDefaultsOfTheStruct) {
  const std::vector<OptionInfo> infos = describe_options<SampleOptions>();
  ASSERT_EQ(infos.size(), 7u);
  EXPECT_EQ(infos[0].name, "density");
  EXPECT_EQ(infos[0].type, "double");
  EXPECT_EQ(infos[0].default_value, "3");
  EXPECT_EQ(infos[0].min, "0.001");
  EXPECT_EQ(infos[0].max, "1000");
  EXPECT_EQ(infos[0].help, "cells per primitive");
  EXPECT_EQ(infos[1].default_value, "on");
  EXPECT_EQ(infos[3].max, "18446744073709551615");
  EXPECT_EQ(infos[4].values, (std::vector<std::string>{"woo", "cubic"}));
  EXPECT_EQ(infos[4].default_value, "woo");
  EXPECT_EQ(infos[5].type, "spec");
  EXPECT_EQ(infos[5].default_value, "bvh");
}

TEST(Options, PrintOnlyWhatDiffersFromTheDefaultInTableOrder) {
  EXPECT_EQ(format_options(SampleOptions{}), "");
  const SampleOptions options = parse({{"top", "(grid:n=3)"},
                                       {"shift", "-0"},
                                       {"mailbox", "0"},
                                       {"density", "0.10000"},
                                       {"max_cells", "1000"}});
  EXPECT_EQ(format_options(options), "density=0.1,mailbox=off,top=(grid:n=3)");
}

TEST(Options, ReadNumbersTheSameWayInEveryLocale) {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  std::setlocale(LC_NUMERIC, "de_DE.UTF-8");  // no harm where it is not installed
  const double density = parse({{"density", "2.5"}}).density;
  std::setlocale(LC_NUMERIC, before.c_str());
  EXPECT_EQ(density, 2.5);
}

}  // namespace
}  // namespace strahl

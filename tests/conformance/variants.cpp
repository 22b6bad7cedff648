#include <charconv>
#include <cmath>
#include <set>
#include <sstream>
#include <tests/conformance/variants.h>

namespace strahl::test {
namespace {

double number(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// Between a and b, geometrically where both are positive.
double between(double a, double b) { return a > 0 && b > 0 ? std::sqrt(a * b) : (a + b) / 2; }

std::string as_value(const OptionInfo& info, double value) {
  std::ostringstream text;
  if (info.type == "double")
    text << value;
  else
    text << static_cast<long long>(std::floor(value));
  return text.str();
}

/// All words of an enum or switch; of a number its minimum and one value on each side of the
/// default, never beyond 1000 times it, as a legal maximum may be meant for other scenes.
std::vector<std::string> values_of(const OptionInfo& info) {
  std::set<std::string> values(info.values.begin(), info.values.end());
  if (!info.min.empty()) {
    const double lo = number(info.min), standard = number(info.default_value);
    const double hi = std::min(number(info.max), 1000 * std::max(standard, 1.0));
    values = {as_value(info, lo), as_value(info, between(std::max(lo, standard / 64), standard)),
              as_value(info, std::min(hi, between(standard, hi)))};
  }
  values.erase(info.default_value);
  return {values.begin(), values.end()};
}

std::string assignment(const OptionInfo& info, const std::string& value) {
  return info.name + "=" + value;
}

}  // namespace

std::vector<std::string> one_at_a_time(const StructureEntry& entry) {
  std::vector<std::string> specs{entry.name};
  for (const OptionInfo& info : entry.options())
    for (const std::string& value : values_of(info))
      specs.push_back(canonical_spec(entry.name, assignment(info, value)));
  return specs;
}

std::vector<std::string> all_pairs(const StructureEntry& entry) {
  std::vector<std::string> specs;
  const std::vector<OptionInfo> infos = entry.options();
  for (std::size_t i = 0; i < infos.size(); ++i)
    for (std::size_t j = i + 1; j < infos.size(); ++j)
      for (const std::string& a : values_of(infos[i]))
        for (const std::string& b : values_of(infos[j]))
          specs.push_back(
              canonical_spec(entry.name, assignment(infos[i], a) + "," + assignment(infos[j], b)));
  return specs;
}

std::vector<std::string> full_product(const StructureEntry& entry, std::size_t limit) {
  std::vector<std::string> lists{""};
  for (const OptionInfo& info : entry.options()) {
    std::vector<std::string> longer = lists;
    for (const std::string& value : values_of(info))
      for (const std::string& list : lists)
        longer.push_back(list.empty() ? assignment(info, value)
                                      : list + "," + assignment(info, value));
    if (longer.size() > limit) return {};
    lists = std::move(longer);
  }
  std::vector<std::string> specs;
  for (const std::string& list : lists) specs.push_back(canonical_spec(entry.name, list));
  return specs;
}

}  // namespace strahl::test

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <set>
#include <tests/conformance/variants.h>

namespace strahl::test {
namespace {

/// Up to so many numbers are choices, each of which meets all others.
constexpr double kChoices = 4;
/// Up to so many are tried alone; of more, but not of sizes, the last.
constexpr double kCounted = 9, kLevels = 65;

double number(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// Between a and b, geometrically where both are positive.
double between(double a, double b) { return a > 0 && b > 0 ? std::sqrt(a * b) : (a + b) / 2; }

/// The values of a number that are too few to be sizes, all of them; none of other options.
std::vector<std::string> counted_values(const OptionInfo& info, double most) {
  if (info.type == "double" || info.min.empty()) return {};
  const double first = number(info.min), last = number(info.max);
  if (last - first >= most) return {};
  std::vector<std::string> values;
  for (double value = first; value <= last; ++value)
    values.push_back(std::to_string(static_cast<long long>(value)));
  return values;
}

std::string as_value(const OptionInfo& info, double value) {
  if (info.type != "double") return std::to_string(static_cast<long long>(std::floor(value)));
  std::array<char, 32> text;  // all digits: a rounded minimum may be below it
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// An option and the values to try, the default first.
struct Axis {
  std::string name;
  std::vector<std::string> values;
  bool is_number;
};

/// Numbers never go beyond 1000 times the default: a legal maximum may be meant for other scenes.
std::vector<std::string> numbers_of(const OptionInfo& info) {
  if (const auto all = counted_values(info, kChoices); !all.empty()) return all;
  const double lo = number(info.min), standard = number(info.default_value);
  const double hi = std::min(number(info.max), 1000 * std::max(standard, 1.0));
  return {as_value(info, lo), as_value(info, between(std::max(lo, standard / 64), standard)),
          as_value(info, std::min(hi, between(standard, hi)))};
}

/// A level that visits things once, one that may visit them again, and one of further levels.
std::vector<std::string> specs_of_levels() { return {"bvh", "grid", "two_level"}; }

std::vector<std::string> words_of(const OptionInfo& info) {
  return info.type == "spec" ? specs_of_levels() : info.values;
}

std::vector<Axis> axes_of(const StructureEntry& entry) {
  std::vector<Axis> axes;
  for (const OptionInfo& info : entry.options()) {
    Axis axis{info.name, {info.default_value}, !info.min.empty()};
    for (const std::string& value : axis.is_number ? numbers_of(info) : words_of(info))
      if (std::find(axis.values.begin(), axis.values.end(), value) == axis.values.end())
        axis.values.push_back(value);
    axes.push_back(std::move(axis));
  }
  return axes;
}

/// Chosen value per axis; kOpen where none is chosen yet.
using Row = std::vector<std::size_t>;
constexpr std::size_t kOpen = ~std::size_t{0};

std::string spec_of(const StructureEntry& entry, const std::vector<Axis>& axes, const Row& row) {
  std::string options;
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (row[i] != 0)
      options += (options.empty() ? "" : ",") + axes[i].name + "=" + axes[i].values[row[i]];
  return canonical_spec(entry.name, options);
}

/// Up to four (axis, value) choices, 16 bits each, by ascending axis.
using Tuple = std::uint64_t;
Tuple with(Tuple tuple, std::size_t axis, std::size_t value) {
  return tuple << 16 | static_cast<Tuple>((axis + 1) << 8 | value);
}

/// Finds the rows of a covering array one by one.
class Coverage {
 public:
  Coverage(const std::vector<Axis>& axes, std::size_t strength)
      : axes_(axes), strength_(std::min(strength, axes.size())) {
    add_missing(0, 0, 0);
  }
  bool is_complete() const { return missing_.empty(); }

  /// A row that begins with a missing tuple and takes, axis by axis, what covers most others.
  Row next_row() {
    Row row(axes_.size(), kOpen);
    for (Tuple rest = *missing_.begin(); rest != 0; rest >>= 16)
      row[(rest >> 8 & 0xff) - 1] = rest & 0xff;
    for (std::size_t i = 0; i < row.size(); ++i)
      if (row[i] == kOpen) row[i] = best_value(row, i);
    visit(row, 0, 0, 0, [this](Tuple tuple) { missing_.erase(tuple); });
    return row;
  }

 private:
  void add_missing(std::size_t axis, std::size_t chosen, Tuple tuple) {
    if (chosen == strength_) {
      if (strength_ > 0) missing_.insert(tuple);
      return;
    }
    for (; axis < axes_.size(); ++axis)
      for (std::size_t value = 0; value < axes_[axis].values.size(); ++value)
        add_missing(axis + 1, chosen + 1, with(tuple, axis, value));
  }
  std::size_t best_value(Row row, std::size_t axis) const {
    std::size_t best = 0, best_gain = 0;
    for (std::size_t value = 0; value < axes_[axis].values.size(); ++value) {
      row[axis] = value;
      std::size_t gain = 0;
      visit(row, 0, 0, 0, [&](Tuple tuple) { gain += missing_.count(tuple); });
      if (gain > best_gain) best = value, best_gain = gain;
    }
    return best;
  }
  /// Calls found(tuple) for every tuple of the row's chosen values.
  template <class Found>
  void visit(const Row& row, std::size_t axis, std::size_t chosen, Tuple tuple,
             const Found& found) const {
    if (chosen == strength_) return found(tuple);
    for (; axis < row.size(); ++axis)
      if (row[axis] != kOpen) visit(row, axis + 1, chosen + 1, with(tuple, axis, row[axis]), found);
  }

  const std::vector<Axis>& axes_;
  std::size_t strength_;
  std::set<Tuple> missing_;
};

}  // namespace

std::vector<std::string> one_at_a_time(const StructureEntry& entry) {
  const std::vector<Axis> axes = axes_of(entry);
  std::vector<std::string> specs{entry.name};
  Row row(axes.size(), 0);
  for (std::size_t i = 0; i < axes.size(); ++i, row.assign(axes.size(), 0))
    for (row[i] = 1; row[i] < axes[i].values.size(); ++row[i])
      specs.push_back(spec_of(entry, axes, row));
  return specs;
}

std::vector<std::string> outer_values(const StructureEntry& entry) {
  std::vector<std::string> specs;
  for (const OptionInfo& info : entry.options()) {
    std::vector<std::string> values = counted_values(info, kCounted);
    if (values.empty() && !counted_values(info, kLevels).empty()) values = {info.max};
    for (const std::string& value : values)
      if (value != info.default_value)
        specs.push_back(canonical_spec(entry.name, info.name + "=" + value));
  }
  return specs;
}

std::vector<std::string> covering(const StructureEntry& entry, std::size_t strength) {
  const std::vector<Axis> axes = axes_of(entry);
  std::vector<std::string> specs;
  for (Coverage coverage(axes, strength); !coverage.is_complete();)
    specs.push_back(spec_of(entry, axes, coverage.next_row()));
  return specs;
}

std::vector<std::string> full_product(const StructureEntry& entry, std::size_t limit) {
  const std::vector<Axis> axes = axes_of(entry);
  std::vector<Row> rows{Row(axes.size(), 0)};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::size_t values =
        axes[i].is_number ? std::min<std::size_t>(2, axes[i].values.size()) : axes[i].values.size();
    if (rows.size() * values > limit) return {};
    const std::vector<Row> shorter = rows;
    for (std::size_t value = 1; value < values; ++value)
      for (Row row : shorter) {
        row[i] = value;
        rows.push_back(row);
      }
  }
  std::vector<std::string> specs;
  for (const Row& row : rows) specs.push_back(spec_of(entry, axes, row));
  return specs;
}

}  // namespace strahl::test

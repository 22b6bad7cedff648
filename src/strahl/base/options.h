// base/options.h - option tables: one description from which parsing, listing and printing follow.
//
// An options struct is a plain struct with defaults at namespace scope; beside it stands
//   inline OptionTable<GridOptions> option_fields(const GridOptions*) {
//     return {option("density", &GridOptions::density, 0.001, 1000.0, "cells per primitive"), ...};
//   }
// which is found by argument-dependent lookup. Tables are made on demand; nothing is global.
// Thread safety: all functions are safe from any number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace strahl {

/// What a user may know about an option. All values are text as in a SPEC.
struct OptionInfo {
  std::string name;
  std::string type;  ///< bool, int, uint64, double, enum or spec
  std::string default_value;
  std::string min, max;  ///< closed range of numbers; empty for other types
  std::string help;
  std::vector<std::string> values;  ///< the accepted words of bool and enum; empty for other types
};

/// One `key=value` of a SPEC; a nested SPEC may come with or without its outer parentheses.
struct OptionValue {
  std::string key, value;
};

/// One row of an option table: what it is called and how it reads and writes its member.
template <class O>
struct OptionField {
  OptionInfo info;  ///< default_value is filled in by describe_options()
  /// Reads text into the member; false (and no change) when the text is not an accepted value.
  std::function<bool(O&, std::string_view)> read;
  /// The member as canonical text, which read() turns into the same value.
  std::function<std::string(const O&)> write;
};

template <class O>
using OptionTable = std::vector<OptionField<O>>;

namespace option_detail {

// One overload per type: read returns false for text that is not wholly a value of the type.
bool read(std::string_view text, bool& value);
bool read(std::string_view text, int& value);
bool read(std::string_view text, std::uint64_t& value);
bool read(std::string_view text, double& value);
bool read_spec(std::string_view text, std::string& value);

std::string write(bool value);
std::string write(int value);
std::string write(std::uint64_t value);
std::string write(double value);
std::string write_spec(const std::string& value);

/// Throws Error{usage} for keys that are not in `known` or come twice.
void check_keys(std::span<const OptionValue> given, std::span<const std::string> known,
                std::string_view structure);

/// Throws Error{usage}: "structure.option: got 'x', expected ...".
[[noreturn]] void refuse_value(std::string_view structure, const OptionInfo& info,
                               std::string_view value);

/// Appends "key=value" to a comma-separated list.
void append(std::string& list, std::string_view key, std::string_view value);

template <class O, class T>
OptionField<O> number(const char* name, const char* type, T O::*member, T min, T max,
                      const char* help) {
  return {{name, type, {}, write(min), write(max), help, {}},
          [=](O& options, std::string_view text) {
            T value{};
            if (!read(text, value) || !(min <= value && value <= max)) return false;
            options.*member = value;
            return true;
          },
          [=](const O& options) { return write(options.*member); }};
}

}  // namespace option_detail

/// A switch: on or off; true, false, 1 and 0 are read too.
template <class O>
OptionField<O> option(const char* name, bool O::*member, const char* help) {
  return {
      {name, "bool", {}, {}, {}, help, {"on", "off"}},
      [=](O& options, std::string_view text) { return option_detail::read(text, options.*member); },
      [=](const O& options) { return option_detail::write(options.*member); }};
}

/// A whole number in the closed range [min, max].
template <class O>
OptionField<O> option(const char* name, int O::*member, int min, int max, const char* help) {
  return option_detail::number<O, int>(name, "int", member, min, max, help);
}

template <class O>
OptionField<O> option(const char* name, std::uint64_t O::*member, std::uint64_t min,
                      std::uint64_t max, const char* help) {
  return option_detail::number<O, std::uint64_t>(name, "uint64", member, min, max, help);
}

/// A finite number in the closed range [min, max].
template <class O>
OptionField<O> option(const char* name, double O::*member, double min, double max,
                      const char* help) {
  return option_detail::number<O, double>(name, "double", member, min, max, help);
}

/// A number of which any value of the type will do.
template <class O, class T>
requires(std::is_same_v<T, int> || std::is_same_v<T, std::uint64_t> ||
         std::is_same_v<T, double>) OptionField<O> option(const char* name, T O::*member,
                                                          const char* help) {
  return option(name, member, std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max(),
                help);
}

/// One of several words. Several words may name one value; the first is the canonical one.
/// Every value the member can take must have a word.
template <class O, class E>
requires std::is_enum_v<E> OptionField<O> option(
    const char* name, E O::*member,
    std::vector<std::pair<std::string, std::type_identity_t<E>>> words, const char* help) {
  OptionInfo info{name, "enum", {}, {}, {}, help, {}};
  for (const auto& [word, value] : words) info.values.push_back(word);
  return {std::move(info),
          [=](O& options, std::string_view text) {
            for (const auto& [word, value] : words) {
              if (word != text) continue;
              options.*member = value;
              return true;
            }
            return false;
          },
          [=](const O& options) {
            for (const auto& [word, value] : words) {
              if (value == options.*member) return word;
            }
            return std::string();
          }};
}

/// A nested SPEC, kept without its outer parentheses. Only characters and parentheses are checked
/// here; the catalog knows the names.
template <class O>
OptionField<O> option_spec(const char* name, std::string O::*member, const char* help) {
  return {{name, "spec", {}, {}, {}, help, {}},
          [=](O& options, std::string_view text) {
            return option_detail::read_spec(text, options.*member);
          },
          [=](const O& options) { return option_detail::write_spec(options.*member); }};
}

/// Defaults overwritten by what is given, in any order.
/// @param structure the name before the colon of the SPEC, for messages
/// Throws Error{usage} naming structure.option, the value got and what is accepted; an unknown key
/// names the known ones; a key given twice is an error.
template <class O>
O parse_options(std::span<const OptionValue> given, std::string_view structure) {
  const OptionTable<O> table = option_fields(static_cast<const O*>(nullptr));
  std::vector<std::string> known;
  for (const OptionField<O>& field : table) known.push_back(field.info.name);
  option_detail::check_keys(given, known, structure);
  O options{};
  for (const OptionValue& pair : given) {
    for (const OptionField<O>& field : table) {
      if (field.info.name != pair.key || field.read(options, pair.value)) continue;
      option_detail::refuse_value(structure, field.info, pair.value);
    }
  }
  return options;
}

/// The table as text, in table order; defaults are those of a default-constructed O.
template <class O>
std::vector<OptionInfo> describe_options() {
  std::vector<OptionInfo> infos;
  for (OptionField<O>& field : option_fields(static_cast<const O*>(nullptr))) {
    field.info.default_value = field.write(O{});
    infos.push_back(std::move(field.info));
  }
  return infos;
}

/// The options that differ from their defaults as "key=value,key=value" in table order: the
/// canonical text of a SPEC after its colon; empty when all are defaults. Parsing it gives the same
/// options.
template <class O>
std::string format_options(const O& options) {
  std::string list;
  for (const OptionField<O>& field : option_fields(static_cast<const O*>(nullptr))) {
    const std::string value = field.write(options);
    if (value != field.write(O{})) option_detail::append(list, field.info.name, value);
  }
  return list;
}

}  // namespace strahl

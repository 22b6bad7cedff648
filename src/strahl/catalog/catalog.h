// catalog/catalog.h - all structures by name: SPEC text in, built Accelerator out.
//
// SPEC grammar: spec := name [':' opt {',' opt}], opt := key '=' value,
// value := number | word | '(' spec ')'; lower case, no blanks; a bare name is a complete SPEC.
// Thread safety: pure functions over constant tables.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/base/options.h>
#include <strahl/catalog/accelerator.h>

namespace strahl {

class Level;

/// The SPEC used when none is given.
inline constexpr std::string_view kDefaultSpec = "wide_bvh";

/// A SPEC taken apart.
struct Spec {
  std::string name;
  std::vector<OptionValue> options;
};

/// Throws Error{usage} naming the SPEC, the column and what was expected.
Spec parse_spec(std::string_view text);

/// Splits a list of SPECs on commas outside parentheses; an item that begins with `key=` belongs
/// to the SPEC before it. Empty text gives no SPEC.
std::vector<std::string> split_specs(std::string_view list);

/// "name" or "name:options".
std::string canonical_spec(std::string_view name, const std::string& options);

/// One structure of the catalogue.
struct StructureEntry {
  const char* name;
  const char* title;
  std::vector<OptionInfo> (*options)();
  std::unique_ptr<Accelerator> (*build)(std::shared_ptr<const Scene>, std::span<const OptionValue>,
                                        const BuildContext&);
  /// As a level of a two-level structure (structures/two_level/level.h).
  std::unique_ptr<Level> (*build_level)(const PrimitiveSource&, std::span<const OptionValue>,
                                        const BuildContext&) = nullptr;
  /// Null for structures that cannot tell.
  std::uint64_t (*estimate_bytes)(const Scene&, std::span<const OptionValue>,
                                  const BuildContext&) = nullptr;
};

/// All structures in the order of structures.def.
std::span<const StructureEntry> all_structures();

/// Builds a structure over the scene. Throws Error: usage for an unknown name (naming the known
/// ones) or a bad option, resource above the memory limit, cancelled by the progress callback.
std::unique_ptr<Accelerator> build(std::shared_ptr<const Scene> scene, std::string_view spec,
                                   const BuildContext& context = {});

/// About how many bytes report() of the structure will give, told without building it; nothing for
/// structures that cannot tell. Throws as build() does.
std::optional<std::uint64_t> estimate_bytes(const Scene& scene, std::string_view spec,
                                            const BuildContext& context = {});

/// The same over any source, as a level of a two-level structure. The source need not outlive it.
std::unique_ptr<Level> build_level(const PrimitiveSource& source, std::string_view spec,
                                   const BuildContext& context = {});

}  // namespace strahl

#include <strahl/base/error.h>
#include <strahl/base/fp_env.h>
#include <strahl/catalog/catalog.h>
#include <strahl/structures/two_level/level.h>

namespace strahl {

// Both are defined by the files the build generates for the line of structures.def.
#define STRAHL_STRUCTURE(id, type)                                        \
  StructureEntry id##_entry();                                            \
  std::unique_ptr<Level> id##_level(const PrimitiveSource& source,        \
                                    std::span<const OptionValue> options, \
                                    const BuildContext& context);
#include <strahl/catalog/structures.def>
#undef STRAHL_STRUCTURE

namespace {

StructureEntry with_level(StructureEntry entry, decltype(StructureEntry::build_level) build) {
  entry.build_level = build;
  return entry;
}

const StructureEntry& find_entry(const Spec& parsed, std::string_view spec) {
  std::string known;
  for (const StructureEntry& entry : all_structures()) {
    if (parsed.name == entry.name) return entry;
    known += known.empty() ? "" : ", ";
    known += entry.name;
  }
  throw Error(ErrorCode::usage, "unknown structure '" + parsed.name + "'; known: " + known,
              std::string(spec));
}

}  // namespace

std::span<const StructureEntry> all_structures() {
  static const StructureEntry kEntries[] = {
#define STRAHL_STRUCTURE(id, type) with_level(id##_entry(), &id##_level),
#include <strahl/catalog/structures.def>
#undef STRAHL_STRUCTURE
  };
  return kEntries;
}

std::unique_ptr<Accelerator> build(std::shared_ptr<const Scene> scene, std::string_view spec,
                                   const BuildContext& context) {
  const Spec parsed = parse_spec(spec);
  const FpEnvGuard environment;
  return find_entry(parsed, spec).build(std::move(scene), parsed.options, context);
}

std::optional<std::uint64_t> estimate_bytes(const Scene& scene, std::string_view spec,
                                            const BuildContext& context) {
  const Spec parsed = parse_spec(spec);
  const StructureEntry& entry = find_entry(parsed, spec);
  if (entry.estimate_bytes == nullptr) return std::nullopt;
  const FpEnvGuard environment;
  return entry.estimate_bytes(scene, parsed.options, context);
}

std::unique_ptr<Level> build_level(const PrimitiveSource& source, std::string_view spec,
                                   const BuildContext& context) {
  const Spec parsed = parse_spec(spec);
  return find_entry(parsed, spec).build_level(source, parsed.options, context);
}

}  // namespace strahl

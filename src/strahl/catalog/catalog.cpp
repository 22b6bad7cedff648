#include <strahl/base/error.h>
#include <strahl/base/fp_env.h>
#include <strahl/catalog/catalog.h>

namespace strahl {

// Each entry is defined by the file the build generates for the line of structures.def.
#define STRAHL_STRUCTURE(id, type) StructureEntry id##_entry();
#include <strahl/catalog/structures.def>
#undef STRAHL_STRUCTURE

std::span<const StructureEntry> all_structures() {
  static const StructureEntry entries[] = {
#define STRAHL_STRUCTURE(id, type) id##_entry(),
#include <strahl/catalog/structures.def>
#undef STRAHL_STRUCTURE
  };
  return entries;
}

std::unique_ptr<Accelerator> build(std::shared_ptr<const Scene> scene, std::string_view spec,
                                   const BuildContext& context) {
  const Spec parsed = parse_spec(spec);
  const FpEnvGuard environment;
  std::string known;
  for (const StructureEntry& entry : all_structures()) {
    if (parsed.name == entry.name) return entry.build(std::move(scene), parsed.options, context);
    known += known.empty() ? "" : ", ";
    known += entry.name;
  }
  throw Error(ErrorCode::usage, "unknown structure '" + parsed.name + "'; known: " + known,
              std::string(spec));
}

}  // namespace strahl

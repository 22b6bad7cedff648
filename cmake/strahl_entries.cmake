# The catalogue's entry of each structure, generated from its line in structures.def: two small
# translation units per structure (alone, and as a level of two_level), so that structures never
# meet and compile in parallel.

# strahl_generate_entries(<out>): writes and lists two files per line STRAHL_STRUCTURE(id, Type).
function(strahl_generate_entries out)
  file(STRINGS ${PROJECT_SOURCE_DIR}/src/strahl/catalog/structures.def lines
       REGEX "^STRAHL_STRUCTURE\\(")
  set(files)
  foreach(line IN LISTS lines)
    if(NOT line MATCHES "^STRAHL_STRUCTURE\\(([a-z0-9_]+), ([A-Za-z0-9]+)\\)$")
      message(FATAL_ERROR "structures.def: cannot read '${line}'")
    endif()
    set(id ${CMAKE_MATCH_1})
    set(type ${CMAKE_MATCH_2})
    set(file ${STRAHL_GENERATED_DIR}/entries/${id}_entry.cpp)
    file(CONFIGURE OUTPUT ${file} CONTENT
"#include <strahl/catalog/erased.h>
#include <strahl/structures/@id@/@id@.h>

namespace strahl {
StructureEntry @id@_entry();
StructureEntry @id@_entry() { return make_entry<@type@>(); }
}  // namespace strahl
" @ONLY)
    set(level ${STRAHL_GENERATED_DIR}/entries/${id}_level.cpp)
    file(CONFIGURE OUTPUT ${level} CONTENT
"#include <strahl/catalog/level_of.h>
#include <strahl/structures/@id@/@id@.h>

namespace strahl {
std::unique_ptr<Level> @id@_level(const PrimitiveSource&, std::span<const OptionValue>,
                                  const BuildContext&);
std::unique_ptr<Level> @id@_level(const PrimitiveSource& source,
                                  std::span<const OptionValue> options,
                                  const BuildContext& context) {
  return make_level<@type@>(source, options, context);
}
}  // namespace strahl
" @ONLY)
    list(APPEND files ${file} ${level})
  endforeach()
  set(${out} ${files} PARENT_SCOPE)
endfunction()

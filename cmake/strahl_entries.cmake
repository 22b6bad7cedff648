# The catalogue's entry of each structure, generated from its line in structures.def: one small
# translation unit per structure, so that structures never meet and compile in parallel.

# strahl_generate_entries(<out>): writes and lists one file per line STRAHL_STRUCTURE(id, Type).
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
    list(APPEND files ${file})
  endforeach()
  set(${out} ${files} PARENT_SCOPE)
endfunction()

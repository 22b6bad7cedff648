# Which files belong to what: sources and tests by folder, structures by structures.def.

# strahl_glob(<out> [<pattern...>]): files below the project's root; the build notices new ones.
function(strahl_glob out)
  set(files)
  if(ARGN)
    list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE patterns)
    file(GLOB files CONFIGURE_DEPENDS ${patterns})
  endif()
  set(${out} ${files} PARENT_SCOPE)
endfunction()

# strahl_glob_sources(<out> <folder...>): sources of these folders of src/strahl without tests.
function(strahl_glob_sources out)
  list(TRANSFORM ARGN REPLACE "(.+)" "src/strahl/\\1/*.cpp" OUTPUT_VARIABLE patterns)
  strahl_glob(files ${patterns})
  list(FILTER files EXCLUDE REGEX "_test\\.cpp$")
  set(${out} ${files} PARENT_SCOPE)
endfunction()

# strahl_structure_ids(<out>): the ids of structures.def, the only list of structures. Each must
# have its folder with a README.
function(strahl_structure_ids out)
  set(list_file ${PROJECT_SOURCE_DIR}/src/strahl/catalog/structures.def)
  set(ids)
  if(EXISTS ${list_file})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${list_file})
    file(STRINGS ${list_file} lines REGEX "^STRAHL_STRUCTURE\\(")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^STRAHL_STRUCTURE\\(([a-z0-9_]+)[,)].*" "\\1" id "${line}")
      set(folder src/strahl/structures/${id})
      strahl_glob(sources ${folder}/*.cpp)
      if(NOT sources OR NOT EXISTS ${PROJECT_SOURCE_DIR}/${folder}/README.md)
        message(FATAL_ERROR "structures.def names '${id}', but ${folder} lacks sources or README.md")
      endif()
      list(APPEND ids ${id})
    endforeach()
  endif()
  set(${out} ${ids} PARENT_SCOPE)
endfunction()

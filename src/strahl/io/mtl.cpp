// io/mtl.cpp - reader of material libraries.
#include <strahl/io/mtl.h>
#include <strahl/io/text_cursor.h>

namespace strahl {
namespace {

// `Kd spectral ...` and `Kd xyz ...` name other colour models and are left alone.
void read_color(TextCursor& cursor, Material* material) {
  const std::string_view first = cursor.token();
  if (first == "spectral" || first == "xyz") return;
  Vec3d color;
  color.x = cursor.to_number(first, "colour");
  color.y = cursor.number("colour");
  color.z = cursor.number("colour");
  if (!is_finite(color)) cursor.fail("colour is not finite");
  if (material == nullptr) cursor.fail("colour before the first newmtl");
  material->color = color;
}

}  // namespace

std::map<std::string, Material, std::less<>> read_mtl(const FileBytes& file) {
  std::map<std::string, Material, std::less<>> materials;
  Material repeated;  // takes what a second definition of a name says
  Material* current = nullptr;
  TextCursor cursor(file.text(), file.name, {'#', true});
  while (!cursor.at_end()) {
    const std::string_view keyword = cursor.token();
    if (keyword == "newmtl") {
      const auto [place, is_new] = materials.try_emplace(std::string(cursor.rest_of_line()));
      current = is_new ? &place->second : &repeated;
    } else if (keyword == "Kd") {
      read_color(cursor, current);
    }
    cursor.next_line();
  }
  return materials;
}

}  // namespace strahl

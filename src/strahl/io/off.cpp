// io/off.cpp - ascii OFF.
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <strahl/io/face_list.h>
#include <strahl/io/off.h>
#include <strahl/io/text_cursor.h>

namespace strahl {
namespace {

struct Counts {
  std::uint64_t vertices = 0, faces = 0;
};

// Takes [ST][C][N]OFF off the front of the word; what is left is a count written without a blank,
// as some widely used data sets have it.
std::string_view behind_keyword(const TextCursor& cursor, std::string_view word) {
  std::string_view rest = word;
  for (const std::string_view prefix : {"ST", "C", "N"})
    if (rest.starts_with(prefix)) rest.remove_prefix(prefix.size());
  if (!rest.starts_with("OFF")) cursor.fail("no OFF file: it starts with " + quote(word));
  return rest.substr(3);
}

// A vertex takes at least "0 0 0" and a line end, a face "0" and a line end.
std::uint64_t checked_count(const TextCursor& cursor, std::string_view token, const char* what,
                            std::uint64_t row_bytes) {
  const std::int64_t count = cursor.to_integer(token, what);
  if (count < 0 || static_cast<std::uint64_t>(count) > (cursor.remaining() + 1) / row_bytes)
    cursor.fail(std::to_string(count) + ": " + what + " does not fit the file");
  if (count > std::numeric_limits<std::uint32_t>::max())
    cursor.fail(std::string(what) + " above 2^32 - 1");
  return static_cast<std::uint64_t>(count);
}

Counts read_header(TextCursor& cursor) {
  std::string_view first = behind_keyword(cursor, cursor.token_of_any_line());
  if (first.empty()) first = cursor.token_of_any_line();
  if (first == "BINARY") cursor.fail("binary OFF is not supported");
  const std::uint64_t vertices = checked_count(cursor, first, "vertex count", 6);
  const std::uint64_t faces = checked_count(cursor, cursor.token(), "face count", 2);
  cursor.next_line();
  return {vertices, faces};
}

std::vector<Vec3d> read_vertices(TextCursor& cursor, std::uint64_t count) {
  std::vector<Vec3d> vertices;
  vertices.reserve(count);
  while (vertices.size() < count) {
    if (cursor.at_end()) cursor.fail("the file ends inside the vertices");
    const double x = cursor.number("x"), y = cursor.number("y"), z = cursor.number("z");
    vertices.push_back({x, y, z});
    cursor.next_line();
  }
  return vertices;
}

// The corners of one face; they may go on over several lines.
void read_corners(TextCursor& cursor, std::uint64_t vertex_count,
                  std::vector<std::uint32_t>& corners) {
  const std::uint64_t count = checked_count(cursor, cursor.token(), "corner count", 2);
  corners.clear();
  while (corners.size() < count) {
    const std::int64_t index = cursor.to_integer(cursor.token_of_any_line(), "vertex index");
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count)
      cursor.fail("vertex index " + std::to_string(index) + " of " + std::to_string(vertex_count) +
                  " vertices");
    corners.push_back(static_cast<std::uint32_t>(index));
  }
  cursor.next_line();
}

}  // namespace

SceneData read_off(const FileBytes& file) {
  SceneData scene;
  scene.source = file.name;
  TextCursor cursor(file.text(), file.name, {.comment = '#'});
  const Counts counts = read_header(cursor);
  FaceList faces(make_vertex_buffer(read_vertices(cursor, counts.vertices)));
  std::vector<std::uint32_t> corners;
  for (std::uint64_t i = 0; i < counts.faces; ++i) {
    if (cursor.at_end()) cursor.fail("the file ends inside the faces");
    read_corners(cursor, counts.vertices, corners);
    faces.add(corners);
  }
  if (!cursor.at_end()) scene.warnings.push_back(cursor.where() + ": data after the faces");
  add_faces(faces, scene);
  return scene;
}

}  // namespace strahl

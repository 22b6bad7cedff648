// io/obj.cpp - OBJ statements to a mesh: one pass over the text, then faces and materials resolved.
#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/io/face_list.h>
#include <strahl/io/mtl.h>
#include <strahl/io/obj.h>
#include <strahl/io/text_cursor.h>

namespace strahl {
namespace {

// Statements that are known and ignored: they tell an OBJ file from any other text.
constexpr std::array kIgnored = {
    "vt",       "vn",       "vp",         "g",         "o",     "s",     "p",    "l",      "mg",
    "cstype",   "deg",      "bmat",       "step",      "curv",  "curv2", "surf", "parm",   "trim",
    "hole",     "scrv",     "sp",         "end",       "con",   "bevel", "lod",  "usemap", "maplib",
    "d_interp", "c_interp", "shadow_obj", "trace_obj", "ctech", "stech", "call", "csh"};

constexpr std::size_t kMaxIndex = std::numeric_limits<std::uint32_t>::max();

/// Many events of one kind as one warning: the first in words, the others counted.
class Tally {
 public:
  void add(const std::string& text) {
    if (count_++ == 0) first_ = text;
  }
  void report(std::vector<std::string>& warnings) const {
    if (count_ == 0) return;
    warnings.push_back(
        count_ == 1 ? first_ : first_ + " (and " + std::to_string(count_ - 1) + " more like it)");
  }

 private:
  std::size_t count_ = 0;
  std::string first_;
};

/// Length of the longest beginning of `token` that is a number with a digit in it.
std::size_t number_length(std::string_view token) {
  const std::size_t sign = token.starts_with('+') && !token.starts_with("+-") ? 1 : 0;
  const char* const end = token.data() + token.size();
  double value = 0.0;
  const std::from_chars_result result = std::from_chars(token.data() + sign, end, value);
  if (result.ec == std::errc::invalid_argument) return 0;
  const std::string_view number =
      token.substr(0, static_cast<std::size_t>(result.ptr - token.data()));
  return number.find_first_of("0123456789") == std::string_view::npos ? 0 : number.size();
}

void require_text(const FileBytes& file) {
  const std::string_view text = file.text();
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    throw Error(ErrorCode::bad_input, "UTF-16 text; OBJ is plain ASCII or UTF-8", file.name,
                "byte 0");
  }
  const std::size_t nul = text.find('\0');
  if (nul == std::string_view::npos) return;
  throw Error(ErrorCode::bad_input, "NUL byte in text", file.name, "byte " + std::to_string(nul));
}

class ObjReader {
 public:
  explicit ObjReader(const FileBytes& file)
      : file_(file), cursor_(file.text(), file.name, {'#', true}) {}
  SceneData read();

 private:
  struct Face {
    std::size_t corners_end;  ///< its corners end here in corners_; they start where the last ended
    std::size_t line;
    std::uint32_t material;  ///< index into used_materials_
  };
  struct Named {
    std::string name;
    std::size_t line;  ///< where the name appeared first
  };
  using Library = std::map<std::string, Material, std::less<>>;

  void read_statements();
  void read_statement(std::string_view keyword);
  void read_vertex();
  double coordinate();
  void read_face();
  std::uint32_t corner(std::string_view token) const;
  void use_material();
  void name_libraries();
  void require_statements() const;
  void check_corners(const Face& face, std::span<const std::uint32_t> corners) const;
  void add_geometry(const std::vector<std::uint32_t>& material_of_name, SceneData& scene);
  Library load_libraries();
  std::vector<std::uint32_t> resolve_materials(SceneData& scene);

  const FileBytes& file_;
  TextCursor cursor_;
  std::vector<Vec3d> vertices_;
  std::vector<std::uint32_t> corners_;
  std::vector<Face> faces_;
  std::vector<Named> used_materials_{{"", 0}};  ///< entry 0: no usemtl yet
  std::map<std::string, std::uint32_t, std::less<>> used_material_ids_{{"", 0}};
  std::vector<Named> libraries_;
  std::set<std::string, std::less<>> library_names_;
  std::uint32_t material_ = 0;
  std::size_t first_line_ = 0;  ///< of any content; 0: none yet
  bool recognised_ = false;
  Tally odd_numbers_, missing_libraries_, missing_materials_;
};

SceneData ObjReader::read() {
  require_text(file_);
  read_statements();
  require_statements();
  SceneData scene;
  scene.source = file_.name;
  const std::vector<std::uint32_t> material_of_name = resolve_materials(scene);
  add_geometry(material_of_name, scene);
  for (const Tally* tally : {&odd_numbers_, &missing_libraries_, &missing_materials_}) {
    tally->report(scene.warnings);
  }
  return scene;
}

void ObjReader::read_statements() {
  while (!cursor_.at_end()) {
    if (first_line_ == 0) first_line_ = cursor_.line();
    read_statement(cursor_.token());
    // Token by token, so that a continued line ends where the last of its lines does.
    while (!cursor_.token().empty()) {
    }
    cursor_.next_line();
  }
}

void ObjReader::read_statement(std::string_view keyword) {
  bool known = true;
  if (keyword == "v") {
    read_vertex();
  } else if (keyword == "f" || keyword == "fo") {
    read_face();
  } else if (keyword == "usemtl") {
    use_material();
  } else if (keyword == "mtllib") {
    name_libraries();
  } else {
    known = std::find(kIgnored.begin(), kIgnored.end(), keyword) != kIgnored.end();
  }
  recognised_ = recognised_ || known;
}

void ObjReader::read_vertex() {
  Vec3d vertex;
  for (int axis = 0; axis < 3; ++axis) vertex[axis] = coordinate();
  if (vertices_.size() == kMaxIndex) cursor_.fail("more than 2^32 - 1 vertices");
  vertices_.push_back(vertex);
}

double ObjReader::coordinate() {
  const std::string_view token = cursor_.token();
  if (const std::optional<double> value = parse_number(token)) return *value;
  const std::size_t length = number_length(token);
  if (length == 0) return cursor_.to_number(token, "coordinate");
  // Some run-time libraries print infinities and NaNs as 1.#INF, 1.#QNAN and the like.
  const bool not_finite = token[length] == '#';
  odd_numbers_.add(cursor_.where() + ": coordinate " + quote(token) + " read as " +
                   (not_finite ? "not finite" : quote(token.substr(0, length))));
  if (not_finite) return std::numeric_limits<double>::quiet_NaN();
  return cursor_.to_number(token.substr(0, length), "coordinate");
}

void ObjReader::read_face() {
  const std::size_t line = cursor_.line();
  for (std::string_view token = cursor_.token(); !token.empty(); token = cursor_.token()) {
    corners_.push_back(corner(token));
  }
  if (faces_.size() == kMaxIndex) cursor_.fail("more than 2^32 - 1 faces");
  faces_.push_back({corners_.size(), line, material_});
}

/// The vertex of `v`, `v/vt`, `v//vn` or `v/vt/vn`, from 0; it may be one that is yet to come.
std::uint32_t ObjReader::corner(std::string_view token) const {
  const std::string_view digits = token.substr(0, token.find('/'));
  const std::int64_t index = cursor_.to_integer(digits, "vertex index");
  if (index == 0) cursor_.fail("vertex index 0; indices start at 1");
  const auto read_so_far = static_cast<std::int64_t>(vertices_.size());
  if (index < -read_so_far || index > static_cast<std::int64_t>(kMaxIndex)) {
    cursor_.fail("vertex index " + std::to_string(index) + " out of range, " +
                 std::to_string(read_so_far) + " vertices so far");
  }
  return static_cast<std::uint32_t>(index > 0 ? index - 1 : read_so_far + index);
}

void ObjReader::use_material() {
  const std::size_t line = cursor_.line();
  std::string name(cursor_.rest_of_line());
  const auto [place, is_new] =
      used_material_ids_.try_emplace(name, static_cast<std::uint32_t>(used_materials_.size()));
  if (is_new) used_materials_.push_back({std::move(name), line});
  material_ = place->second;
}

/// The names may be one with blanks in it or several: one if there is such a file.
void ObjReader::name_libraries() {
  const std::size_t line = cursor_.line();
  const std::string_view rest = cursor_.rest_of_line();
  std::error_code ignored;
  const bool is_one = std::filesystem::exists(file_.folder / rest, ignored);
  TextCursor names(rest, file_.name);
  while (!names.at_line_end()) {
    std::string name(is_one ? names.rest_of_line() : names.token());
    if (library_names_.insert(name).second) libraries_.push_back({std::move(name), line});
  }
}

void ObjReader::require_statements() const {
  if (first_line_ == 0 || recognised_) return;
  throw Error(ErrorCode::bad_input, "no OBJ statement in the whole file", file_.name,
              "line " + std::to_string(first_line_));
}

void ObjReader::check_corners(const Face& face, std::span<const std::uint32_t> corners) const {
  for (const std::uint32_t corner : corners) {
    if (corner < vertices_.size()) continue;
    throw Error(ErrorCode::bad_input,
                "vertex index " + std::to_string(std::uint64_t{corner} + 1) + " out of range, " +
                    std::to_string(vertices_.size()) + " vertices in the file",
                file_.name, "line " + std::to_string(face.line));
  }
}

void ObjReader::add_geometry(const std::vector<std::uint32_t>& material_of_name, SceneData& scene) {
  const std::span<const std::uint32_t> all_corners = corners_;
  std::size_t start = 0;
  for (const Face& face : faces_) {
    check_corners(face, all_corners.subspan(start, face.corners_end - start));
    start = face.corners_end;
  }
  FaceList list(make_vertex_buffer(std::move(vertices_)));
  std::vector<std::uint32_t> materials;
  start = 0;
  for (const Face& face : faces_) {
    list.add(all_corners.subspan(start, face.corners_end - start));
    start = face.corners_end;
    if (!scene.materials.empty()) {
      materials.resize(list.triangle_count(), material_of_name[face.material]);
    }
  }
  add_faces(list, scene);
  if (!scene.geometries.empty()) scene.geometries.front().materials = std::move(materials);
}

/// The materials of all libraries that can be read; the first definition of a name counts.
ObjReader::Library ObjReader::load_libraries() {
  Library all;
  for (const auto& [name, line] : libraries_) {
    const std::string start =
        "line " + std::to_string(line) + ": material library " + quote(name) + " not read";
    if (file_.folder.empty()) {
      missing_libraries_.add(start);
      continue;
    }
    try {
      all.merge(read_mtl(map_file(file_.folder / name)));
    } catch (const Error& error) {
      missing_libraries_.add(start + ": " + error.what());
    }
  }
  return all;
}

/// Fills the scene's materials; returns the material index of each used name.
std::vector<std::uint32_t> ObjReader::resolve_materials(SceneData& scene) {
  const Library library = load_libraries();
  std::vector<std::uint32_t> index_of_name(used_materials_.size(), 0);
  std::vector<Material> found(1);
  for (std::size_t i = 1; i < used_materials_.size(); ++i) {
    const Named& used = used_materials_[i];
    const auto place = library.find(used.name);
    if (place == library.end()) {
      missing_materials_.add("line " + std::to_string(used.line) + ": material " +
                             quote(used.name) + " is not defined; the default one is used");
      continue;
    }
    index_of_name[i] = static_cast<std::uint32_t>(found.size());
    found.push_back(place->second);
  }
  if (found.size() > 1) scene.materials = std::move(found);
  return index_of_name;
}

}  // namespace

SceneData read_obj(const FileBytes& file) { return ObjReader(file).read(); }

}  // namespace strahl

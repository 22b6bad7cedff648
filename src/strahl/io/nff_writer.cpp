// io/nff_writer.cpp - NFF files.
#include <array>
#include <charconv>
#include <initializer_list>
#include <string>
#include <utility>

#include <strahl/io/block_writer.h>
#include <strahl/io/scene_writer.h>

namespace strahl {
namespace {

// Lines of words and numbers.
class NffText {
 public:
  explicit NffText(BlockWriter& file) : file_(file) {}

  NffText& word(std::string_view text) {
    if (!at_line_start_) file_.put(" ");
    file_.put(text);
    at_line_start_ = false;
    return *this;
  }

  NffText& number(double value) {
    std::array<char, 32> text;
    char* const last = text.data() + text.size();
    const bool is_short = round_to_six_digits(value) == value;
    const char* end =
        is_short ? std::to_chars(text.data(), last, value, std::chars_format::general, 6).ptr
                 : std::to_chars(text.data(), last, value, std::chars_format::general).ptr;
    return word({text.data(), static_cast<std::size_t>(end - text.data())});
  }

  NffText& numbers(std::initializer_list<double> values) {
    for (const double value : values) number(value);
    return *this;
  }

  NffText& point(const Vec3d& p) { return numbers({p.x, p.y, p.z}); }

  void end_line() {
    file_.put("\n");
    at_line_start_ = true;
  }
  void end_item() { file_.item_done(); }

 private:
  BlockWriter& file_;
  bool at_line_start_ = true;
};

void put_view(NffText& text, const View& view, double hither) {
  text.word("v").end_line();
  text.word("from").point(view.from).end_line();
  text.word("at").point(view.at).end_line();
  text.word("up").point(view.up).end_line();
  text.word("angle").number(view.fov_degrees).end_line();
  text.word("hither").number(hither).end_line();
  text.word("resolution").numbers({double(view.width), double(view.height)}).end_line();
}

void put_fill(NffText& text, const Material& m) {
  text.word("f").point(m.color);
  text.numbers({m.diffuse, m.specular, m.shine, m.transmission, m.refraction_index}).end_line();
}

void put_polygon(NffText& text, const NffScene& scene, const NffPolygon& polygon) {
  text.word(polygon.is_patch() ? "pp" : "p").word(std::to_string(polygon.vertex_count)).end_line();
  for (std::uint32_t i = 0; i < polygon.vertex_count; ++i) {
    text.point(scene.vertices[polygon.first_vertex + i]);
    if (polygon.is_patch()) text.point(scene.normals[polygon.first_normal + i]);
    text.end_line();
  }
}

void put_sphere(NffText& text, const Sphere& sphere) {
  text.word("s").point(sphere.center).number(sphere.radius).end_line();
}

void put_cone(NffText& text, const Cone& cone) {
  text.word("c").point(cone.base).number(cone.base_radius);
  text.point(cone.apex).number(cone.apex_radius).end_line();
}

void put_objects(NffText& text, const NffScene& scene) {
  std::size_t polygon = 0, sphere = 0, cone = 0;
  std::optional<std::uint32_t> fill;
  for (const NffObject& object : scene.objects) {
    if (fill != object.fill) put_fill(text, scene.fills[object.fill]);
    fill = object.fill;
    switch (object.kind) {
      case NffKind::polygon:
        put_polygon(text, scene, scene.polygons[polygon++]);
        break;
      case NffKind::sphere:
        put_sphere(text, scene.spheres[sphere++]);
        break;
      case NffKind::cone:
        put_cone(text, scene.cones[cone++]);
        break;
    }
    text.end_item();
  }
}

}  // namespace

void write_nff(const NffScene& scene, const std::filesystem::path& path, const Progress& progress) {
  BlockWriter file(path, scene.objects.size(), progress);
  NffText text(file);
  if (scene.background) text.word("b").point(*scene.background).end_line();
  if (scene.view) put_view(text, *scene.view, scene.hither);
  for (const Vec3d& light : scene.lights) text.word("l").point(light).end_line();
  put_objects(text, scene);
  file.commit();
}

void write_nff(const SceneData& data, const std::filesystem::path& path, const Progress& progress) {
  write_nff(to_nff_scene(data), path, progress);
}

}  // namespace strahl

// io/ply_test.cpp - PLY in all formats and orders, and its errors.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <tests/support/memory_file.h>

#include <gtest/gtest.h>

#include <strahl/io/ply.h>

namespace strahl {
namespace {

using test::error_of;
using test::memory_file;
using Triangle = std::array<std::uint64_t, 3>;

// Appends values byte by byte in either order.
class Bytes {
 public:
  explicit Bytes(std::string start, bool big_endian = false)
      : text_(std::move(start)), big_endian_(big_endian) {}
  template <class T>
  Bytes& add(T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (big_endian_) std::reverse(raw, raw + sizeof raw);
    text_.append(raw, sizeof raw);
    return *this;
  }
  template <class T, class... Rest>
  Bytes& add(T value, Rest... rest) {
    add(value);
    return add(rest...);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool big_endian_;
};

constexpr std::uint8_t kThree = 3;

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

std::string xyz(int vertices, const std::string& type = "float") {
  return "element vertex " + std::to_string(vertices) + "\nproperty " + type + " x\nproperty " +
         type + " y\nproperty " + type + " z\n";
}

std::string faces(int count, const std::string& types = "uchar int") {
  return "element face " + std::to_string(count) + "\nproperty list " + types + " vertex_indices\n";
}

const std::string kCorners = "0 0 0\n1 0 0\n0 1 0\n";

SceneData read(const std::string& text) { return read_ply(memory_file(text, "a.ply")); }
std::string error(const std::string& text) {
  return error_of([&] { read(text); });
}

Triangle triangle(const SceneData& scene, std::size_t i) {
  const IndexView::Triple t = scene.geometries.at(0).mesh.triangles[i];
  return {t.a, t.b, t.c};
}

TEST(Ply, ReadsAscii) {
  const SceneData scene = read(header("ascii", xyz(3) + faces(1)) + kCorners + "3 0 1 2\n");
  ASSERT_EQ(scene.geometries.size(), 1u);
  EXPECT_EQ(triangle(scene, 0), (Triangle{0, 1, 2}));
  EXPECT_EQ(scene.geometries[0].mesh[0].c, (Vec3d{0, 1, 0}));
  EXPECT_FALSE(scene.geometries[0].mesh.vertices.is_double);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.source, "a.ply");
}

TEST(Ply, ReadsBinaryOfBothByteOrdersAlike) {
  for (const bool big : {false, true}) {
    const std::string format = big ? "binary_big_endian" : "binary_little_endian";
    Bytes bytes(header(format, xyz(3) + faces(1)), big);
    bytes.add(0.5f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.25f, 0.f).add(kThree, 2, 0, 1);
    const SceneData scene = read(bytes.text());
    EXPECT_EQ(triangle(scene, 0), (Triangle{2, 0, 1})) << format;
    EXPECT_EQ(scene.geometries[0].mesh[0].b, (Vec3d{0.5, 0, 0})) << format;
    EXPECT_EQ(scene.geometries[0].mesh[0].a, (Vec3d{0, 1.25, 0})) << format;
  }
}

TEST(Ply, UsesFloatVerticesOfTheFileInPlaceAndKeepsItAlive) {
  TriangleMesh mesh;
  {
    Bytes bytes(header("binary_little_endian",
                       "element vertex 3\nproperty uchar tag\nproperty float x\nproperty float y\n"
                       "property float z\nproperty short more\n" +
                           faces(1)));
    for (const float x : {1.f, 2.f, 3.f})
      bytes.add(std::uint8_t{7}, x, 10 * x, 100 * x, std::int16_t{9});
    bytes.add(kThree, 0, 1, 2);
    const FileBytes file = memory_file(bytes.text());
    mesh = read_ply(file).geometries.at(0).mesh;
    EXPECT_GE(mesh.vertices.data, file.bytes.data());
    EXPECT_LT(mesh.vertices.data, file.bytes.data() + file.bytes.size());
    EXPECT_EQ(mesh.vertices.stride, 15u);
  }
  EXPECT_EQ(mesh[0].b, (Vec3d{2, 20, 200}));
}

TEST(Ply, CopiesVerticesOfAFileNobodyKeepsAlive) {
  Bytes bytes(header("binary_little_endian", xyz(3) + faces(1)));
  bytes.add(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f).add(kThree, 0, 1, 2);
  FileBytes file = memory_file(bytes.text());
  const std::shared_ptr<const void> owner = std::move(file.owner);
  file.owner = nullptr;
  const TriangleMesh mesh = read_ply(file).geometries.at(0).mesh;
  EXPECT_TRUE(mesh.vertices.data < file.bytes.data() ||
              mesh.vertices.data >= file.bytes.data() + file.bytes.size());
  EXPECT_EQ(mesh[0].c, (Vec3d{0, 1, 0}));
}

TEST(Ply, KeepsDoublesAsDoubles) {
  Bytes bytes(header("binary_little_endian", xyz(3, "double") + faces(1)));
  bytes.add(0.1, 0., 0., 1., 0., 0., 0., 1., 0.).add(kThree, 0, 1, 2);
  EXPECT_EQ(read(bytes.text()).geometries[0].mesh[0].a.x, 0.1);
  const SceneData ascii =
      read(header("ascii", xyz(3, "float64") + faces(1)) + "0.1 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(ascii.geometries[0].mesh[0].a.x, 0.1);
  const SceneData rounded =
      read(header("ascii", xyz(3) + faces(1)) + "0.1 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(rounded.geometries[0].mesh[0].a.x, static_cast<double>(0.1f));
}

TEST(Ply, ReadsEveryScalarTypeUnderBothNames) {
  const std::string types =
      "property char a\nproperty int8 b\nproperty uchar c\n"
      "property uint8 d\nproperty short e\nproperty int16 f\n"
      "property ushort g\nproperty uint16 h\nproperty int i\n"
      "property int32 j\nproperty uint k\nproperty uint32 l\n"
      "property float m\nproperty float32 n\nproperty double o\n"
      "property float64 p\n";
  constexpr std::size_t kRowBytes = 4 * 1 + 4 * 2 + 4 * 4 + 2 * 4 + 2 * 8;
  Bytes bytes(header("binary_little_endian", "element extra 2\n" + types + xyz(3) + faces(1)) +
              std::string(2 * kRowBytes, '\x55'));
  bytes.add(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f).add(kThree, 0, 1, 2);
  const SceneData scene = read(bytes.text());
  EXPECT_EQ(scene.geometries.at(0).mesh[0].b, (Vec3d{1, 0, 0}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Ply, ReadsIntegerCoordinatesExactly) {
  Bytes bytes(header("binary_big_endian", xyz(3, "int") + faces(1, "int ushort")), true);
  bytes.add(16777217, 0, 0, -5, 0, 0, 0, 1, 0);
  bytes.add(3, std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{2});
  const TriangleMesh mesh = read(bytes.text()).geometries.at(0).mesh;
  EXPECT_EQ(mesh[0].a.x, 16777217.0);
  EXPECT_EQ(mesh[0].b.x, -5.0);
}

TEST(Ply, TakesElementsPropertiesAndListsInAnyOrder) {
  const std::string elements =
      "element face 1\nproperty list uchar float weights\nproperty list uchar int vertex_index\n"
      "property uchar flag\nelement other 2\nproperty list ushort double values\n"
      "element vertex 3\nproperty double z\nproperty list uchar uchar tags\nproperty float y\n"
      "property float x\n";
  Bytes bytes(header("binary_big_endian", elements), true);
  bytes.add(std::uint8_t{2}, 1.f, 2.f).add(kThree, 2, 1, 0).add(std::uint8_t{1});
  bytes.add(std::uint16_t{0}).add(std::uint16_t{1}, 5.0);
  bytes.add(0.1, std::uint8_t{0}, 2.f, 3.f).add(4., std::uint8_t{1}, std::uint8_t{9}, 5.f, 6.f);
  bytes.add(7., std::uint8_t{0}, 8.f, 9.f);
  const SceneData scene = read(bytes.text());
  EXPECT_EQ(triangle(scene, 0), (Triangle{2, 1, 0}));
  EXPECT_EQ(scene.geometries[0].mesh[0].c, (Vec3d{3, 2, 0.1}));
  EXPECT_EQ(scene.geometries[0].mesh[0].b, (Vec3d{6, 5, 4}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Ply, ReadsAsciiFacesBeforeVerticesWithExtraProperties) {
  const SceneData scene =
      read(header("ascii", faces(1) + "property uchar red\nelement vertex 3\n"
                                      "property float y\nproperty float x\nproperty double z\n") +
           "3 0 1 2 255\n1 2 3\n4 5 6\n7 8 9\n");
  EXPECT_EQ(scene.geometries.at(0).mesh[0].b, (Vec3d{5, 4, 6}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Ply, FacesKeepTheOrderOfTheFileAlsoAroundTheVertices) {
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const SceneData scene =
      read(header("ascii", faces(1) + xyz(3) + strips) + "3 0 1 2\n" + kCorners + "3 2 1 0\n");
  ASSERT_EQ(scene.geometries.at(0).size(), 2u);
  EXPECT_EQ(triangle(scene, 0), (Triangle{0, 1, 2}));
  EXPECT_EQ(triangle(scene, 1), (Triangle{2, 1, 0}));
}

TEST(Ply, BodyStartsRightBehindTheLineEndOfTheHeader) {
  for (const std::string ending : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char c : header("binary_little_endian", xyz(3) + faces(1)))
      text += c == '\n' ? ending : std::string(1, c);
    // The first float's first byte is 0x0A.
    const float first = std::bit_cast<float>(std::uint32_t{0x3F80000A});
    Bytes bytes(text);
    bytes.add(first, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f).add(kThree, 0, 1, 2);
    const SceneData scene = read(bytes.text());
    EXPECT_EQ(scene.geometries.at(0).mesh[0].a.x, static_cast<double>(first));
    EXPECT_TRUE(scene.warnings.empty());
  }
}

TEST(Ply, CutsPolygonsAndNamesTheirFaces) {
  const SceneData scene = read(header("ascii", xyz(4) + faces(4)) +
                               "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n2 0 1\n4 0 1 2 3\n0\n");
  EXPECT_EQ(scene.geometries.at(0).face_ids, (std::vector<std::uint32_t>{0, 2, 2}));
  EXPECT_EQ(triangle(scene, 2), (Triangle{0, 2, 3}));
  EXPECT_EQ(scene.warnings, std::vector<std::string>{"2 faces with fewer than 3 vertices skipped"});
}

TEST(Ply, StripsAlternateTheirWindingAndRestart) {
  const SceneData scene =
      read(header("ascii", xyz(4) + "element tristrips 1\nproperty list int int vertex_indices\n") +
           kCorners + "1 1 0\n" + "8 0 1 2 3 -1 3 2 1\n");
  ASSERT_EQ(scene.geometries.at(0).size(), 3u);
  EXPECT_EQ(triangle(scene, 0), (Triangle{0, 1, 2}));
  EXPECT_EQ(triangle(scene, 1), (Triangle{1, 3, 2}));
  EXPECT_EQ(triangle(scene, 2), (Triangle{3, 2, 1}));
}

TEST(Ply, VerticesWithRadiusAndNoFacesAreSpheres) {
  const std::string elements = xyz(2) + "property double radius\n";
  const SceneData scene = read(header("ascii", elements + faces(0)) + "1 2 3 0.1\n4 5 6 -1\n");
  ASSERT_EQ(scene.geometries.size(), 1u);
  EXPECT_EQ(scene.geometries[0].kind, PrimitiveKind::sphere);
  ASSERT_EQ(scene.geometries[0].spheres.size(), 2u);
  EXPECT_EQ(scene.geometries[0].spheres[0].center, (Vec3d{1, 2, 3}));
  EXPECT_EQ(scene.geometries[0].spheres[0].radius, 0.1);
  EXPECT_EQ(scene.geometries[0].spheres[1].radius, -1.0);
}

TEST(Ply, FacesWinOverRadii) {
  const SceneData scene = read(header("ascii", xyz(3) + "property float radius\n" + faces(1)) +
                               "0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n");
  EXPECT_EQ(scene.geometries.at(0).kind, PrimitiveKind::triangle);
}

TEST(Ply, WellFormedFilesWithoutSurfacesAreEmptyWithAWarning) {
  for (const std::string& text :
       {header("ascii", ""), header("ascii", xyz(0) + faces(0)), header("ascii", xyz(3)) + kCorners,
        header("binary_little_endian", xyz(0))}) {
    const SceneData scene = read(text);
    EXPECT_TRUE(scene.geometries.empty()) << text;
    EXPECT_EQ(scene.warnings, std::vector<std::string>{"no triangles"}) << text;
  }
}

TEST(Ply, NotFiniteAndOverflowingCoordinatesAreKept) {
  const SceneData scene =
      read(header("ascii", xyz(3) + faces(1)) + "nan inf 1e400\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Vec3d a = scene.geometries.at(0).mesh[0].a;
  EXPECT_TRUE(std::isnan(a.x));
  EXPECT_TRUE(std::isinf(a.y) && std::isinf(a.z));
}

TEST(Ply, WarnsOfDataBehindTheLastElement) {
  const std::string text = header("ascii", xyz(3) + faces(1)) + kCorners + "3 0 1 2\n3 0 1 2\n";
  EXPECT_EQ(read(text).warnings, std::vector<std::string>{"line 14: data after the elements"});
  EXPECT_TRUE(read(text.substr(0, text.size() - 8) + "\n \n").warnings.empty());
}

TEST(Ply, HeaderErrorsNameTheLine) {
  EXPECT_EQ(error(""), "a.ply: line 1: no PLY file: no line 'ply'");
  EXPECT_EQ(error("plyx\n"), "a.ply: line 1: no PLY file: no line 'ply'");
  EXPECT_EQ(error("ply\nformat ascii 2.0\n"), "a.ply: line 2: unknown PLY version '2.0'");
  EXPECT_EQ(error("ply\nformat text 1.0\n"), "a.ply: line 2: unknown PLY format 'text'");
  EXPECT_EQ(error("ply\nend_header\n"), "a.ply: line 2: header without a format line");
  EXPECT_EQ(error("ply\nproperty float x\n"), "a.ply: line 2: property before any element");
  EXPECT_EQ(error("ply\nelement vertex -1\n"), "a.ply: line 2: negative element count -1");
  EXPECT_EQ(error("ply\nelement vertex\n"), "a.ply: line 2: missing element count");
  EXPECT_EQ(error("ply\nelement vertex 1 2\n"), "a.ply: line 2: unexpected '2'");
  EXPECT_EQ(error("ply\nelement v 1\nelement v 1\n"), "a.ply: line 3: element 'v' repeated");
  EXPECT_EQ(error("ply\nelement v 1\nproperty half x\n"),
            "a.ply: line 3: unknown property type 'half'");
  EXPECT_EQ(error("ply\nelement v 1\nproperty int x\nproperty int x\n"),
            "a.ply: line 4: property 'x' repeated");
  EXPECT_EQ(error("ply\nelement v 1\nproperty list float int x\n"),
            "a.ply: line 3: list count of a type that is no integer");
  EXPECT_EQ(error("ply\ngarbage\n"), "a.ply: line 2: unknown header keyword 'garbage'");
  EXPECT_EQ(error("ply\nformat ascii 1.0\n"), "a.ply: line 3: header without end_header");
}

TEST(Ply, ErrorsOfElementsNameTheirLineInTheHeader) {
  const std::string no_z = "element vertex 1\nproperty float x\nproperty float y\n";
  EXPECT_EQ(error(header("ascii", no_z) + "0 0\n"), "a.ply: line 3: element vertex: no property z");
  EXPECT_EQ(error(header("ascii", no_z + "property list uchar int z\n") + "0 0 0\n"),
            "a.ply: line 3: element vertex: property z is a list");
  EXPECT_EQ(error(header("ascii", xyz(3) + "element face 1\nproperty int a\n") + kCorners + "1\n"),
            "a.ply: line 7: element face: no property vertex_indices or vertex_index");
  EXPECT_EQ(error(header("ascii", xyz(3) + faces(1, "uchar float")) + kCorners + "3 0 1 2\n"),
            "a.ply: line 7: element face: property vertex_indices is not a list of integers");
}

TEST(Ply, BodyErrorsOfTextNameTheLine) {
  const std::string start = header("ascii", xyz(3) + faces(1)) + kCorners;
  EXPECT_EQ(error(start + "3 0 1 3\n"), "a.ply: line 13: face 0: vertex index 3 of 3 vertices");
  EXPECT_EQ(error(start + "3 0 1 -1\n"), "a.ply: line 13: face 0: vertex index -1 of 3 vertices");
  EXPECT_EQ(error(start + "3 0 1 x\n"),
            "a.ply: line 13: vertex index is not a 64-bit integer: 'x'");
  EXPECT_EQ(error(start + "3 0 1 2 0\n"), "a.ply: line 13: more values than the header declares");
  EXPECT_EQ(error(start + "-3 0 1 2\n"), "a.ply: line 13: list of -3 values does not fit the file");
  EXPECT_EQ(error(start + "3 0 1\n"), "a.ply: line 14: missing vertex index");
  EXPECT_EQ(error(header("ascii", xyz(2)) + "0 0 0\n0 0 ,\n"),
            "a.ply: line 9: value is not a number: ','");
}

TEST(Ply, BodyErrorsOfBinaryNameTheByte) {
  const std::string start = header("binary_little_endian", xyz(1) + faces(1));
  Bytes bytes(start);
  bytes.add(0.f, 0.f, 0.f).add(kThree, 0, 0, 1);
  const std::string end = std::to_string(bytes.text().size());
  EXPECT_EQ(error(bytes.text()), "a.ply: byte " + end + ": face 0: vertex index 1 of 1 vertices");
  EXPECT_EQ(error(bytes.text().substr(0, bytes.text().size() - 1)),
            "a.ply: byte " + std::to_string(start.size() + 13) +
                ": list of 3 values does not fit the file");
}

TEST(Ply, CountsBeyondTheFileAreErrorsBeforeAnythingIsReserved) {
  for (const std::string format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::string text =
        header(format,
               "element vertex 9000000000000000000\nproperty float x\nproperty float y\n"
               "property float z\n") +
        std::string(40, '0');
    EXPECT_NE(error(text).find("9000000000000000000 rows of element vertex do not fit the file"),
              std::string::npos)
        << error(text);
  }
}

TEST(Ply, CountsAreComparedWithTheSmallestSizeOfTheirRows) {
  Bytes bytes(header("binary_little_endian", xyz(4)));
  bytes.add(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f);
  EXPECT_NE(error(bytes.text()).find("4 rows of element vertex do not fit"), std::string::npos);
  EXPECT_EQ(error(Bytes(bytes).add(0.f).text()), "no error");
  const std::string text = header("ascii", xyz(3)) + "0 0 0\n0 0 0\n0 0 0";
  EXPECT_EQ(error(text), "no error");
  EXPECT_NE(error(text.substr(0, text.size() - 1)).find("3 rows of element vertex do not fit"),
            std::string::npos);
}

TEST(Ply, RowsWithoutPropertiesTakeNoTime) {
  const std::string text =
      header("ascii", "element nothing 9000000000000000000\n" + xyz(3) + faces(1)) + kCorners +
      "3 0 1 2\n";
  EXPECT_EQ(read(text).geometries.at(0).size(), 1u);
}

TEST(Ply, EveryTruncationOfABinaryFileIsACleanError) {
  Bytes bytes(header("binary_big_endian", faces(1) + xyz(3)), true);
  bytes.add(kThree, 0, 1, 2).add(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f);
  for (std::size_t n = 0; n < bytes.text().size(); ++n)
    EXPECT_NE(error(bytes.text().substr(0, n)), "no error") << n;
  EXPECT_EQ(error(bytes.text()), "no error");
}

}  // namespace
}  // namespace strahl

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <strahl/geometry/mesh_check.h>
#include <strahl/geometry/triangle.h>
#include <strahl/math/coordinate.h>

namespace strahl {
namespace {

using Corners = std::array<std::uint64_t, 3>;

/// An edge of a triangle, its ends in ascending order.
struct Edge {
  std::uint64_t low, high;
  std::uint64_t triangle;
  bool ascending;  ///< the triangle runs from low to high

  bool is_same_edge(const Edge& o) const { return low == o.low && high == o.high; }
  bool operator<(const Edge& o) const {
    return std::tie(low, high) != std::tie(o.low, o.high)
               ? std::tie(low, high) < std::tie(o.low, o.high)
               : triangle < o.triangle;
  }
};

struct Triangle {
  Corners corners;  ///< welded; sorted for comparison
  std::uint64_t id;
};

/// Counts cases and keeps the first ones.
class Findings {
 public:
  explicit Findings(std::size_t keep) : keep_(keep) {
    for (int d = 0; d < kMeshDefects; ++d) findings_.push_back({static_cast<MeshDefect>(d), 0, {}});
  }
  void add(MeshDefect defect, std::uint64_t primitive) {
    MeshFinding& finding = findings_[static_cast<std::size_t>(defect)];
    ++finding.count;
    finding.first.push_back(primitive);
    // Edges come in no order of triangles, so now and then only the smallest are kept.
    if (finding.first.size() >= 2 * keep_ + 1024) shorten(finding);
  }
  std::vector<MeshFinding> take() {
    for (MeshFinding& finding : findings_) shorten(finding);
    std::erase_if(findings_, [](const MeshFinding& finding) { return finding.count == 0; });
    return std::move(findings_);
  }

 private:
  void shorten(MeshFinding& finding) const {
    std::sort(finding.first.begin(), finding.first.end());
    finding.first.resize(std::min(finding.first.size(), keep_));
  }

  std::size_t keep_;
  std::vector<MeshFinding> findings_;
};

/// For each vertex the lowest number of a vertex at the same position; itself where not finite.
std::vector<std::uint64_t> weld(const VertexView& vertices) {
  const auto key = [&](std::uint64_t i) {
    const Vec3d v = vertices[i];
    return std::tuple(v.x, v.y, v.z);
  };
  std::vector<std::uint64_t> order;
  for (std::uint64_t i = 0; i < vertices.count; ++i)
    if (is_finite(vertices[i])) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::uint64_t a, std::uint64_t b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  std::vector<std::uint64_t> welded(vertices.count);
  std::iota(welded.begin(), welded.end(), std::uint64_t{0});
  for (std::size_t i = 1; i < order.size(); ++i)
    if (key(order[i]) == key(order[i - 1])) welded[order[i]] = welded[order[i - 1]];
  return welded;
}

bool has_all_vertices(const TriangleMesh& mesh, std::size_t i) {
  const IndexView::Triple t = mesh.triangles[i];
  return std::max({t.a, t.b, t.c}) < mesh.vertices.count;
}

/// Defects of a triangle by itself; returns whether its edges mean something.
bool check_alone(const TriangleMesh& mesh, std::size_t i, Findings& findings) {
  if (!has_all_vertices(mesh, i)) {
    findings.add(MeshDefect::out_of_range, i);
    return false;
  }
  const TriangleVertices tri = mesh[i];
  if (is_out_of_range(tri.a) || is_out_of_range(tri.b) || is_out_of_range(tri.c)) {
    findings.add(MeshDefect::out_of_range, i);
    return true;
  }
  switch (find_defect(tri)) {
    case TriangleDefect::none:
      return true;
    case TriangleDefect::zero_area:
      findings.add(MeshDefect::zero_area, i);
      return true;
    case TriangleDefect::repeated_vertex:
      findings.add(MeshDefect::repeated_vertex, i);
      return false;
    case TriangleDefect::not_finite:
      break;
  }
  findings.add(MeshDefect::not_finite, i);
  return false;
}

void check_duplicates(std::vector<Triangle>& triangles, Findings& findings) {
  for (Triangle& t : triangles) std::sort(t.corners.begin(), t.corners.end());
  std::sort(triangles.begin(), triangles.end(), [](const Triangle& a, const Triangle& b) {
    return a.corners != b.corners ? a.corners < b.corners : a.id < b.id;
  });
  for (std::size_t i = 1; i < triangles.size(); ++i)
    if (triangles[i].corners == triangles[i - 1].corners)
      findings.add(MeshDefect::duplicate_triangle, triangles[i].id);
}

void check_edges(const std::vector<Triangle>& triangles, Findings& findings) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t from = t.corners[k], to = t.corners[(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), t.id, from < to});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].is_same_edge(edges[i])) ++end;
    if (end - i == 1)
      findings.add(MeshDefect::open_edge, edges[i].triangle);
    else if (end - i > 2)
      findings.add(MeshDefect::non_manifold_edge, edges[i].triangle);
    else if (edges[i].ascending == edges[i + 1].ascending)
      findings.add(MeshDefect::inconsistent_winding, edges[i].triangle);
    i = end;
  }
}

void check_triangles(const TriangleMesh& mesh, Findings& findings) {
  const std::vector<std::uint64_t> welded = weld(mesh.vertices);
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!check_alone(mesh, i, findings)) continue;
    const IndexView::Triple t = mesh.triangles[i];
    triangles.push_back({{welded[t.a], welded[t.b], welded[t.c]}, i});
  }
  check_edges(triangles, findings);
  check_duplicates(triangles, findings);
}

}  // namespace

std::string_view name_of(MeshDefect defect) {
  static constexpr std::array<std::string_view, kMeshDefects> kNames{
      "zero_area",    "repeated_vertex",      "not_finite",
      "out_of_range", "duplicate_triangle",   "non_manifold_edge",
      "open_edge",    "inconsistent_winding", "invalid_curved"};
  return kNames[static_cast<std::size_t>(defect)];
}

std::vector<MeshFinding> check_mesh(const Geometry& geometry, std::size_t keep) {
  Findings findings(keep);
  if (geometry.kind == PrimitiveKind::triangle) check_triangles(geometry.mesh, findings);
  const bool is_sphere = geometry.kind == PrimitiveKind::sphere;
  for (std::size_t i = 0; geometry.kind != PrimitiveKind::triangle && i < geometry.size(); ++i)
    if ((is_sphere ? bounds(geometry.spheres[i]) : bounds(geometry.cones[i])).is_empty())
      findings.add(MeshDefect::invalid_curved, i);
  return findings.take();
}

}  // namespace strahl

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <libqhull_r/qhull_ra.h>
#include <memory>
#include <stdexcept>

#include <strahl/bounds/convex_hull.h>

namespace strahl {
namespace {

/// qhull explains flat input at length; nobody reads it.
std::FILE* open_sink() {
  std::FILE* sink = std::fopen("/dev/null", "w");
  if (sink == nullptr) sink = std::tmpfile();
  if (sink == nullptr) throw std::runtime_error("convex hull: no place for messages");
  return sink;
}

/// One run of qhull and its memory.
class Qhull {
 public:
  Qhull() : messages_(open_sink()), state_(std::make_unique<qhT>()) {
    qh_zero(state_.get(), messages_);
  }
  ~Qhull() {
    qh_freeqhull(state_.get(), !qh_ALL);
    int left = 0, total = 0;
    qh_memfreeshort(state_.get(), &left, &total);
    std::fclose(messages_);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  /// False where the points have no volume.
  bool run(std::vector<double>& coordinates) {
    char command[] = "qhull Qt Pp";
    return qh_new_qhull(state_.get(), 3, static_cast<int>(coordinates.size() / 3),
                        coordinates.data(), False, command, nullptr, messages_) == 0;
  }
  qhT* state() { return state_.get(); }

 private:
  std::FILE* messages_;
  std::unique_ptr<qhT> state_;
};

std::uint32_t point_index(qhT* qh, const vertexT* vertex) {
  return static_cast<std::uint32_t>(qh_pointid(qh, vertex->point));
}

std::array<std::uint32_t, 3> outward(qhT* qh, const facetT* facet, std::span<const Vec3d> points) {
  std::array<std::uint32_t, 3> t;
  for (std::size_t i = 0; i < 3; ++i)
    t[i] = point_index(qh, static_cast<vertexT*>(facet->vertices->e[i].p));
  const Vec3d n = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
  if (dot(n, {facet->normal[0], facet->normal[1], facet->normal[2]}) < 0.0) std::swap(t[1], t[2]);
  return t;
}

double turn(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

std::optional<ConvexHull> convex_hull(std::span<const Vec3d> points) {
  if (points.size() < 4) return std::nullopt;
  std::vector<double> coordinates;
  coordinates.reserve(3 * points.size());
  for (const Vec3d& p : points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  Qhull run;
  if (!run.run(coordinates)) return std::nullopt;
  qhT* qh = run.state();
  ConvexHull hull;
  const vertexT* vertex = nullptr;
  FORALLvertices hull.vertices.push_back(point_index(qh, vertex));
  const facetT* facet = nullptr;
  FORALLfacets hull.triangles.push_back(outward(qh, facet, points));
  std::sort(hull.vertices.begin(), hull.vertices.end());
  return hull;
}

std::vector<Vec2d> convex_polygon(std::vector<Vec2d> points) {
  const auto before = [](const Vec2d& a, const Vec2d& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  };
  const auto same = [](const Vec2d& a, const Vec2d& b) { return a.x == b.x && a.y == b.y; };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2d> chain;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = chain.size();
    for (const Vec2d& p : points) {
      while (chain.size() >= start + 2 && turn(chain[chain.size() - 2], chain.back(), p) <= 0.0)
        chain.pop_back();
      chain.push_back(p);
    }
    chain.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return chain;
}

}  // namespace strahl

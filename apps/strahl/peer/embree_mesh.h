// apps/strahl/peer/embree_mesh.h - a mesh as Embree holds it.
#pragma once

#include <cstdint>

#include <embree3/rtcore.h>

#include <strahl/geometry/mesh.h>
#include <strahl/math/affine.h>

namespace strahl::peer {

/// A geometry with the triangles of a mesh where `to_world` puts them, its vertices rounded to
/// floats. Neither committed nor attached; the caller releases it.
inline RTCGeometry new_triangles(RTCDevice device, const TriangleMesh& mesh,
                                 const Affine& to_world) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), mesh.vertices.count));
  for (std::size_t i = 0; i < mesh.vertices.count; ++i)
    vertices[i] = Vec3f(to_world.point(mesh.vertices[i]));
  auto* corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.size()));
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const IndexView::Triple t = mesh.triangles[i];
    for (const std::uint64_t v : {t.a, t.b, t.c}) *corners++ = static_cast<std::uint32_t>(v);
  }
  return geometry;
}

}  // namespace strahl::peer

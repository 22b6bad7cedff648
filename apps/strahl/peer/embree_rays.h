// apps/strahl/peer/embree_rays.h - rays written as Embree wants them, with 16-byte stores: scalar
// ones would cost it failed store forwarding.
//
// Thread safety: pure functions.
#pragma once

#include <algorithm>
#include <apps/strahl/peer/float_rays.h>
#include <cstring>
#include <iterator>
#include <span>

#include <embree3/rtcore.h>
#include <immintrin.h>

namespace strahl::peer {

/// A ray record is org, t_min, dir, t_max; Embree's is org, tnear, dir, time, tfar, mask, ...
inline void write_ray(const FloatRay& from, RTCRay& to) {
  const auto* source = reinterpret_cast<const float*>(&from);
  const __m128 first = _mm_loadu_ps(source), second = _mm_loadu_ps(source + 4);
  const __m128 dir = _mm_insert_ps(second, second, 0x08);  // time 0
  _mm_store_ps(&to.org_x, first);
  _mm_store_ps(&to.dir_x, dir);
  _mm_store_ps(&to.tfar, _mm_castsi128_ps(_mm_set_epi32(0, 0, -1, _mm_extract_ps(second, 3))));
}

/// Four records of four floats each become rows.
inline void write_rows(const float* const from[4], float* x, float* y, float* z, float* w) {
  __m128 a = _mm_loadu_ps(from[0]), b = _mm_loadu_ps(from[1]);
  __m128 c = _mm_loadu_ps(from[2]), d = _mm_loadu_ps(from[3]);
  _MM_TRANSPOSE4_PS(a, b, c, d);
  _mm_store_ps(x, a), _mm_store_ps(y, b), _mm_store_ps(z, c), _mm_store_ps(w, d);
}

/// As many rays as a packet holds at most; `valid` is -1 for those there are.
template <class Packet>
void write_packet(std::span<const FloatRay> rays, Packet& to, int* valid) {
  for (std::size_t first = 0; first < std::size(to.org_x); first += 4) {
    const float* from[4];
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t ray = std::min(first + i, rays.size() - 1);
      from[i] = reinterpret_cast<const float*>(&rays[ray]);
      valid[first + i] = first + i < rays.size() ? -1 : 0;
    }
    write_rows(from, to.org_x + first, to.org_y + first, to.org_z + first, to.tnear + first);
    for (const float*& f : from) f += 4;
    write_rows(from, to.dir_x + first, to.dir_y + first, to.dir_z + first, to.tfar + first);
  }
  std::memset(to.time, 0, sizeof to.time), std::memset(to.flags, 0, sizeof to.flags);
  std::memset(to.mask, 0xff, sizeof to.mask);
}

}  // namespace strahl::peer

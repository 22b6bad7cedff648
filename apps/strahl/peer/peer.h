// apps/strahl/peer/peer.h - another ray tracer over the same triangles, asked ray by ray or by each
// of its interfaces for many. The only one is Embree 3, where the build has found it.
//
// Thread safety: const methods, one call at a time.
#pragma once

#include <apps/strahl/peer/float_rays.h>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <strahl/base/executor.h>
#include <strahl/geometry/scene.h>

namespace strahl::peer {

/// What a peer writes per ray.
struct PeerHit {
  float t;
  std::uint32_t prim;
  float u, v;
  bool is_hit() const { return prim != ~std::uint32_t{0}; }
};

/// How rays are handed over: one by one, eight or sixteen at a time or in streams, all but the
/// first also with the flag that calls them coherent.
enum class PeerApi {
  single,
  packet8,
  coherent_packet8,
  packet16,
  coherent_packet16,
  stream,
  coherent_stream
};
inline constexpr PeerApi kPeerApis[] = {
    PeerApi::single,         PeerApi::packet8,           PeerApi::coherent_packet8,
    PeerApi::packet16,       PeerApi::coherent_packet16, PeerApi::stream,
    PeerApi::coherent_stream};
const char* name_of(PeerApi api);

enum class PeerQuality { medium, high };

struct PeerOptions {
  PeerQuality quality = PeerQuality::high;
  std::string isa;    ///< best instruction set it may use, named as by STRAHL_ISA; empty: any
  Executor executor;  ///< as many threads build; one traces
};

class Peer {
 public:
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// One result per ray.
  virtual void closest(PeerApi api, std::span<const FloatRay> rays,
                       std::span<PeerHit> hits) const = 0;
  /// 1 where the ray hits anything, else 0.
  virtual void any(PeerApi api, std::span<const FloatRay> rays,
                   std::span<std::uint8_t> occluded) const = 0;
  /// By Stopwatch, without the copying of vertices and indices.
  virtual double build_seconds() const = 0;
  /// Live bytes, without its copy of vertices and indices.
  virtual std::int64_t bytes() const = 0;

 protected:
  Peer() = default;
};

/// Throws Error{unsupported} where this program was built without a peer.
void require_peer();

/// All triangles of all instances, in world space and rounded to float32.
/// Throws Error: unsupported for other primitives and as require_peer(); usage for an instruction
/// set the peer does not know.
std::unique_ptr<Peer> make_peer(const Scene& scene, const PeerOptions& options);

}  // namespace strahl::peer

// Takes the place of embree_peer.cpp where Embree was not found.
#include <apps/strahl/peer/peer.h>

#include <strahl/base/error.h>

namespace strahl::peer {

void require_peer() {
  throw Error(ErrorCode::unsupported,
              "this program was built without Embree 3.13 (Debian: libembree-dev)", "--peer");
}

std::unique_ptr<Peer> make_peer(const Scene&, const PeerOptions&) {
  require_peer();
  return nullptr;
}

}  // namespace strahl::peer

#include <apps/strahl/peer/peer.h>

namespace strahl::peer {

const char* name_of(PeerApi api) {
  switch (api) {
    case PeerApi::single:
      return "single";
    case PeerApi::packet8:
      return "packet of 8";
    case PeerApi::coherent_packet8:
      return "coherent packet of 8";
    case PeerApi::packet16:
      return "packet of 16";
    case PeerApi::coherent_packet16:
      return "coherent packet of 16";
    case PeerApi::stream:
      return "stream";
    case PeerApi::coherent_stream:
      return "coherent stream";
  }
  return "";
}

}  // namespace strahl::peer

// structures/proximity_cloud/proximity_cloud.h - A uniform grid whose empty cells tell how far the nearest occupied cell is.
//
// Paper:      (key in docs/references.bib)
// Layout:     one box, then the references of everything that can be hit, ascending.
// Invariants: every reference with a non-empty box, exactly once, inside the box.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <vector>

#include <strahl/base/hash.h>
#include <strahl/base/options.h>
#include <strahl/build/build_report.h>
#include <strahl/build/prim_ref.h>
#include <strahl/traverse/leaf.h>

namespace strahl {

struct ProximityCloudOptions {
  bool box_first = true;
};

OptionTable<ProximityCloudOptions> option_fields(const ProximityCloudOptions*);

/// O(n) per ray that meets the box. 4 bytes per primitive.
class ProximityCloud {
 public:
  using Options = ProximityCloudOptions;
  static constexpr const char* kName = "proximity_cloud";
  static constexpr const char* kTitle = "A uniform grid whose empty cells tell how far the nearest occupied cell is";
  static constexpr bool kRefersOnce = true;

  ProximityCloud(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (box_first_) {
      counters.volume_tests(1);
      const Interval span = clip_to_box(ray, box_.lo, box_.hi, {ray.t_enter, ray.t_exit});
      if (span.t_enter > span.t_exit) return;
    }
    test_leaf(references_, prims, ray, query, counters);
  }

  BuildReport report() const;
  /// Throws std::logic_error naming the first broken invariant.
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

 private:
  Aabb box_;
  std::vector<std::uint32_t> references_;
  bool box_first_;
};

}  // namespace strahl

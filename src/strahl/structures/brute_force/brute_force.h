// structures/brute_force/brute_force.h - tests every primitive: the oracle of all other structures.
//
// Layout: the references of everything that can be hit, ascending.
// Invariants: every reference with a non-empty box, exactly once.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <vector>

#include <strahl/base/hash.h>
#include <strahl/base/options.h>
#include <strahl/build/build_report.h>
#include <strahl/build/prim_ref.h>
#include <strahl/traverse/leaf.h>

namespace strahl {

struct BruteForceOptions {};

inline OptionTable<BruteForceOptions> option_fields(const BruteForceOptions*) { return {}; }

/// O(n) per ray. 4 bytes per primitive.
class BruteForce {
 public:
  using Options = BruteForceOptions;
  static constexpr const char* kName = "brute_force";
  static constexpr const char* kTitle = "every primitive, the oracle";
  static constexpr bool kRefersOnce = true;

  BruteForce(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    test_leaf(references_, prims, ray, query, counters);
  }

  BuildReport report() const;
  /// Throws std::logic_error naming the first broken invariant.
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

 private:
  std::vector<std::uint32_t> references_;
};

}  // namespace strahl

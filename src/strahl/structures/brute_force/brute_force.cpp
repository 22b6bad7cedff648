#include <span>
#include <stdexcept>

#include <strahl/structures/brute_force/brute_force.h>

namespace strahl {

BruteForce::BruteForce(const PrimitiveSource& source, const Options&, const BuildContext& context) {
  context.require_memory(std::uint64_t{source.size()} * sizeof(std::uint32_t), "references");
  references_.reserve(source.size());
  for (std::uint32_t i = 0; i < source.size(); ++i) {
    if (i % (1u << 14) == 0) context.check(static_cast<double>(i) / source.size(), "listing");
    if (!source.bounds(i).is_empty()) references_.push_back(i);
  }
}

BuildReport BruteForce::report() const {
  BuildReport report;
  report.nodes = report.leaves = 1;
  report.empty_leaves = references_.empty();
  report.references = references_.size();
  report.bytes = references_.capacity() * sizeof(std::uint32_t);
  report.sah_cost = static_cast<double>(references_.size());
  return report;
}

void BruteForce::validate(const PrimitiveSource& source) const {
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < source.size(); ++i) {
    if (source.bounds(i).is_empty()) continue;
    if (next == references_.size() || references_[next++] != i)
      throw std::logic_error("brute_force: a primitive that can be hit is not listed once");
  }
  if (next != references_.size()) throw std::logic_error("brute_force: lists a refused primitive");
}

void BruteForce::hash_into(Hash64& hash) const {
  hash.add(std::span<const std::uint32_t>(references_));
}

}  // namespace strahl

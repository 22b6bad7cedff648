// tests/conformance/oracle.h - all answers of one accelerator, and their bitwise comparison.
#pragma once

#include <memory>
#include <string>
#include <tests/conformance/rays.h>
#include <tests/support/shared.h>

#include <strahl/catalog/catalog.h>

namespace strahl::test {

/// Every answer to a ray set, with and without filters.
struct Answers {
  std::vector<Hit> closest[2];
  std::vector<std::uint8_t> any[2];
  std::vector<std::uint32_t> counts[2];
  AllHits all[2];
  std::vector<Side> sides;
  std::uint64_t invalid_rays = 0;
};

/// @param span_size 0: one batch; else the rays are sent in batches of that many
Answers ask(const Accelerator& accelerator, const RaySet& set, const BuildContext& context,
            std::size_t span_size = 0);

/// Empty when all answers have the same bits; else what differs first.
std::string first_difference(const Answers& got, const Answers& expected);

/// Rays for a scene and what brute force says to them.
struct Expected {
  RaySet set;
  Answers answers;
};
Expected expected_answers(const std::shared_ptr<const Scene>& scene, std::size_t rays,
                          std::uint64_t seed);

/// Builds the structure, validates it and asks it all. Empty when it answers as expected.
std::string first_difference(const std::shared_ptr<const Scene>& scene, const std::string& spec,
                             const Expected& expected);

/// The bits of a hit that are part of the contract.
bool have_same_bits(const Hit& a, const Hit& b);

}  // namespace strahl::test

// tests/conformance/variants.h - the finite matrix of SPECs of a structure, made from its options.
#pragma once

#include <string>
#include <vector>

#include <strahl/catalog/catalog.h>

namespace strahl::test {

/// Defaults and every option value alone.
std::vector<std::string> one_at_a_time(const StructureEntry& entry);
/// Every pair of values of two different options.
std::vector<std::string> all_pairs(const StructureEntry& entry);
/// Every combination of values; empty where there would be more than `limit`.
std::vector<std::string> full_product(const StructureEntry& entry, std::size_t limit);

}  // namespace strahl::test

// tests/conformance/variants.h - the finite matrix of SPECs of a structure, made from its options.
//
// Values of an option: all words of an enum or switch and all of up to four numbers; of more
// numbers the default, the minimum and one value on each side of the default.
#pragma once

#include <string>
#include <vector>

#include <strahl/catalog/catalog.h>

namespace strahl::test {

/// Defaults and every option value alone.
std::vector<std::string> one_at_a_time(const StructureEntry& entry);

/// Numbers that those leave out, alone: every one of up to nine, the last of up to 65.
std::vector<std::string> outer_values(const StructureEntry& entry);

/// SPECs such that any values of any `strength` options occur together in one of them: a covering
/// array, built greedily. strength is 1 to 4; structures with fewer options get their full product.
std::vector<std::string> covering(const StructureEntry& entry, std::size_t strength);

/// Every combination of words, numbers being their default or minimum; empty where there would be
/// more than `limit`.
std::vector<std::string> full_product(const StructureEntry& entry, std::size_t limit);

}  // namespace strahl::test

// build/sort_few.h - up to sixteen numbers sorted without a branch.
//
// Source: [Batcher1968], odd-even merging: always the same exchanges, so nothing is mispredicted.
// Thread safety: pure functions.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace strahl {
namespace sort_few_detail {

template <class Visit>
constexpr void each_exchange(std::size_t n, Visit visit) {
  for (std::size_t p = 1; p < n; p *= 2)
    for (std::size_t k = p; k >= 1; k /= 2)
      for (std::size_t j = k % p; j + k < n; j += 2 * k)
        for (std::size_t i = j; i < j + k && i + k < n; ++i)
          if (i / (2 * p) == (i + k) / (2 * p)) visit(i, i + k);
}

constexpr std::size_t exchanges(std::size_t n) {
  std::size_t count = 0;
  each_exchange(n, [&](std::size_t, std::size_t) { ++count; });
  return count;
}

template <std::size_t N>
inline constexpr auto kExchanges = [] {
  std::array<std::pair<std::size_t, std::size_t>, exchanges(N)> pairs;
  std::size_t at = 0;
  each_exchange(N, [&](std::size_t a, std::size_t b) { pairs[at++] = {a, b}; });
  return pairs;
}();

template <std::size_t N, std::size_t... I>
void exchange_all(std::array<std::uint32_t, N>& v, std::index_sequence<I...>) {
  const auto exchange = [&v](std::size_t a, std::size_t b) {
    const std::uint32_t less = std::min(v[a], v[b]), more = std::max(v[a], v[b]);
    v[a] = less, v[b] = more;
  };
  (exchange(kExchanges<N>[I].first, kExchanges<N>[I].second), ...);
}

template <std::size_t N>
void sort_padded(std::span<std::uint32_t> values) {
  std::array<std::uint32_t, N> v;
  for (std::size_t i = 0; i < N; ++i) v[i] = i < values.size() ? values[i] : ~0u;
  exchange_all(v, std::make_index_sequence<exchanges(N)>());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = v[i];
}

}  // namespace sort_few_detail

/// Ascending. Fast for at most sixteen.
inline void sort_few(std::span<std::uint32_t> values) {
  if (values.size() <= 4) return sort_few_detail::sort_padded<4>(values);
  if (values.size() <= 8) return sort_few_detail::sort_padded<8>(values);
  if (values.size() <= 16) return sort_few_detail::sort_padded<16>(values);
  std::sort(values.begin(), values.end());
}

}  // namespace strahl

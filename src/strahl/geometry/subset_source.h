// geometry/subset_source.h - a source of which some things are out: for structures that things are
// taken out of and put in again.
//
// Numbers stay those of the whole. A hidden thing has an empty box, as what can never be hit.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <vector>

#include <strahl/geometry/outline.h>
#include <strahl/geometry/primitive_source.h>

namespace strahl {

class SubsetSource final : public PrimitiveSource {
 public:
  /// All of it at first. The whole must outlive the subset.
  explicit SubsetSource(const PrimitiveSource& whole)
      : whole_(whole), is_hidden_(whole.size(), false) {}

  /// i < size(). O(1).
  void hide(std::uint32_t i) { is_hidden_[i] = true; }
  void show(std::uint32_t i) { is_hidden_[i] = false; }
  bool is_hidden(std::uint32_t i) const { return is_hidden_[i]; }

  std::uint32_t size() const override { return whole_.size(); }
  Aabb bounds(std::uint32_t i) const override { return is_hidden_[i] ? Aabb{} : whole_.bounds(i); }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    return is_hidden_[i] ? Aabb{} : whole_.clip(i, box);
  }
  Outline outline(std::uint32_t i) const override { return whole_.outline(i); }
  bool triangle(std::uint32_t i, TriangleVertices& vertices) const override {
    return !is_hidden_[i] && whole_.triangle(i, vertices);
  }

 private:
  const PrimitiveSource& whole_;
  std::vector<bool> is_hidden_;
};

}  // namespace strahl

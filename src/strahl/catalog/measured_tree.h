// catalog/measured_tree.h - what structures offer to measures of trees.
#pragma once

#include <concepts>
#include <memory>
#include <optional>

#include <strahl/build/side_tree.h>

namespace strahl {

/// A structure that is a tree of boxes, under all of its options or some.
template <class S>
concept HasBoxTree = requires(const S& s) {
  { s.box_tree() } -> std::convertible_to<std::optional<BoxTree>>;
};

/// A structure that is a tree of volumes, with trees below it or without, or that may be.
template <class S>
concept HasSideTree = requires(const S& s) {
  { s.side_tree() } -> std::same_as<std::shared_ptr<const SideTree>>;
};

/// Null where it is no tree of volumes.
template <class S>
std::shared_ptr<const SideTree> side_tree_of(const S& structure) {
  if constexpr (HasSideTree<S>) {
    return structure.side_tree();
  } else if constexpr (HasBoxTree<S>) {
    if (std::optional<BoxTree> boxes = structure.box_tree())
      return std::make_shared<const SideTree>(make_side_tree(*std::move(boxes)));
  }
  return nullptr;
}

}  // namespace strahl

#!/usr/bin/env python3
"""Writes the folder of a new structure from the skeleton and registers it.

usage: tools/new_structure.py NAME TypeName "title" [--root DIR]

NAME is lower case with underscores. The skeleton is a complete structure (one box around a list), so
it builds and passes the conformance suite before you change a line.
"""
import argparse
import pathlib
import re
import sys

HEADER = '''// structures/{name}/{name}.h - {title}.
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

namespace strahl {{

struct {type}Options {{
  bool box_first = true;
}};

OptionTable<{type}Options> option_fields(const {type}Options*);

/// O(n) per ray that meets the box. 4 bytes per primitive.
class {type} {{
 public:
  using Options = {type}Options;
  static constexpr const char* kName = "{name}";
  static constexpr const char* kTitle = "{title}";
  static constexpr bool kRefersOnce = true;

  {type}(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {{
    if (box_first_) {{
      counters.volume_tests(1);
      const Interval span = clip_to_box(ray, box_.lo, box_.hi, {{ray.t_enter, ray.t_exit}});
      if (span.t_enter > span.t_exit) return;
    }}
    test_leaf(references_, prims, ray, query, counters);
  }}

  BuildReport report() const;
  /// Throws std::logic_error naming the first broken invariant.
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

 private:
  Aabb box_;
  std::vector<std::uint32_t> references_;
  bool box_first_;
}};

}}  // namespace strahl
'''

SOURCE = '''#include <strahl/structures/{name}/{name}.h>

#include <span>
#include <stdexcept>

namespace strahl {{

OptionTable<{type}Options> option_fields(const {type}Options*) {{
  return {{option("box_first", &{type}Options::box_first, "test the box around all first")}};
}}

{type}::{type}(const PrimitiveSource& source, const Options& options, const BuildContext& context)
    : box_first_(options.box_first) {{
  for (const PrimRef& ref : make_prim_refs(source, context)) {{
    box_.extend(ref.box);
    references_.push_back(ref.reference);
  }}
}}

BuildReport {type}::report() const {{
  BuildReport report;
  report.nodes = report.leaves = 1;
  report.empty_leaves = references_.empty();
  report.references = references_.size();
  report.bytes = references_.capacity() * sizeof(std::uint32_t);
  report.sah_cost = static_cast<double>(references_.size());
  return report;
}}

void {type}::validate(const PrimitiveSource& source) const {{
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < source.size(); ++i) {{
    const Aabb box = source.bounds(i);
    if (box.is_empty()) continue;
    if (next == references_.size() || references_[next++] != i || !box_.contains(box))
      throw std::logic_error("{name}: a primitive that can be hit is not listed once in the box");
  }}
}}

void {type}::hash_into(Hash64& hash) const {{
  hash.add(std::span<const std::uint32_t>(references_));
}}

}}  // namespace strahl
'''

TEST = '''#include <strahl/structures/{name}/{name}.h>

#include <gtest/gtest.h>

#include <strahl/geometry/scene.h>

namespace strahl {{
namespace {{

TEST({type}, AnEmptySceneHasAnEmptyLeaf) {{
  const Scene scene{{SceneData{{}}}};
  const {type} structure(scene, {{}}, {{}});
  EXPECT_EQ(structure.report().empty_leaves, 1u);
  structure.validate(scene);
}}

}}  // namespace
}}  // namespace strahl
'''

README = '''# {name}

{title}. Say here when to choose it, show a picture of it on a real scene, and give one measured row.
`strahl list` prints its options with ranges and defaults.
'''


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("name")
    parser.add_argument("type")
    parser.add_argument("title")
    parser.add_argument("--root", default=pathlib.Path(__file__).resolve().parent.parent)
    given = parser.parse_args()
    if not re.fullmatch(r"[a-z][a-z0-9_]*", given.name):
        sys.exit(f"new_structure: '{given.name}' is not lower case with underscores")
    source = pathlib.Path(given.root) / "src" / "strahl"
    folder = source / "structures" / given.name
    if folder.exists():
        sys.exit(f"new_structure: {folder} exists")
    folder.mkdir(parents=True)
    files = {f"{given.name}.h": HEADER, f"{given.name}.cpp": SOURCE,
             f"{given.name}_test.cpp": TEST, "README.md": README}
    for name, text in files.items():
        (folder / name).write_text(text.format(name=given.name, type=given.type, title=given.title))
    with open(source / "catalog" / "structures.def", "a", encoding="utf-8") as registry:
        registry.write(f"STRAHL_STRUCTURE({given.name}, {given.type})\n")
    print(f"wrote {folder} and its line in structures.def")


if __name__ == "__main__":
    main()

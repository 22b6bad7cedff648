// tests/support/gltf_file.h - builds small glTF files in memory, as GLB or as text.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <tests/support/memory_file.h>
#include <vector>

#include <nlohmann/json.hpp>

#include <strahl/io/gltf.h>

namespace strahl::test {

/// Component types by their numbers in the format.
inline constexpr int kInt8 = 5120, kUint8 = 5121, kInt16 = 5122, kUint16 = 5123, kUint32 = 5125,
                     kFloat = 5126;

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
  }
  return text;
}

inline void append_u32(std::string& bytes, std::uint32_t value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A GLB of a JSON chunk and a BIN chunk.
inline std::string make_glb(std::string json, std::string bin) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  bin.resize((bin.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  append_u32(bytes, 2);
  append_u32(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + bin.size()));
  append_u32(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append_u32(bytes, static_cast<std::uint32_t>(bin.size()));
  bytes += std::string("BIN\0", 4) + bin;
  return bytes;
}

/// A document in the making; `root` may be edited at will.
struct GltfFile {
  nlohmann::json root = {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", {0}}}}}};
  std::string bin;

  /// Adds a buffer view of these bytes; returns its index.
  template <class T>
  std::size_t view(const std::vector<T>& values) {
    bin.resize((bin.size() + 3) / 4 * 4, '\0');
    root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", values.size() * sizeof(T)}});
    bin.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return root["bufferViews"].size() - 1;
  }
  /// Adds an accessor over a new buffer view; returns its index.
  template <class T>
  std::size_t accessor(const std::vector<T>& values, int component_type, const char* type,
                       std::size_t components) {
    const std::size_t buffer_view = view(values);
    return add("accessors", {{"bufferView", buffer_view},
                             {"componentType", component_type},
                             {"count", values.size() / components},
                             {"type", type}});
  }
  std::size_t positions(const std::vector<float>& xyz) { return accessor(xyz, kFloat, "VEC3", 3); }
  std::size_t indices(const std::vector<std::uint16_t>& values) {
    return accessor(values, kUint16, "SCALAR", 1);
  }
  /// Appends to a top-level array; returns the index.
  std::size_t add(const char* list, nlohmann::json item) {
    root[list].push_back(std::move(item));
    return root[list].size() - 1;
  }
  /// A mesh of one primitive without indices.
  std::size_t mesh(std::size_t position_accessor) {
    return add("meshes", {{"primitives", {{{"attributes", {{"POSITION", position_accessor}}}}}}});
  }

  std::string glb() const {
    nlohmann::json complete = root;
    complete["buffers"] = {{{"byteLength", bin.size()}}};
    return make_glb(complete.dump(), bin);
  }
  std::string text() const {
    nlohmann::json complete = root;
    complete["buffers"] = {{{"byteLength", bin.size()},
                            {"uri", "data:application/octet-stream;base64," + base64(bin)}}};
    return complete.dump();
  }
  SceneData read() const { return read_gltf(memory_file(glb(), "a.glb")); }
  std::string error() const {
    return error_of([this] { read(); });
  }
};

/// One triangle (0,0,0) (1,0,0) (0,1,0) as mesh 0, without nodes.
inline GltfFile one_triangle() {
  GltfFile file;
  file.mesh(file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0}));
  return file;
}

/// The vertex indices of a mesh, three per triangle.
inline std::vector<std::uint64_t> indices_of(const TriangleMesh& mesh) {
  std::vector<std::uint64_t> indices;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const IndexView::Triple t = mesh.triangles[i];
    indices.insert(indices.end(), {t.a, t.b, t.c});
  }
  return indices;
}

}  // namespace strahl::test

// io/exr.h - images as OpenEXR: linear colour, depth, ids and normals in full precision.
//
// No threads are started; equal images give byte-identical files.
#pragma once

#include <filesystem>

#include <strahl/io/image.h>

namespace strahl {

/// Writes R, G, B as 32-bit floats and every other channel under its name, as 32-bit floats or
/// unsigned integers, ZIP-compressed without loss. The file appears when complete.
/// Throws Error{usage} for an incomplete image, Error{resource} when it cannot be written.
void write_exr(const std::filesystem::path& path, const Image& image);

/// Reads a scan-line EXR whose channels are R, G, B and others of 32 bits: what write_exr writes.
/// Channels come in the order of their names. Throws Error{bad_input}.
Image read_exr(const std::filesystem::path& path);

}  // namespace strahl

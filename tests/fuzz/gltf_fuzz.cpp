// tests/fuzz/gltf_fuzz.cpp - no bytes make the glTF reader crash, hang or throw anything but Error.
#include <tests/fuzz/fuzz_reader.h>

#include <strahl/io/gltf.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return strahl::fuzz_reader(strahl::read_gltf, data, size);
}

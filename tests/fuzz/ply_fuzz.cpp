// tests/fuzz/ply_fuzz.cpp - no bytes make the PLY reader crash, hang or throw anything but Error.
#include <tests/fuzz/fuzz_reader.h>

#include <strahl/io/ply.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return strahl::fuzz_reader(strahl::read_ply, data, size);
}

// tests/fuzz/stl_fuzz.cpp - no bytes make the STL reader crash, hang or throw anything but Error.
#include <tests/fuzz/fuzz_reader.h>

#include <strahl/io/stl.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return strahl::fuzz_reader(strahl::read_stl, data, size);
}

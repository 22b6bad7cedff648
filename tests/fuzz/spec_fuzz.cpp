// SPEC text and lists of SPECs: parsed, or refused with an Error; options of every structure, too.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>

namespace {

void parse(std::string_view text) {
  try {
    static const auto empty = std::make_shared<const strahl::Scene>(strahl::SceneData{});
    strahl::build(empty, text);
  } catch (const strahl::Error&) {
    // A refusal is a good answer.
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const std::string& spec : strahl::split_specs(text)) parse(spec);
  parse(text);
  return 0;
}

// apps/strahl/schema_test.cpp - what --json prints is what docs/json says.
#include <apps/strahl/run_test.h>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace strahl::cli {
namespace {

using nlohmann::json;

bool has_type(const json& value, const std::string& type) {
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "array") return value.is_array();
  if (type == "object") return value.is_object();
  return type == "null" && value.is_null();
}

/// Checks the keywords used in docs/json: type, required, properties, items. Keys that the schema
/// does not know are failures.
void expect_valid(const json& value, const json& schema, const std::string& at) {
  bool is_typed = false;
  for (const json& type : schema["type"].is_array() ? schema["type"] : json{schema["type"]})
    is_typed = is_typed || has_type(value, type);
  ASSERT_TRUE(is_typed) << at << ": " << value;
  if (value.is_array())
    for (const json& item : value) expect_valid(item, schema["items"], at + "[]");
  if (!value.is_object()) return;
  for (const json& key : schema["required"])
    EXPECT_TRUE(value.contains(key.get<std::string>())) << at << " lacks " << key;
  for (const auto& [key, member] : value.items()) {
    ASSERT_TRUE(schema["properties"].contains(key)) << at << " has the unknown key " << key;
    expect_valid(member, schema["properties"][key], at + "." + key);
  }
}

class Schemas : public test::CommandTest {
 protected:
  void expect_schema(const std::string& name, const std::string& arguments) {
    expect_schema(name, name, arguments);
  }
  void expect_schema(const std::string& name, const std::string& command,
                     const std::string& arguments) {
    std::ifstream file(STRAHL_SOURCE_DIR "/docs/json/" + name + ".schema.json");
    ASSERT_TRUE(file) << name;
    const test::Finished finished = run(command + " " + arguments + " --json");
    expect_valid(finished.json(), json::parse(file), name);
  }
};

TEST_F(Schemas, DescribeWhatTheCommandsPrint) {
  write_rays("rays.npy", 10);
  folder_.write("empty.off", "OFF\n0 0 0\n");
  expect_schema("list", "");
  expect_schema("info", "gen:balls:1 --structure bvh");
  expect_schema("info", "empty.off --structure bvh");
  expect_schema("info", "gen:balls:1 --structure bvh --epo");
  expect_schema("check", "gen:balls:1");
  expect_schema("query", "gen:balls:1 --rays rays.npy --count");
  expect_schema("advise", "gen:balls:1 --rays 1000");
  expect_schema("bench", "gen:balls:1 gen:tetra:2 --size 8 --repeat 1");
  expect_schema("bench", "gen:tetra:2 --builds --size 8 --repeat 1");
  expect_schema("bench", "--scaling --from 20 --to 200 --size 8 --repeat 1");
  expect_schema("bench", "gen:tetra:2 --worst --double --size 8 --repeat 1");
  expect_schema("compare", "gen:balls:1 --structures bvh,grid --rays 100 --repeat 1 -o out");
  expect_schema("render", "gen:balls:1 --size 8x8 --mode depth");
  folder_.write("still.json", R"({"tracks": []})");
  expect_schema("render_frames", "render",
                "gen:balls:1 --size 8x8 --mode depth --frames 2 --motion still.json --verify");
}

}  // namespace
}  // namespace strahl::cli

// apps/strahl/list.cpp - `strahl list`: structures and generators with their options.
#include <apps/strahl/commands.h>
#include <memory>

#include <fmt/core.h>

#include <strahl/catalog/catalog.h>
#include <strahl/io/generators.h>

namespace strahl::cli {
namespace {

Json to_json(const OptionInfo& option) {
  Json range = nullptr;
  if (!option.min.empty()) range = Json::array({option.min, option.max});
  return {{"name", option.name}, {"type", option.type},     {"default", option.default_value},
          {"range", range},      {"values", option.values}, {"help", option.help}};
}

Json options_json(const std::vector<OptionInfo>& options) {
  Json rows = Json::array();
  for (const OptionInfo& option : options) rows.push_back(to_json(option));
  return rows;
}

Json list_json() {
  Json structures = Json::array(), generators = Json::array();
  for (const StructureEntry& entry : all_structures())
    structures.push_back({{"name", entry.name},
                          {"title", entry.title},
                          {"default", entry.name == kDefaultSpec},
                          {"options", options_json(entry.options())}});
  for (const GeneratorInfo& info : generator_list())
    generators.push_back({{"name", info.name},
                          {"title", info.help},
                          {"default_size", info.default_size},
                          {"min_size", info.min_size},
                          {"max_size", info.max_size},
                          {"size_help", info.size_help},
                          {"options", options_json(info.options)}});
  return {{"structures", structures}, {"generators", generators}};
}

std::string accepted(const OptionInfo& option) {
  if (!option.min.empty()) return option.min + ".." + option.max;
  if (option.values.empty()) return option.type;
  std::string words;
  for (const std::string& word : option.values) words += (words.empty() ? "" : "|") + word;
  return words;
}

std::string options_text(const std::vector<OptionInfo>& options) {
  std::string text;
  for (const OptionInfo& option : options)
    text += fmt::format("      {:<30} {}; {}\n", option.name + "=" + option.default_value,
                        option.help, accepted(option));
  return text;
}

std::string list_text() {
  std::string text = "Structures (SPEC = NAME[:option=value,...]; options with their defaults)\n";
  for (const StructureEntry& entry : all_structures())
    text += fmt::format("  {:<16} {}{}\n", entry.name, entry.title,
                        entry.name == kDefaultSpec ? " (default)" : "") +
            options_text(entry.options());
  text += "\nGenerators (SCENE = gen:NAME[:SIZE[,key=value...]])\n";
  for (const GeneratorInfo& info : generator_list())
    text += fmt::format("  {:<16} {}\n      {:<30} {}; {}..{}\n", info.name, info.help,
                        fmt::format("SIZE {}", info.default_size), info.size_help, info.min_size,
                        info.max_size) +
            options_text(info.options);
  return text;
}

}  // namespace

void add_list_command(CLI::App& app, Runner& run) {
  CLI::App* command = app.add_subcommand("list", "Structures and generators with their options");
  command->footer("Examples:\n  strahl list\n  strahl list --json");
  auto options = std::make_shared<CommonOptions>();
  add_output_options(*command, *options);
  command->callback([=, &run] {
    run = [=] {
      options->json ? print_json(list_json()) : print_text(list_text());
      return kExitOk;
    };
  });
}

}  // namespace strahl::cli

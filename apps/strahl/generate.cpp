// apps/strahl/generate.cpp - `strahl generate`: standard scenes as files.
#include <apps/strahl/commands.h>
#include <apps/strahl/interrupt.h>
#include <memory>
#include <optional>

#include <strahl/io/generators.h>
#include <strahl/io/scene_writer.h>

namespace strahl::cli {
namespace {

struct GenerateOptions : CommonOptions {
  std::string name, output;
  std::optional<int> size;
  std::optional<std::uint64_t> seed;
};

int default_size(const std::string& name) {
  for (const GeneratorInfo& info : generator_list())
    if (info.name == name) return info.default_size;
  return 1;  // the generators themselves refuse the name
}

/// NAME, or a SPEC of its own to which size and seed are added.
std::string generator_spec(const GenerateOptions& options) {
  std::string spec = options.name;
  if (spec.find(':') == std::string::npos)
    spec += ":" + std::to_string(options.size.value_or(default_size(spec)));
  else if (options.size)
    throw Error(ErrorCode::usage, "the name already has a size", "--size");
  if (options.seed) spec += ",seed=" + std::to_string(*options.seed);
  return spec;
}

int run_generate(const GenerateOptions& options) {
  const std::string spec = generator_spec(options);
  Session session(options);
  std::optional<OwnsOutput> owns_output;  // from the first word of the writer on
  write_generated(spec, options.output, [&](double fraction, std::string_view stage) {
    if (!owns_output) owns_output.emplace();
    return session.context().progress(fraction, stage);
  });
  session.finish_progress();
  if (options.json) print_json({{"generator", spec}, {"output", options.output}});
  return kExitOk;
}

}  // namespace

void add_generate_command(CLI::App& app, Runner& run) {
  CLI::App* command = app.add_subcommand("generate", "Write a standard scene to a file");
  command->footer(
      "'strahl list' names the generators and their options.\n"
      "Examples:\n"
      "  strahl generate balls --size 4 -o balls4.nff\n"
      "  strahl generate icosphere:6 -o ball.ply");
  auto options = std::make_shared<GenerateOptions>();
  command->add_option("name", options->name, "NAME or NAME:SIZE[,key=value...]")
      ->required()
      ->type_name("NAME");
  command->add_option("--size", options->size, "Size factor")->type_name("N");
  command->add_option("--seed", options->seed, "Seed of the random generators")->type_name("N");
  command->add_option("-o,--output", options->output, "File to write, .ply or .nff")
      ->required()
      ->type_name("FILE");
  add_output_options(*command, *options);
  command->callback([=, &run] { run = [=] { return run_generate(*options); }; });
}

}  // namespace strahl::cli

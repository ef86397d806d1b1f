#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "common/recording/files.hpp"
#include "server/answers/explanation.hpp"
#include "server/tools/command.hpp"

namespace liloc::toolbox {
namespace {

struct ExplainArguments {
  std::string file, svg;
  bool json = false;
};

int run(const ExplainArguments& arguments) {
  const auto saved = answers::read_answer(arguments.file);
  if (!saved) return complain(saved.error(), kBadUsage);
  const std::filesystem::path svg = arguments.svg.empty()
                                        ? std::filesystem::path(arguments.file).replace_extension(".svg")
                                        : std::filesystem::path(arguments.svg);
  if (std::error_code absent; std::filesystem::equivalent(svg, arguments.file, absent))
    return complain({fmt::format("--svg: {} is the answer itself; name another file", svg.string())},
                    kBadUsage);
  const answers::Explanation explanation = answers::explain(*saved);
  const SpotReply& reply = saved->answered.reply;
  const std::string title =
      fmt::format("{}, request {}: {} ({}), confidence {:.4f}", reply.client_id, reply.seq,
                  name_of(reply.status), name_of(reply.reason), reply.confidence);
  if (const Status drawn = write_file(svg, answers::to_svg(*saved, explanation, title)); !drawn)
    return complain({drawn.error().message + "; or name another with --svg"}, kFailed);
  if (arguments.json)
    fmt::print("{}\n", answers::to_json(*saved, explanation));
  else
    fmt::print("{}drawn in {}\n", answers::to_text(*saved, explanation), svg.string());
  return explanation.differences.empty() ? kDone : kFailed;
}

}  // namespace

void add_explain(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ExplainArguments>();
  CLI::App* command = app.add_subcommand(
      "explain",
      "Run a saved answer again and draw it: places found, what agreed, what contradicted, what was missing");
  command->add_option("FILE", arguments->file, "Saved by --save-answers of liloc-server or liloc replay")
      ->required();
  command->add_option("--svg", arguments->svg, "The drawing; else beside FILE");
  command->add_flag("--json", arguments->json, "Print JSON");
  command->footer("Exit code 0: the answer was the same to the digit; 1: it was not.");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace liloc::toolbox

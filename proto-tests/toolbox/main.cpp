// liloc: the toolbox. One file per subcommand; exit codes 0 done, 1 failed, 2 bad usage.
#include <fmt/ranges.h>

#include <exception>

#include "common/command/program_options.hpp"
#include "common/command/text.hpp"
#include "proto-tests/toolbox/commands.hpp"
#include "server/tools/plan/plan_command.hpp"

namespace {

/// What is wrong with the first argument; empty: it is a command, or asks for help or the version.
std::string wrong_command(const CLI::App& app, const std::string& first) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  if (std::ranges::find(commands, first) != commands.end() || app.get_option_no_throw(first) != nullptr)
    return "";
  const std::string shown = liloc::command::excerpt(first);
  const std::string wrong = first.empty()            ? "a command is missing"
                            : first.starts_with('-') ? fmt::format("'{}' needs a command before it", shown)
                                                     : fmt::format("there is no command '{}'", shown);
  return fmt::format("{}; commands are {}; see liloc --help", wrong, fmt::join(commands, ", "));
}

int run(int argc, char** argv) {
  CLI::App app(
      "LiLoc's toolbox: live demo, recordings replayed and judged, simulated sites, clouds aligned, LiDARs "
      "planned and calibrated, bags converted, answers explained, ills found",
      "liloc");
  app.set_version_flag("--version", LILOC_VERSION);
  app.require_subcommand(0, 1);
  int exit_code = liloc::toolbox::kDone;
  liloc::toolbox::add_demo(app, exit_code);
  liloc::toolbox::add_load(app, exit_code);
  liloc::toolbox::add_soak(app, exit_code);
  liloc::toolbox::add_replay(app, exit_code);
  liloc::toolbox::add_sim(app, exit_code);
  liloc::toolbox::add_align(app, exit_code);
  liloc::toolbox::add_calibrate(app, exit_code);
  liloc::toolbox::add_convert(app, exit_code);
  liloc::toolbox::add_doctor(app, exit_code);
  liloc::toolbox::add_explain(app, exit_code);
  liloc::toolbox::add_plan(app, exit_code);
  liloc::toolbox::add_record(app, exit_code);
  if (const std::string wrong = wrong_command(app, argc > 1 ? argv[1] : ""); !wrong.empty())
    return liloc::toolbox::complain({wrong}, liloc::toolbox::kBadUsage);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& shown) {  // --help, --version
    return app.exit(shown);
  } catch (const CLI::ParseError& error) {
    return liloc::toolbox::complain({liloc::command::explain(app, error) + "; see liloc --help"},
                                    liloc::toolbox::kBadUsage);
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    return liloc::toolbox::complain({error.what()}, liloc::toolbox::kFailed);
  }
}

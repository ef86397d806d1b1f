// liloc: the toolbox. One file per subcommand; exit codes 0 done, 1 failed, 2 bad usage.
#include <exception>

#include "proto-tests/toolbox/command.hpp"

namespace {

int run(int argc, char** argv) {
  CLI::App app(
      "LiLoc's toolbox: live demo, recordings replayed and judged, simulated sites, clouds aligned, ills found",
      "liloc");
  app.set_version_flag("--version", LILOC_VERSION);
  app.require_subcommand(0, 1);
  int exit_code = liloc::toolbox::kDone;
  liloc::toolbox::add_demo(app, exit_code);
  liloc::toolbox::add_replay(app, exit_code);
  liloc::toolbox::add_sim(app, exit_code);
  liloc::toolbox::add_align(app, exit_code);
  liloc::toolbox::add_doctor(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& shown) {  // --help, --version
    return app.exit(shown);
  } catch (const CLI::ParseError& error) {
    return liloc::toolbox::complain({std::string(error.what()) + "; see liloc --help"},
                                    liloc::toolbox::kBadUsage);
  }
  if (app.get_subcommands().empty())
    return liloc::toolbox::complain({"a subcommand is missing; see liloc --help"}, liloc::toolbox::kBadUsage);
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

#pragma once
// The subcommands of `liloc` that play a world; those that an operator runs are in server/tools.
#include "server/tools/command.hpp"

namespace liloc::toolbox {

void add_replay(CLI::App& app, int& exit_code);
void add_sim(CLI::App& app, int& exit_code);
void add_demo(CLI::App& app, int& exit_code);
void add_load(CLI::App& app, int& exit_code);
void add_soak(CLI::App& app, int& exit_code);

}  // namespace liloc::toolbox

#pragma once
#include <CLI/CLI.hpp>

namespace liloc::toolbox {

/// Adds `liloc plan` to `app`; when it is chosen it runs and sets `exit_code`.
void add_plan(CLI::App& app, int& exit_code);

}  // namespace liloc::toolbox

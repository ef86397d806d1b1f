#include "proto-tests/soak/process_figures.hpp"

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

namespace liloc::soak {
namespace {

/// The number behind `name:`, as in /proc/PID/status; empty where there is no such line.
std::optional<double> field(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(name + ":")) return std::strtod(line.c_str() + name.size() + 1, nullptr);
  return std::nullopt;
}

std::string read_all(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

Result<ProcessFigures> figures_of(pid_t pid) {
  const std::string folder = fmt::format("/proc/{}", pid);
  const std::string memory = read_all(folder + "/smaps_rollup");
  const auto dirty_kb = field(memory, "Private_Dirty"), swapped_kb = field(memory, "Swap");
  const auto threads = field(read_all(folder + "/status"), "Threads");
  if (!dirty_kb || !swapped_kb || !threads) return fail("process {} has ended", pid);
  ProcessFigures figures;
  figures.memory_mb = (*dirty_kb + *swapped_kb) * 1024e-6;
  figures.threads = static_cast<int>(*threads);
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder + "/fd", error), end; !error && at != end;
       at.increment(error))
    ++figures.descriptors;
  if (error) return fail("descriptors of process {} cannot be counted: {}", pid, error.message());
  return figures;
}

}  // namespace liloc::soak

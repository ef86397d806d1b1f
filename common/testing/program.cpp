#include "common/testing/program.hpp"

#include <sys/wait.h>

#include <array>
#include <cstdio>

namespace liloc {

Outcome run_program(const std::string& program, const std::string& arguments) {
  Outcome outcome;
  FILE* pipe = popen(("timeout 120 " + program + " " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.out.append(buffer.data(), n);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  return outcome;
}

}  // namespace liloc

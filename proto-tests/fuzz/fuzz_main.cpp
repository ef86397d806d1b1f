// A libFuzzer program for one border: liloc_fuzz --border=NAME CORPUS [libFuzzer's options]
//   liloc_fuzz --seeds=FOLDER   writes FOLDER/<border>/<n> for each border, prints their names, and ends
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>

#include "common/recording/files.hpp"
#include "proto-tests/fuzz/border.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using liloc::fuzz::Border;

const Border* border = nullptr;

std::optional<std::string> value_of(std::string_view argument, std::string_view name) {
  if (!argument.starts_with(name)) return std::nullopt;
  return std::string(argument.substr(name.size()));
}

[[noreturn]] void write_seeds(const std::filesystem::path& folder) {
  for (const Border& each : liloc::fuzz::borders()) {
    for (std::size_t i = 0; i < each.seeds.size(); ++i)
      if (const auto done = liloc::write_file(folder / each.name / std::to_string(i), each.seeds[i]); !done) {
        fmt::print(stderr, "{}\n", done.error().message);
        std::exit(1);
      }
    fmt::print("{}\n", each.name);
  }
  std::exit(0);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  std::string wanted;
  for (int i = 1; i < *argc; ++i) {
    const std::string_view argument = (*argv)[i];
    if (const auto folder = value_of(argument, "--seeds=")) write_seeds(*folder);
    if (const auto name = value_of(argument, "--border=")) wanted = *name;
  }
  const auto& all = liloc::fuzz::borders();
  const auto found = std::ranges::find(all, wanted, &Border::name);
  if (found == all.end()) {
    fmt::print(stderr, "no border '{}'; --seeds=FOLDER prints all names\n", wanted);
    std::exit(2);
  }
  border = &*found;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static_cast<void>(border->read(std::string(reinterpret_cast<const char*>(data), size)));
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  const std::size_t mutated = LLVMFuzzerMutate(data, size, max_size);
  if (!border->mend || seed % 8 == 0) return mutated;  // a wrong checksum is an input as well
  std::string bytes(reinterpret_cast<const char*>(data), mutated);
  border->mend(bytes);
  std::ranges::copy(bytes, data);
  return bytes.size();
}

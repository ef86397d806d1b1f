#include "common/command/program_options.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/command/checks.hpp"
#include "common/command/text.hpp"
#include "common/command/toml.hpp"

namespace liloc::command {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestFile = 1 << 20;  // every option at its longest is a tenth of it

CLI::Validator readable_file() {
  return CLI::Validator(
      [](std::string& given) {
        std::error_code error;
        if (!fs::exists(given, error)) return fmt::format("{}: no such file; check the path", excerpt(given));
        if (!fs::is_regular_file(given, error))
          return fmt::format("{}: is no regular file; check the path", excerpt(given));
        if (fs::file_size(given, error) > kLargestFile)
          return fmt::format("{}: has over {} bytes; is it the right file?", excerpt(given), kLargestFile);
        if (!std::ifstream(given))
          return fmt::format("{}: cannot be read; check its permissions", excerpt(given));
        return std::string();
      },
      "FILE");
}

/// The names that a file may use.
std::vector<std::string> names_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    if (option->get_configurable())
      for (const auto& name : option->get_lnames()) names.push_back(name);
  for (const auto* group : app.get_subcommands([](const CLI::App* sub) { return sub->get_name().empty(); }))
    std::ranges::copy(names_of(*group), std::back_inserter(names));
  return names;
}

std::string hint_for(const std::string& key, const std::vector<std::string>& names) {
  const auto nearest =
      std::ranges::min_element(names, {}, [&](const std::string& name) { return letters_between(key, name); });
  if (nearest == names.end() || 2 * letters_between(key, *nearest) >= key.size())
    return "see --help for the names";
  return fmt::format("is it {}?", *nearest);
}

}  // namespace

/// Reads the file for CLI11, and remembers where each option stood.
class ProgramOptions::File : public CLI::ConfigTOML {
 public:
  explicit File(const ProgramOptions& owner) : owner_(owner) {}

  std::vector<CLI::ConfigItem> from_config(std::istream& in) const override {
    name_ = owner_.config_->as<std::string>();
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto entries = parse_toml(text, name_);
    if (!entries) throw CLI::ConfigError(entries.error().message);
    std::vector<CLI::ConfigItem> read;
    const auto names = names_of(owner_.app_);
    for (const TomlEntry& entry : *entries) {
      if (std::ranges::find(names, entry.key) == names.end())
        throw CLI::ConfigError(fmt::format("{}: line {}: there is no option {}; {}", name_, entry.line,
                                           entry.key, hint_for(entry.key, names)));
      const CLI::Option& option = *owner_.app_.get_option_no_throw("--" + entry.key);
      check_count(option, entry);
      if (option.count() == 0) lines_["--" + entry.key] = entry.line;
      read.emplace_back();
      read.back().name = entry.key;
      read.back().inputs = entry.values;
    }
    return read;
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::map<std::string, int>& lines() const { return lines_; }

 private:
  void check_count(const CLI::Option& option, const TomlEntry& entry) const {
    const auto refuse = [&](const std::string& remedy) {
      throw CLI::ConfigError(fmt::format("{}: line {}: {} {}", name_, entry.line, entry.key, remedy));
    };
    const int given = static_cast<int>(entry.values.size()), least = option.get_items_expected_min(),
              most = option.get_items_expected_max();
    if (most == 0 || least == 0) {  // a flag
      if (entry.list || (entry.values[0] != "true" && entry.values[0] != "false"))
        refuse("is a switch; give true or false");
    } else if (most == 1 && entry.list) {
      refuse("takes one value; leave the brackets out");
    } else if (given < least || given > most) {
      refuse(fmt::format("has {} values; give {}", given, least));
    }
  }

  const ProgramOptions& owner_;
  mutable std::string name_;
  mutable std::map<std::string, int> lines_;  ///< by flag; without those that the command line overrules
};

std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return one_line(error.what());
  constexpr std::size_t kShown = 3;  // of unknown arguments; by hand
  const std::vector<std::string> unknown = app.remaining(true);
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < std::min(kShown, unknown.size()); ++i)
    shown.push_back("'" + excerpt(unknown[i]) + "'");
  if (unknown.size() > kShown) shown.emplace_back("...");
  return fmt::format("not expected: {}", fmt::join(shown, " "));
}

ProgramOptions::ProgramOptions(CLI::App& app) : app_(app), file_(std::make_shared<File>(*this)) {
  config_ = app.set_config("--config", "", "Read options from this file (TOML: name = value)");
  config_->check(readable_file())->configurable(false);
  if (CLI::Option* help = app.get_help_ptr()) help->configurable(false);
  if (CLI::Option* version = app.get_option_no_throw("--version")) version->configurable(false);
  app.config_formatter(file_);
}

Status ProgramOptions::parse(int argc, const char* const* argv, int& exit_code) {
  try {
    app_.parse(argc, argv);
    exit_code = 0;
    return {};
  } catch (const CLI::Success& shown) {
    exit_code = app_.exit(shown);
    return fail("");
  } catch (const CLI::ParseError& error) {
    exit_code = 2;
    const bool usage = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
                       dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    return tl::unexpected(
        located({explain(app_, error) + (usage ? "; see " + app_.get_name() + " --help" : "")}));
  }
}

Error ProgramOptions::located(const Error& error) const {
  std::string message = one_line(error.message);
  for (std::size_t begin = 0; (begin = message.find("--", begin)) != std::string::npos; begin += 2) {
    const std::size_t end =
        std::min(message.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", begin), message.size());
    const auto found = file_->lines().find(message.substr(begin, end - begin));
    if (found == file_->lines().end()) continue;
    message.erase(begin, 2);  // in the file the name has no dashes
    return {fmt::format("{}: line {}: {}", one_line(file_->name()), found->second, message)};
  }
  return {message};
}

}  // namespace liloc::command

#include "server/tools/plan/dxf_groups.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "common/command/text.hpp"
#include "common/recording/files.hpp"

namespace liloc::toolbox {
namespace {

constexpr std::size_t kLargestFile = 64U << 20U;  // by hand
constexpr std::size_t kMostGroups = 1'000'000;    // of an entity; by hand
constexpr double kAnyNumber = 1e9;                // units; by hand
constexpr std::string_view kBinary = "AutoCAD Binary DXF";

std::string_view trimmed(std::string_view line) {
  const auto first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

/// Codes whose values are coordinates, sizes, angles, bulges and flags (DXF reference, group codes by number).
bool is_number(int code) {
  return (code >= 10 && code <= 59) || (code >= 60 && code <= 79);
}

template <class T>
std::optional<T> parsed(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}
  std::optional<std::string_view> next() {
    if (at_ >= text_.size()) return std::nullopt;
    const auto end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view line = trimmed(text_.substr(at_, end - at_));
    at_ = end + 1;
    ++number_;
    return line;
  }
  [[nodiscard]] std::size_t number() const { return number_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0, number_ = 0;
};

class Reader {
 public:
  Reader(std::string name, std::string_view text, const std::function<Status(const DxfEntity&)>& take)
      : name_(std::move(name)), lines_(text), take_(take) {}

  Status run() {
    while (auto code_line = lines_.next()) {
      const auto code = parsed<int>(*code_line);
      if (!code)
        return fail("{}: line {} is '{}', not a group code; save it as ASCII DXF", name_, lines_.number(),
                    command::excerpt(*code_line));
      const auto value = lines_.next();
      if (!value) return fail("{}: ends after the group code of line {}; save it anew", name_, lines_.number());
      if (const Status done = group(*code, *value); !done) return done;
      if (ended_) break;
    }
    if (!ended_) return fail("{}: has no EOF at its end; save it anew", name_);
    return {};
  }

 private:
  Status group(int code, std::string_view value) {
    if (code == 0) return begin(value);
    if (code == 2 && entity_.type == "SECTION") section_ = value;
    if (code == 9 && section_ == "HEADER") return begin(value);
    const bool drawn = section_ == "ENTITIES";
    if (!is_number(code) || entity_.type.empty() || !(drawn || section_ == "HEADER")) return {};
    const auto number = parsed<double>(value);
    const bool sane = number && std::abs(*number) <= kAnyNumber;
    if (!sane && !drawn) return {};  // extents of an empty drawing are 1e20
    if (!sane)
      return fail("{}: line {} is '{}', not a number up to {:g}; save it anew", name_, lines_.number(),
                  command::excerpt(value), kAnyNumber);
    if (entity_.groups.size() >= kMostGroups)
      return fail("{}: line {}: an entity of over {} values; split it", name_, lines_.number(), kMostGroups);
    entity_.groups.push_back({code, *number});
    return {};
  }

  /// A new entity or variable: the one before is complete.
  Status begin(std::string_view type) {
    const bool wanted = section_ == "ENTITIES" || (section_ == "HEADER" && entity_.type.starts_with('$'));
    const Status taken = wanted && !entity_.type.empty() ? take_(entity_) : Status{};
    entity_ = {std::string(type), {}};
    if (type == "ENDSEC") section_.clear();
    ended_ = type == "EOF";
    return taken;
  }

  const std::string name_;
  Lines lines_;
  const std::function<Status(const DxfEntity&)>& take_;
  std::string section_;
  DxfEntity entity_;
  bool ended_ = false;
};

}  // namespace

double DxfEntity::number(int code) const {
  const auto found = std::ranges::find(groups, code, &DxfGroup::code);
  return found == groups.end() ? 0 : found->number;
}

Status read_dxf_entities(const std::filesystem::path& file,
                         const std::function<Status(const DxfEntity&)>& take) {
  const auto bytes = read_file(file, kLargestFile);
  if (!bytes) return tl::unexpected(bytes.error());
  if (bytes->starts_with(kBinary)) return fail("{}: is binary DXF; save it as ASCII DXF", file.string());
  return Reader(file.string(), *bytes, take).run();
}

}  // namespace liloc::toolbox

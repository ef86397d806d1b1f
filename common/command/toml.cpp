#include "common/command/toml.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "common/command/text.hpp"

namespace liloc::command {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // of UTF-8
constexpr std::size_t kLongestText = 4096;                   // the longest path of Linux

bool is_bare(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == '.' || c == '+';
}

/// The token without the underscores that TOML allows between digits; nothing where it is no number.
std::optional<std::string> number_of(std::string token) {
  std::erase(token, '_');
  const char* begin = token.data() + (token.starts_with('+') ? 1 : 0);
  const char* const end = token.data() + token.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (stop != end || error == std::errc::invalid_argument) return std::nullopt;
  return token;  // one beyond a double is refused later, by its option's range
}

class Parser {
 public:
  Parser(std::string_view text, std::string_view file) : text_(text), file_(file) {}

  Result<std::vector<TomlEntry>> entries() {
    std::vector<TomlEntry> entries;
    if (const Status clean = check_bytes(); !clean) return tl::unexpected(clean.error());
    for (skip(true); !at_end(); skip(true)) {
      auto read = entry();
      if (!read) return tl::unexpected(read.error());
      const auto same = std::ranges::find(entries, read->key, &TomlEntry::key);
      if (same != entries.end())
        return fail("{}: line {}: {} stands in line {} already; keep one", file_, read->line, read->key,
                    same->line);
      entries.push_back(std::move(*read));
    }
    return entries;
  }

 private:
  [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }
  [[nodiscard]] char peek() const { return at_end() ? '\n' : text_[at_]; }
  [[nodiscard]] bool at_line_end() const { return peek() == '\n' || peek() == '#'; }

  [[nodiscard]] tl::unexpected<Error> wrong(std::string_view what) const {
    return fail("{}: line {}: {}", file_, line_, what);
  }

  [[nodiscard]] Status check_bytes() const {
    int line = 1;
    for (const char c : text_) {
      if (static_cast<unsigned char>(c) < ' ' && c != '\t' && c != '\n' && c != '\r')
        return fail("{}: line {}: holds a control character; save it as plain text (UTF-8)", file_, line);
      line += c == '\n' ? 1 : 0;
    }
    return {};
  }

  /// Blanks; with `lines` comments and ends of lines too.
  void skip(bool lines) {
    for (; !at_end(); ++at_) {
      if (lines && peek() == '#') at_ = std::min(text_.find('\n', at_), text_.size());
      if (at_end() || (peek() != ' ' && peek() != '\t' && peek() != '\r' && !(lines && peek() == '\n'))) return;
      line_ += peek() == '\n' ? 1 : 0;
    }
  }

  Result<TomlEntry> entry() {
    TomlEntry entry;
    entry.line = line_;
    if (peek() == '[') return wrong("a section begins, but options have none; leave this line out");
    auto key = peek() == '"' || peek() == '\'' ? quoted() : Result<std::string>(bare());
    if (!key) return tl::unexpected(key.error());
    entry.key = excerpt(*key);
    skip(false);
    if (entry.key.empty() || peek() != '=') return wrong("is not name = value; mend it or begin it with #");
    ++at_;
    skip(false);
    if (const Status read = peek() == '[' ? list(entry) : value(entry); !read)
      return tl::unexpected(read.error());
    skip(false);
    if (!at_line_end()) return wrong(fmt::format("something follows the value of {}; leave it out", entry.key));
    return entry;
  }

  std::string bare() {
    const std::size_t begin = at_;
    while (!at_end() && is_bare(peek())) ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }

  Status value(TomlEntry& entry) {
    if (peek() == '"' || peek() == '\'') {
      auto text = quoted();
      if (!text) return tl::unexpected(text.error());
      entry.values.push_back(std::move(*text));
      return {};
    }
    const std::string token = bare();
    if (token == "true" || token == "false") {
      entry.values.push_back(token);
      return {};
    }
    const auto number = number_of(token);
    if (!number)
      return wrong(
          fmt::format("{} has no value that TOML knows; give a number, true, false or a \"text\"", entry.key));
    entry.values.push_back(*number);
    return {};
  }

  Status list(TomlEntry& entry) {
    entry.list = true;
    ++at_;
    for (skip(true); peek() != ']' || at_end(); skip(true)) {
      if (at_end())
        return fail("{}: line {}: the list of {} has no ]; is the file whole?", file_, entry.line, entry.key);
      if (const Status read = value(entry); !read) return read;
      skip(true);
      if (!at_end() && peek() == ',')
        ++at_;
      else if (!at_end() && peek() != ']')
        return wrong(fmt::format("the values of {} need a comma between them", entry.key));
    }
    ++at_;
    return {};
  }

  /// "a text" with TOML's short escapes, or 'as it is'.
  Result<std::string> quoted() {
    const char quote = text_[at_++];
    std::string read;
    for (; !at_end() && peek() != quote && peek() != '\n'; ++at_) {
      char c = peek();
      if (quote == '"' && c == '\\') {
        ++at_;
        const auto known = std::string_view("\"\\tnr").find(peek());
        if (known == std::string_view::npos)
          return wrong("has an escape other than \\\" \\\\ \\t \\n \\r; mend it");
        c = "\"\\\t\n\r"[known];
      }
      read += c;
    }
    if (at_end() || peek() != quote) return wrong("a text has no closing quote; is the file whole?");
    ++at_;
    if (read.size() > kLongestText)
      return wrong(fmt::format("a text has {} bytes; at most {} are allowed", read.size(), kLongestText));
    return read;
  }

  std::string_view text_, file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

Result<std::vector<TomlEntry>> parse_toml(std::string_view text, std::string_view file) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return Parser(text, file).entries();
}

}  // namespace liloc::command

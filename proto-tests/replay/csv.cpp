#include "proto-tests/replay/csv.hpp"

#include <charconv>
#include <fstream>

namespace liloc::replay {
namespace {

template <class T>
std::optional<T> parsed(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::vector<std::string> split_cells(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  std::vector<std::string> cells;
  for (std::size_t start = 0;;) {
    const std::size_t comma = line.find(',', start);
    cells.emplace_back(line.substr(start, comma == std::string_view::npos ? comma : comma - start));
    if (comma == std::string_view::npos) return cells;
    start = comma + 1;
  }
}

Result<Csv> Csv::read(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line))
    return fail("{}: cannot be read, or is empty; run the replay again", file.string());
  Csv csv;
  const std::vector<std::string> names = split_cells(line);
  for (std::size_t i = 0; i < names.size(); ++i) csv.columns_[names[i]] = i;
  while (std::getline(in, line))
    if (!line.empty()) csv.rows_.push_back(split_cells(line));
  return csv;
}

std::string_view Csv::text(std::size_t row, std::string_view column) const {
  const auto found = columns_.find(std::string(column));
  if (found == columns_.end() || found->second >= rows_[row].size()) return {};
  return rows_[row][found->second];
}

std::optional<double> Csv::number(std::size_t row, std::string_view column) const {
  return parsed<double>(text(row, column));
}

std::optional<std::int64_t> Csv::integer(std::size_t row, std::string_view column) const {
  return parsed<std::int64_t>(text(row, column));
}

}  // namespace liloc::replay

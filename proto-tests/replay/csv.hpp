#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace liloc::replay {

/// The cells of one line; a trailing carriage return is no part of them.
[[nodiscard]] std::vector<std::string> split_cells(std::string_view line);

/// A CSV file with a header row and no quoting, as the traces are. Rows shorter than the header read as empty.
class Csv {
 public:
  /// Errors: the file cannot be read, or has no header.
  [[nodiscard]] static Result<Csv> read(const std::filesystem::path& file);

  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  [[nodiscard]] bool has(std::string_view column) const { return columns_.contains(std::string(column)); }
  /// Empty where the column or the cell is missing.
  [[nodiscard]] std::string_view text(std::size_t row, std::string_view column) const;
  [[nodiscard]] std::optional<double> number(std::size_t row, std::string_view column) const;
  [[nodiscard]] std::optional<std::int64_t> integer(std::size_t row, std::string_view column) const;

 private:
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace liloc::replay

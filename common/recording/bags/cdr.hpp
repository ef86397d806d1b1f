#pragma once
// CDR, as ROS 2 serializes messages: a head of four bytes, then values aligned to their size, in either byte
// order.
#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "common/recording/bags/limits.hpp"

namespace liloc::bags {

/// Trusts nothing: after the first error it yields zeros and empty texts, and `good` is false.
class CdrIn {
 public:
  explicit CdrIn(std::string_view bytes) : bytes_(bytes) {
    good_ = bytes.size() >= kHead && bytes[0] == 0 && (bytes[1] == 0 || bytes[1] == 1);
    swap_ = good_ && bytes[1] == 0;
    at_ = good_ ? kHead : bytes.size();
  }

  template <class T>
  requires std::is_arithmetic_v<T>
  [[nodiscard]] T number() {
    at_ += (sizeof(T) - (at_ - kHead) % sizeof(T)) % sizeof(T);
    const std::string_view raw = take(sizeof(T));
    std::array<char, sizeof(T)> bytes{};
    std::copy(raw.begin(), raw.end(), bytes.begin());
    if (swap_) std::reverse(bytes.begin(), bytes.end());
    T value{};
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }
  /// So many bytes; a view into the message.
  [[nodiscard]] std::string_view take(std::size_t size) {
    good_ = good_ && at_ <= bytes_.size() && size <= bytes_.size() - at_;
    if (!good_) return {};
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }
  /// A sequence's length; `each`: the least bytes that one of it takes.
  [[nodiscard]] std::size_t length(std::size_t each = 1) {
    const std::size_t length = number<std::uint32_t>();
    good_ = good_ && at_ <= bytes_.size() && length <= (bytes_.size() - at_) / each;
    return good_ ? length : 0;
  }
  /// A name: topics, frames and encodings are far shorter than the limit.
  [[nodiscard]] std::string text() {
    const std::size_t size = length();
    good_ = good_ && size <= kLongestName;
    std::string_view raw = take(good_ ? size : 0);
    if (!raw.empty() && raw.back() == '\0') raw.remove_suffix(1);
    return std::string(raw);
  }
  template <std::size_t N>
  [[nodiscard]] std::array<double, N> doubles() {
    std::array<double, N> values{};
    for (double& value : values) value = number<double>();
    return values;
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  static constexpr std::size_t kHead = 4;
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool good_ = false, swap_ = false;
};

}  // namespace liloc::bags

#pragma once
// Plain values to bytes and back, little-endian, one after the other. `fields.hpp` names a type's values once,
// for both ways.
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "common/base/result.hpp"

namespace liloc::answers {

static_assert(std::endian::native == std::endian::little,
              "files are little-endian, and so is what is read back");

template <class T>
concept Number = std::is_arithmetic_v<T>;

class ArchiveOut {
 public:
  static constexpr bool kReads = false;

  void number(Number auto value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value)); }
  /// How many follow; both ways return it.
  std::size_t count(std::size_t count, std::size_t /*most*/) {
    number(static_cast<std::uint32_t>(count));
    return count;
  }
  void block(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  /// Nothing can be wrong with what this program writes.
  void require(bool /*holds*/, std::string_view /*what*/) {}

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Trusts nothing: after the first error it yields zeros and empty lists, and `status` says what was wrong.
class ArchiveIn {
 public:
  static constexpr bool kReads = true;
  explicit ArchiveIn(std::string_view bytes) : bytes_(bytes) {}

  template <Number T>
  void number(T& value) {
    if constexpr (std::same_as<T, bool>) {
      std::uint8_t byte = 0;
      block(&byte, 1);
      require(byte <= 1, "a flag");
      value = byte == 1;
    } else {
      block(&value, sizeof(value));
      if constexpr (std::floating_point<T>) require(std::isfinite(value), "a number that is not finite");
      if (!status_) value = T{};
    }
  }
  std::size_t count(std::size_t /*held*/, std::size_t most) {
    std::uint32_t count = 0;
    number(count);
    require(count <= most, "a count that is too large");
    return status_ ? count : 0;
  }
  void block(void* data, std::size_t size) {
    if (size == 0) return;  // `data` may be null
    if (!status_ || size > bytes_.size() - at_) {
      require(false, "the end, too early");
      std::memset(data, 0, size);
      return;
    }
    std::memcpy(data, bytes_.data() + at_, size);
    at_ += size;
  }
  /// Whether so many bytes are still there, before room is made for them.
  [[nodiscard]] bool holds(std::size_t size) {
    require(size <= bytes_.size() - at_, "the end, too early");
    return status_.has_value();
  }
  void require(bool holds, std::string_view what) {
    if (!holds && status_) status_ = fail("at byte {} stands {}", at_, what);
  }
  void require_end() { require(at_ == bytes_.size(), "more than belongs there"); }

  [[nodiscard]] const Status& status() const { return status_; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  Status status_;
};

}  // namespace liloc::answers

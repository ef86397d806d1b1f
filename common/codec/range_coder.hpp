#pragma once
// Private to the room: an adaptive binary range coder (as in LZMA), with counters that learn fast at first.
// Encoder and decoder have the same face, so that one function describes a stream in both directions.
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace liloc::codec {

/// How probable a set bit is, by the bits seen so far.
class BitModel {
 public:
  [[nodiscard]] std::uint32_t one() const { return one_; }
  void learn(bool bit) {
    const std::int32_t target = bit ? kCertain : 65'536 - kCertain;
    one_ = static_cast<std::uint16_t>(one_ + (((target - one_) * kRate[seen_]) >> 16));
    seen_ = static_cast<std::uint8_t>(seen_ + (seen_ + 1U < kRate.size() ? 1 : 0));
  }

 private:
  static constexpr std::int32_t kCertain = 65'500;  ///< of 65536: no bit is ever taken for certain; by hand
  /// A mean over the first bits, then over the last fifty; of 65536.
  static constexpr auto kRate = [] {
    std::array<std::int32_t, 49> rate{};
    for (std::size_t n = 0; n < rate.size(); ++n) rate[n] = static_cast<std::int32_t>(65'536 * 2 / (2 * n + 3));
    return rate;
  }();
  std::uint16_t one_ = 32'768;
  std::uint8_t seen_ = 0;
};

class RangeEncoder {
 public:
  /// Writes `value`, and returns it.
  bool bit(BitModel& model, bool value) {
    write(value, (range_ >> 16) * model.one());
    model.learn(value);
    return value;
  }
  /// The same for a bit that is as likely set as not.
  bool plain_bit(bool value) {
    write(value, range_ >> 1);
    return value;
  }
  /// The stream; the encoder is used up.
  std::vector<std::uint8_t> finish() {
    for (int i = 0; i < 5; ++i) shift();
    return std::move(bytes_);
  }

 private:
  static constexpr std::uint32_t kTop = 1U << 24;
  void write(bool value, std::uint32_t bound) {
    low_ += value ? 0 : bound;
    range_ = value ? bound : range_ - bound;
    while (range_ < kTop) {
      range_ <<= 8;
      shift();
    }
  }
  void shift() {  // one byte out; a carry may still run through the bytes that wait
    if (low_ < 0xFF00'0000U || low_ > 0xFFFF'FFFFU) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32);
      for (std::uint8_t byte = waiting_; waits_ > 0; --waits_, byte = 0xFF)
        bytes_.push_back(static_cast<std::uint8_t>(byte + carry));
      waiting_ = static_cast<std::uint8_t>(low_ >> 24);
    }
    ++waits_;
    low_ = (low_ & 0x00FF'FFFFU) << 8;
  }
  std::uint64_t low_ = 0, waits_ = 1;
  std::uint32_t range_ = 0xFFFF'FFFFU;
  std::uint8_t waiting_ = 0;
  std::vector<std::uint8_t> bytes_;
};

/// Past its end a stream reads as zeros: the caller asks `cut_short` in between, and `used_up` at the end.
class RangeDecoder {
 public:
  RangeDecoder(const std::uint8_t* begin, const std::uint8_t* end) : at_(begin), end_(end) {
    for (int i = 0; i < 5; ++i) code_ = code_ << 8 | next();
  }
  bool bit(BitModel& model, bool /*value*/ = false) {
    const bool value = read((range_ >> 16) * model.one());
    model.learn(value);
    return value;
  }
  bool plain_bit(bool /*value*/ = false) { return read(range_ >> 1); }
  [[nodiscard]] bool cut_short() const { return missing_; }
  [[nodiscard]] bool used_up() const { return at_ == end_ && !missing_; }

 private:
  static constexpr std::uint32_t kTop = 1U << 24;
  bool read(std::uint32_t bound) {  // without a jump on the bit: nobody could foretell it
    const bool value = code_ < bound;
    const std::uint32_t unset = value ? 0U : ~0U;
    code_ -= bound & unset;
    range_ = (bound & ~unset) | ((range_ - bound) & unset);
    while (range_ < kTop) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
    return value;
  }
  std::uint32_t next() {
    if (at_ != end_) return *at_++;
    missing_ = true;
    return 0;
  }
  const std::uint8_t* at_;
  const std::uint8_t* end_;
  std::uint32_t range_ = 0xFFFF'FFFFU, code_ = 0;
  bool missing_ = false;
};

}  // namespace liloc::codec

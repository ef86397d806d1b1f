#pragma once
// MCAP and CDR byte by byte, for bags that no writer makes.
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace liloc::bags::written {

template <class T>
std::string number(T value) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

inline std::string text(std::string_view value) {
  return number(static_cast<std::uint32_t>(value.size())) + std::string(value);
}

inline std::string record(std::uint8_t opcode, const std::string& body) {
  return number(opcode) + number(std::uint64_t{body.size()}) + body;
}

/// A chunk without checksum that says it holds `size` bytes.
inline std::string chunk(std::string_view compression, const std::string& packed, std::uint64_t size) {
  return record(6, number(std::uint64_t{0}) + number(std::uint64_t{0}) + number(size) +
                       number(std::uint32_t{0}) + text(compression) + number(std::uint64_t{packed.size()}) +
                       packed);
}

/// A schema and a channel of the same number.
inline std::string channel(std::string_view topic, std::string_view type, std::uint16_t id = 1) {
  const std::string same = number(id);
  return record(3, same + text(type) + text("ros2msg") + text("")) +
         record(4, same + same + text(topic) + text("cdr") + text(""));
}

inline std::string message(const std::string& cdr, std::uint16_t channel = 1) {
  return record(5, number(channel) + std::string(20, '\0') + cdr);
}

inline std::string mcap(const std::string& records) {
  const std::string magic("\x89MCAP0\r\n", 8);
  return magic + record(1, text("ros2") + text("test")) + records + record(15, number(std::uint32_t{0})) +
         record(2, std::string(20, '\0')) + magic;
}

/// Little-endian CDR; texts end with a zero.
class Cdr {
 public:
  template <class T>
  Cdr& put(T value) {
    bytes_.append((sizeof(T) - bytes_.size() % sizeof(T)) % sizeof(T), '\0');
    bytes_ += number(value);
    return *this;
  }
  Cdr& text(std::string_view value) {
    put(static_cast<std::uint32_t>(value.size() + 1));
    bytes_ += std::string(value) + '\0';
    return *this;
  }
  Cdr& header(std::string_view frame, std::int64_t stamp_ns = 0) {
    constexpr std::int64_t kNsInSecond = 1'000'000'000;
    return put(static_cast<std::int32_t>(stamp_ns / kNsInSecond))
        .put(static_cast<std::uint32_t>(stamp_ns % kNsInSecond))
        .text(frame);
  }
  Cdr& blob(const std::string& value) {
    put(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
    return *this;
  }
  [[nodiscard]] std::string done() const { return std::string("\0\1\0\0", 4) + bytes_; }

 private:
  std::string bytes_;
};

inline std::string image(std::string_view encoding, std::uint32_t width, std::uint32_t height,
                         const std::string& data, std::int64_t stamp_ns = 0) {
  const std::uint32_t step = width * (encoding == "32FC1" ? 4 : 2);
  return Cdr()
      .header("camera", stamp_ns)
      .put(height)
      .put(width)
      .text(encoding)
      .put(std::uint8_t{0})
      .put(step)
      .blob(data)
      .done();
}

/// A CameraInfo; p, binning and roi (x_offset, y_offset, height, width) may stay as drivers leave them.
inline std::string camera_info(std::uint32_t width, std::uint32_t height, const std::array<double, 9>& k,
                               const std::array<double, 12>& p = {}, std::uint32_t binning = 0,
                               const std::array<std::uint32_t, 4>& roi = {}) {
  Cdr out;
  out.header("camera").put(height).put(width).text("plumb_bob").put(std::uint32_t{0});
  const auto put = [&](const auto& values) {
    for (const auto value : values) out.put(value);
  };
  put(k);
  put(std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  put(p);
  out.put(binning).put(binning);
  put(roi);
  return out.put(std::uint8_t{0}).done();
}

/// An Imu of angular velocity and specific force.
inline std::string imu(const std::array<double, 3>& w, const std::array<double, 3>& a,
                       std::int64_t stamp_ns = 0) {
  Cdr out;
  const auto put = [&](const auto& values) {
    for (const double value : values) out.put(value);
  };
  out.header("imu", stamp_ns);
  put(std::array<double, 13>{0, 0, 0, 1});  // orientation, its covariance
  put(w);
  put(std::array<double, 9>{});
  put(a);
  put(std::array<double, 9>{});
  return out.done();
}

}  // namespace liloc::bags::written

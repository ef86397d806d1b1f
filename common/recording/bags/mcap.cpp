// MCAP from its beginning on, record by record (mcap.dev/spec); the index at its end is not needed.
#include <zlib.h>

#include <cstring>
#include <fstream>
#include <map>
#include <string>

#include "common/recording/bags/bag.hpp"
#include "common/recording/bags/chunk.hpp"

namespace liloc::bags {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
enum Opcode : std::uint8_t { kFooter = 2, kSchema = 3, kChannel = 4, kMessage = 5, kChunk = 6, kDataEnd = 15 };

/// Little-endian values of a record, as the specification names them.
class Record {
 public:
  explicit Record(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  T number() {
    T value{};
    const std::string_view raw = take(sizeof(T));
    if (good_) std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }
  std::string_view take(std::uint64_t size) {
    good_ = good_ && size <= bytes_.size();
    if (!good_) return {};
    const std::string_view raw = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return raw;
  }
  /// Of a topic, a type, an encoding.
  std::string_view name() {
    const auto size = number<std::uint32_t>();
    good_ = good_ && size <= kLongestName;
    return take(good_ ? size : 0);
  }
  std::string_view rest() { return take(bytes_.size()); }
  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  [[nodiscard]] bool good() const { return good_; }

 private:
  std::string_view bytes_;
  bool good_ = true;
};

class Mcap {
 public:
  explicit Mcap(const OnMessage& on_message) : on_message_(on_message) {}

  Status take(std::uint8_t opcode, std::string_view bytes, bool in_chunk = false) {
    Record record(bytes);
    Status taken;
    if (opcode == kSchema) taken = schema(record);
    if (opcode == kChannel) taken = channel(record);
    if (opcode == kMessage) taken = message(record);
    if (opcode == kChunk) taken = in_chunk ? Status(fail("has a chunk in a chunk")) : chunk(record);
    if (taken && !record.good()) return fail("has a damaged record (kind {})", opcode);
    return taken;
  }

 private:
  struct Channel {
    std::string topic, type;
  };

  Status schema(Record& record) {
    const auto id = record.number<std::uint16_t>();
    schemas_[id] = std::string(record.name());
    return {};
  }
  Status channel(Record& record) {
    const auto id = record.number<std::uint16_t>(), schema = record.number<std::uint16_t>();
    const std::string topic(record.name());
    const std::string encoding(record.name());
    const bool cdr = encoding.empty() || encoding == "cdr";
    channels_.insert_or_assign(id, Channel{topic, cdr ? schemas_[schema] : encoding + ", which is not cdr"});
    return {};
  }
  Status message(Record& record) {
    const auto channel = channels_.find(record.number<std::uint16_t>());
    (void)record.take(4 + 8 + 8);  // sequence, log time, publish time
    if (!record.good()) return {};
    if (channel == channels_.end()) return fail("has a message of a channel that it does not describe");
    return on_message_({channel->second.topic, channel->second.type, record.rest()});
  }
  Status chunk(Record& record) {
    (void)record.take(8 + 8);  // of its first and last message
    const auto size = record.number<std::uint64_t>();
    const auto crc = record.number<std::uint32_t>();
    const std::string_view compression = record.name();
    const std::string_view packed = record.take(record.number<std::uint64_t>());
    if (!record.good()) return {};
    const auto records = unpacked(compression, packed, size);
    if (!records) return tl::unexpected(records.error());
    const auto* bytes = reinterpret_cast<const Bytef*>(records->data());
    if (crc != 0 && crc32_z(0, bytes, records->size()) != crc)
      return fail("has a chunk whose checksum is wrong");
    return each(*records);
  }
  Status each(std::string_view records) {
    for (Record all(records); !all.empty();) {
      const auto opcode = all.number<std::uint8_t>();
      const std::string_view bytes = all.take(all.number<std::uint64_t>());
      if (!all.good()) return fail("has a damaged chunk");
      if (Status taken = take(opcode, bytes, true); !taken) return taken;
    }
    return {};
  }

  const OnMessage& on_message_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
};

bool fill(std::ifstream& in, void* to, std::size_t size) {
  return static_cast<bool>(in.read(static_cast<char*>(to), static_cast<std::streamsize>(size)));
}

Status read_records(std::ifstream& in, std::uint64_t left, Mcap& mcap) {
  std::string bytes;
  while (true) {
    std::uint8_t opcode = 0;
    std::uint64_t size = 0;
    if (!fill(in, &opcode, 1) || !fill(in, &size, 8) || left < 9 || size > left - 9)
      return fail("ends in the middle; record it anew, or mend it with mcap recover");
    left -= 9 + size;
    if (opcode != kSchema && opcode != kChannel && opcode != kMessage && opcode != kChunk) {
      if (opcode == kDataEnd || opcode == kFooter) return {};
      if (!in.seekg(static_cast<std::streamoff>(size), std::ios::cur)) return fail("cannot be read");
      continue;  // attachments may be large, and nothing is wanted of them
    }
    if (size > kLargestChunk) return fail("has a record of {} bytes; at most {} are read", size, kLargestChunk);
    bytes.resize(size);
    if (!fill(in, bytes.data(), size)) return fail("cannot be read");
    if (Status taken = mcap.take(opcode, bytes); !taken) return taken;
  }
}

}  // namespace

Status read_mcap(const std::filesystem::path& file, const OnMessage& on_message) {
  std::ifstream in(file, std::ios::binary);
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(file, error);
  std::string magic(kMagic.size(), '\0');
  if (error || !fill(in, magic.data(), magic.size()) || magic != kMagic)
    return fail("{}: is no MCAP file; check the path", file.string());
  Status own;  // an error of the receiver is passed on as it is
  const OnMessage guarded = [&](const Message& message) { return own = on_message(message); };
  Mcap mcap(guarded);
  const Status read = read_records(in, size - kMagic.size(), mcap);
  if (!own) return own;
  if (!read) return fail("{}: {}", file.string(), read.error().message);
  return {};
}

}  // namespace liloc::bags

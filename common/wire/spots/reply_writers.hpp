#pragma once
// Private to the room: where a server's replies leave.
#include <liloc.h>

#include <map>
#include <shared_mutex>
#include <string>

#include "common/base/result.hpp"
#include "common/wire/dds/entity.hpp"

namespace liloc::wire {

/// A reply writer in each client's partition: workers reply while clients come and go. Thread-safe.
class ReplyWriters {
 public:
  /// Of at most `most` clients.
  ReplyWriters(std::int32_t participant, std::size_t most) : participant_(participant), most_(most) {}

  /// True when the client is new. Errors: there are as many as may be, or DDS's own.
  [[nodiscard]] Result<bool> open(const std::string& client_id);
  void close(const std::string& client_id);
  /// Never waits long. Errors: no such client, or DDS's own.
  [[nodiscard]] Status write(const std::string& client_id, const liloc_msg_SpotReply& message) const;
  [[nodiscard]] std::size_t clients() const;

 private:
  struct Ends {
    Entity publisher, writer;
  };
  [[nodiscard]] Result<Ends> make(const std::string& client_id) const;

  const std::int32_t participant_;
  const std::size_t most_;
  mutable std::shared_mutex mutex_;
  std::map<std::string, Ends> clients_;
};

}  // namespace liloc::wire

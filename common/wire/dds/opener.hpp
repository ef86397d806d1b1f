#pragma once
// Private to common/wire: makes the writers of a publisher.
#include <string>
#include <utility>

#include "common/base/ids.hpp"
#include "common/wire/dds/participant.hpp"
#include "common/wire/dds/typed.hpp"

namespace liloc::wire {

/// Opens the writers of a publisher one after the other; the first error stays.
class Opener {
 public:
  Opener(const Participant& participant, const std::string& id) : participant_(participant.handle()) {
    if (auto valid = valid_id(id, "sensor id"); !valid) status_ = tl::unexpected(valid.error());
  }
  template <class T>
  void open(Entity& writer, const std::string& topic, Qos qos) {
    if (!status_) return;
    auto made = make_writer<T>(participant_, participant_, topic, std::move(qos));
    if (made)
      writer = std::move(*made);
    else
      status_ = tl::unexpected(made.error());
  }
  template <class Publisher>
  Result<Publisher> finish(Publisher publisher) {
    if (!status_) return tl::unexpected(status_.error());
    return publisher;
  }

 private:
  std::int32_t participant_;
  Status status_;
};

}  // namespace liloc::wire

#pragma once
// Private to the room: a participant's credentials, as DDS Security takes them.
#include <string>

#include "common/base/result.hpp"
#include "common/wire/dds/qos.hpp"

namespace liloc::wire {

/// The QoS of a participant that joins with the credentials in `folder`, in its own way of naming what is wrong
/// (see `read_credentials`); also where Cyclone DDS's plugins are missing. Warns 30 days before the end.
[[nodiscard]] Result<Qos> security_qos(const std::string& folder);

}  // namespace liloc::wire

#pragma once
#include <memory>

#include "common/wire/dds/entity.hpp"
#include "common/wire/dds/participant.hpp"

namespace liloc::wire {

/// DDS allows one configuration a domain and process: participants of one domain share it, the last one ends
/// it. Thread-safe. Errors: an option; DDS.
[[nodiscard]] Result<std::shared_ptr<Entity>> shared_domain(const DomainOptions& options);

/// Whether participants of this process hold the domain, and with it the addresses that DDS read when the first
/// of them joined. False where CYCLONEDDS_URI is set: then nobody counts them.
[[nodiscard]] bool domain_is_held(int domain);

}  // namespace liloc::wire

#include "server/service/service_options.hpp"

#include "common/base/ids.hpp"

namespace liloc {

Result<ServiceOptions> ServiceOptions::validated() const {
  if (const auto id = valid_id(server_id, "server_id"); !id) return tl::unexpected(id.error());
  if (workers < 1 || workers > 64) return fail("workers is {}, must be 1..64", workers);
  if (queue < 1 || queue > 4096) return fail("queue is {}, must be 1..4096", queue);
  if (!(max_rate_hz > 0) || max_rate_hz > 1e4)
    return fail("max_rate_hz is {}, must be above 0, up to 10000", max_rate_hz);
  if (max_clients < 1 || max_clients > 4096) return fail("max_clients is {}, must be 1..4096", max_clients);
  if (hold.count() < 0 || hold.count() > 1000) return fail("hold is {} ms, must be 0..1000", hold.count());
  return *this;
}

}  // namespace liloc

#pragma once
#include "common/recording/json_fields.hpp"
#include "server/localization/following.hpp"

namespace liloc {

/// What is remembered of a device, as fields of a JSON object.
[[nodiscard]] nlohmann::ordered_json to_json(const Remembered& remembered);
/// Errors name the field: missing, out of range, no pose, no covariance.
[[nodiscard]] Result<Remembered> remembered_from(const JsonFields& fields);

}  // namespace liloc

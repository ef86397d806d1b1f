#pragma once
// What crosses the C boundary, in both directions. Structures come with the caller's idea of their size.
#include <algorithm>
#include <cstddef>
#include <cstring>

#include "client/include/liloc/client.h"
#include "client/include/liloc/client.hpp"
#include "common/base/result.hpp"

namespace liloc::client::c_api {

/// Structures of the first release ended here: a smaller size is a caller's mistake. New fields begin beyond
/// the old padding, which a caller need not have cleared.
template <class T>
// Of the first release's structure: fields from there on came later.
constexpr std::size_t kFirstSize = sizeof(T);
template <>
constexpr inline std::size_t kFirstSize<liloc_client_options> = offsetof(liloc_client_options, request_bytes);
template <>
constexpr inline std::size_t kFirstSize<liloc_pose_update> = offsetof(liloc_pose_update, observed);

constexpr std::size_t kLargestSize = 64 * 1024;  ///< no structure will ever be larger

template <class T>
Status check_size(std::size_t size, const char* name) {
  if (size >= kFirstSize<T> && size <= kLargestSize) return {};
  return fail("{} has {} bytes, this library knows {}; pass sizeof({})", name, size, sizeof(T), name);
}

/// Fills what the caller has room for; what this library does not know of becomes 0.
template <class T>
Status copy_out(const T& full, T* out, std::size_t size, const char* name) {
  if (out == nullptr) return fail("{} is NULL; pass the address of one", name);
  if (const Status ok = check_size<T>(size, name); !ok) return ok;
  std::memset(static_cast<void*>(out), 0, size);
  std::memcpy(out, &full, std::min(size, sizeof(T)));
  return {};
}

[[nodiscard]] liloc_client_options default_options();
/// Errors: NULL, size, a field that is set and not known here, id or camera missing, ranges of C's own fields.
[[nodiscard]] Result<Options> options_from(const liloc_client_options* options, std::size_t size);

[[nodiscard]] Pose from_c(const liloc_pose& pose);
[[nodiscard]] liloc_pose_update to_c(const PoseUpdate& update);
/// Its texts point into `reply`.
[[nodiscard]] liloc_reply to_c(const Reply& reply);
[[nodiscard]] liloc_stats to_c(const Stats& stats);

}  // namespace liloc::client::c_api

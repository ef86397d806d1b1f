#pragma once
// Ownership of DDS entities, whose handles are plain numbers.
#include <cstdint>
#include <string_view>
#include <utility>

#include "common/base/result.hpp"

namespace liloc::wire {

/// Deletes its DDS entity, and that entity's children, when it goes. Move-only.
class Entity {
 public:
  Entity() = default;
  explicit Entity(std::int32_t handle) : handle_(handle) {}
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Entity();

  [[nodiscard]] std::int32_t handle() const { return handle_; }

 private:
  std::int32_t handle_ = 0;
};

/// A handle or return code as DDS gives them: negative means failed. The error is DDS's text and our remedy.
[[nodiscard]] Result<Entity> checked(std::int32_t handle, std::string_view what);
[[nodiscard]] Status check(std::int32_t return_code, std::string_view what);

}  // namespace liloc::wire

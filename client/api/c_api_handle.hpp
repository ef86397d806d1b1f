#pragma once
// The handle behind the C API: options and callbacks first, then a running client, then a stopped one.
#include <atomic>
#include <mutex>
#include <new>
#include <string>

#include "client/api/c_api_structs.hpp"

struct liloc_client {
  liloc::client::Options options;
  liloc_pose_callback on_pose = nullptr;
  void* pose_user = nullptr;
  liloc_reply_callback on_reply = nullptr;
  void* reply_user = nullptr;

  std::mutex mutex;  ///< start, stop and the callbacks' registration
  std::unique_ptr<liloc::client::Client> owned;
  std::atomic<liloc::client::Client*> running = nullptr;  ///< `owned`, once it started; stays after stop
  std::atomic<bool> stopped = false;
};

namespace liloc::client::c_api {

/// Of the calling thread.
[[nodiscard]] const std::string& last_error();
/// Keeps the text for last_error, and returns the status.
liloc_status refuse(liloc_status status, std::string text) noexcept;
liloc_status refuse_null(const char* what);
liloc_status refuse_no_client();
liloc_status refuse_stopped(const liloc_client& client);
liloc_status refuse_not_started(const liloc_client& client);
liloc_status refuse_in_callback(const char* call);

/// Runs the call; whatever is thrown inside becomes a status.
template <class Call>
liloc_status guarded(Call&& call) noexcept {
  try {
    return call();
  } catch (const std::bad_alloc&) {
    return refuse(LILOC_OUT_OF_MEMORY, "out of memory");  // short enough to need none
  } catch (const std::exception& error) {
    return refuse(LILOC_INTERNAL, error.what());
  } catch (...) {
    return refuse(LILOC_INTERNAL, "an exception without a text");
  }
}

/// While it lives, this thread runs a callback: it would wait for itself if it stopped the client.
class InCallback {
 public:
  InCallback();
  ~InCallback();
  InCallback(const InCallback&) = delete;
  InCallback& operator=(const InCallback&) = delete;
};
[[nodiscard]] bool in_callback();

[[nodiscard]] liloc_status start(liloc_client& client);
/// A second stop waits for the first, and does nothing.
[[nodiscard]] liloc_status stop(liloc_client& client);

}  // namespace liloc::client::c_api

#include "client/api/c_api_handle.hpp"

namespace liloc::client::c_api {
namespace {

thread_local std::string error_text;
thread_local int callbacks_deep = 0;

PoseCallback pose_callback(const liloc_client& client) {
  if (client.on_pose == nullptr) return {};
  return [call = client.on_pose, user = client.pose_user](const PoseUpdate& update) {
    const InCallback inside;
    const liloc_pose_update u = to_c(update);
    call(&u, user);
  };
}

ReplyCallback reply_callback(const liloc_client& client) {
  if (client.on_reply == nullptr) return {};
  return [call = client.on_reply, user = client.reply_user](const Reply& reply) {
    const InCallback inside;
    const liloc_reply r = to_c(reply);
    call(&r, user);
  };
}

}  // namespace

const std::string& last_error() {
  return error_text;
}

liloc_status refuse(liloc_status status, std::string text) noexcept {
  error_text = std::move(text);
  return status;
}

liloc_status refuse_null(const char* what) {
  return refuse(LILOC_INVALID_ARGUMENT, fmt::format("{} is NULL", what));
}

liloc_status refuse_no_client() {
  return refuse(LILOC_INVALID_ARGUMENT, "client is NULL; pass what liloc_client_create gave");
}

liloc_status refuse_stopped(const liloc_client& client) {
  return refuse(LILOC_WRONG_STATE, client.options.id + ": stopped; create another client");
}

liloc_status refuse_not_started(const liloc_client& client) {
  return refuse(LILOC_WRONG_STATE, client.options.id + ": not started; call liloc_client_start first");
}

liloc_status refuse_in_callback(const char* call) {
  return refuse(LILOC_WRONG_STATE, fmt::format("{} inside a callback; call it from another thread", call));
}

InCallback::InCallback() {
  ++callbacks_deep;
}

InCallback::~InCallback() {
  --callbacks_deep;
}

bool in_callback() {
  return callbacks_deep > 0;
}

liloc_status start(liloc_client& client) {
  const std::scoped_lock lock(client.mutex);
  if (client.stopped) return refuse_stopped(client);
  if (client.owned) return refuse(LILOC_WRONG_STATE, client.options.id + ": already started");
  auto made = Client::create(client.options, pose_callback(client), reply_callback(client));
  if (!made) {  // errors of the options name them; all else came from outside
    const bool option = made.error().starts_with("options.");
    return refuse(option ? LILOC_INVALID_ARGUMENT : LILOC_FAILED, made.error());
  }
  client.owned = std::move(made.value());
  client.running = client.owned.get();
  return LILOC_OK;
}

liloc_status stop(liloc_client& client) {
  const std::scoped_lock lock(client.mutex);
  if (client.stopped.exchange(true) || !client.owned) return LILOC_OK;
  const auto stopped = client.owned->stop();
  return stopped ? LILOC_OK : refuse(LILOC_FAILED, stopped.error());
}

}  // namespace liloc::client::c_api

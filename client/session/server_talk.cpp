#include "client/session/server_talk.hpp"

#include "common/base/limited_log.hpp"

namespace liloc {
namespace {

constexpr std::size_t kOutbox = 2;  // an older request is worthless once a newer one waits; by hand
// Above what an answer takes where the ceiling is waited for (100 ms) and a room is searched; by hand.
constexpr auto kUnanswered = std::chrono::milliseconds(250);
constexpr auto kNamesakeTold = std::chrono::seconds(10);  // a few requests of the other device; by hand

}  // namespace

ServerTalk::ServerTalk(std::string client_id, CloudCodec wanted, Send send, SessionClock& clock,
                       SessionReport& report)
    : client_id_(std::move(client_id)),
      send_(std::move(send)),
      clock_(clock),
      report_(report),
      codecs_(wanted),
      codec_(wanted),
      outbox_(kOutbox),
      sending_([this](const std::stop_token& stop) {
        while (auto request = outbox_.pop(stop)) this->send(std::move(*request));
      }) {}

void ServerTalk::ask(SpotRequest request) {
  report_.count(&SessionStats::requests);
  if (outbox_.push(std::move(request))) report_.count(&SessionStats::requests_unsent);
}

void ServerTalk::close() {
  outbox_.close();
  if (sending_.joinable()) sending_.join();
}

void ServerTalk::send(SpotRequest request) {
  const Time now = std::chrono::steady_clock::now();
  clock_.stamp(request, now);
  {
    const std::scoped_lock lock(mutex_);
    open_.sent(request);  // before it leaves: an answer may be quicker than the return
    if (!unanswered_since_) unanswered_since_ = now;
  }
  const Status sent = send_ ? send_(request) : Status(fail("no transport"));
  if (sent) return;
  log::debug("{}: request {} not sent: {}", client_id_, request.seq, sent.error().message);
  report_.count(&SessionStats::requests_unsent);
}

// What is logged is logged without the lock here and below: who hears a line may ask.

CloudCodec ServerTalk::choose_codec(Time now) {
  std::unique_lock lock(mutex_);
  const CloudCodec before = std::exchange(codec_, codecs_.choose(servers_.followed(), now));
  const CloudCodec chosen = codec_;
  lock.unlock();
  if (chosen != before)
    log::limited(codec_lines_, "{}: clouds travel as {} in place of {}: that is what the servers in sight read",
                 client_id_, name_of(chosen), name_of(before));
  return chosen;
}

void ServerTalk::heard_server(const std::string& server_id, const std::vector<CloudCodec>& reads, Time now) {
  const std::scoped_lock lock(mutex_);
  codecs_.heard(server_id, reads, now);
}

bool ServerTalk::takes(const SpotReply& reply, Time now) {
  std::unique_lock lock(mutex_);
  if (!open_.answered_by(reply)) {
    lock.unlock();
    report_.samples_refused(
        &SessionStats::replies_strange, 1,
        fmt::format("a reply of {} to request {}, which was not sent, or too long ago, is dropped",
                    reply.server_id, reply.seq));
    return false;
  }
  unanswered_since_.reset();
  const std::string before = servers_.followed();
  if (!servers_.takes(reply, now)) return false;
  lock.unlock();
  tell_change(before, reply.server_id);
  return true;
}

std::optional<SpotReply> ServerTalk::take_overdue(Time now) {
  std::unique_lock lock(mutex_);
  const std::string before = servers_.followed();
  auto reply = servers_.take_overdue(now);
  lock.unlock();
  if (reply) tell_change(before, reply->server_id);
  return reply;
}

void ServerTalk::tell_change(const std::string& before, const std::string& followed) {
  if (!before.empty() && followed != before)
    log::limited(server_lines_, "{}: {} answers in place of {}", client_id_, followed, before);
}

bool ServerTalk::unanswered(Time now) const {
  const std::scoped_lock lock(mutex_);
  return unanswered_since_ && now - *unanswered_since_ > kUnanswered;
}

void ServerTalk::namesake_heard(Time now) {
  std::unique_lock lock(mutex_);
  const auto before = std::exchange(namesake_at_, now);
  lock.unlock();
  if (!before || now - *before > kNamesakeTold) log::warning("{}: {}", client_id_, namesake_problem());
}

std::string ServerTalk::namesake_problem() const {
  return fmt::format("another device asks as {}: give each an id of its own", client_id_);
}

std::string ServerTalk::problem(Time now) const {
  const std::scoped_lock lock(mutex_);
  return namesake_at_ && now - *namesake_at_ < kNamesakeTold ? namesake_problem() : "";
}

}  // namespace liloc

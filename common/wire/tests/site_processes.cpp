#include "common/wire/tests/site_processes.hpp"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <new>
#include <thread>

#include "common/wire/dds/security.hpp"
#include "common/wire/dds/topics.hpp"
#include "common/wire/dds/typed.hpp"
#include "common/wire/spots/client_link.hpp"
#include "common/wire/spots/convert_spot.hpp"
#include "common/wire/spots/server_link.hpp"
#include "common/wire/spots/status.hpp"
#include "common/wire/spots/tests/samples.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;
constexpr std::uint64_t kForgedSeq = 1'000'000;  // from here on, requests and replies are the intruder's
const char* const kVictim = "robotA";

/// Whatever a child cannot do is seen by its end.
template <class T>
T must(Result<T> result) {
  if (result) return std::move(*result);
  fmt::print(stderr, "{}\n", result.error().message);
  _exit(3);
}

Qos intruder_qos(const Intruder& intruder, const std::string& plugins_of) {
  if (intruder.credentials.empty()) return make_qos();
  Qos qos = must(security_qos(plugins_of));
  const auto set = [&](const char* name, const std::string& file) {
    dds_qset_prop(qos.get(), name, ("file:" + intruder.credentials + "/" + file).c_str());
  };
  set("dds.sec.auth.identity_ca", "identity_ca.cert.pem");
  set("dds.sec.auth.identity_certificate", "cert.pem");
  set("dds.sec.auth.private_key", "key.pem");
  set("org.eclipse.cyclonedds.sec.auth.crl", "crl.pem");
  set("dds.sec.access.permissions_ca",
      intruder.permissions_ca.empty() ? "permissions_ca.cert.pem" : intruder.permissions_ca);
  set("dds.sec.access.governance", "governance.p7s");
  set("dds.sec.access.permissions", "permissions.p7s");
  if (!intruder.patched) return qos;
  char* real = nullptr;
  dds_qget_prop(qos.get(), "dds.sec.access.library.path", &real);
  setenv("LILOC_REAL_ACCESS_CONTROL", real, 1);  // NOLINT(concurrency-mt-unsafe): before any thread
  dds_free(real);
  dds_qset_prop(qos.get(), "dds.sec.access.library.path", LILOC_LENIENT_ACCESS_CONTROL);
  return qos;
}

std::string domain_xml(int domain, const Intruder& intruder) {
  std::string xml = must(profile_xml({.domain = domain, .role = Role::source}));  // where all look for somebody
  if (!intruder.domain_tag.empty())
    xml.insert(xml.find("<ParticipantIndex>"), "<Tag>" + intruder.domain_tag + "</Tag>");
  return xml;
}

/// What the intruder was let create; the rest is empty.
class Tools {
 public:
  Tools(std::int32_t participant, const std::string& partition, Tally& tally)
      : participant_(participant), partition_(partition), tally_(tally) {
    requests_out = writer<liloc_msg_SpotRequest>(kRequestTopic, reliable_qos(8));
    replies_out = writer<liloc_msg_SpotReply>(kReplyTopic, kept_qos(8));
    requests_in = reader<liloc_msg_SpotRequest>(kRequestTopic, reliable_qos(64), partition_);
    replies_in = reader<liloc_msg_SpotReply>(kReplyTopic, kept_qos(16), partition_);
    status_in = reader<liloc_msg_ServerStatus>(kStatusTopic, kept_qos(1), kStatusPartition);
  }

  Entity requests_out, replies_out, requests_in, replies_in, status_in;

 private:
  Entity keep(Result<Entity> made) {
    if (made) return std::move(*made);
    ++tally_.refused;
    return {};
  }
  template <class T>
  Entity writer(const char* topic, Qos qos) {
    parents_.push_back(
        keep(checked(dds_create_publisher(participant_, partition_qos(partition_).get(), nullptr), "p")));
    return keep(make_writer<T>(participant_, parents_.back().handle(), topic, std::move(qos)));
  }
  template <class T>
  Entity reader(const char* topic, Qos qos, const std::string& partition) {
    parents_.push_back(
        keep(checked(dds_create_subscriber(participant_, partition_qos(partition).get(), nullptr), "s")));
    return keep(make_reader<T>(participant_, parents_.back().handle(), topic, std::move(qos)));
  }

  std::int32_t participant_;
  std::string partition_;
  Tally& tally_;
  std::vector<Entity> parents_;
};

SpotRequest request_of_victim(std::uint64_t seq) {
  SpotRequest request = sample_request(kVictim, seq);
  request.lpc.bytes.assign(kPlainText.begin(), kPlainText.end());
  return request;
}

template <class T>
void read(const Entity& reader, const std::function<void(const T&)>& handle) {
  if (reader.handle() > 0)
    take_each<T>(reader.handle(), [&](const T& message, const dds_sample_info_t&) { handle(message); });
}

}  // namespace

Tally& shared_tally() {
  void* memory = mmap(nullptr, sizeof(Tally), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  return *new (memory) Tally;
}

Process::Process(const std::function<void()>& work) : pid_(fork()) {
  if (pid_ != 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves nobody behind
  work();
  for (;;) pause();
}
Process::~Process() {
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}
bool Process::running() const {
  siginfo_t ended{};
  return waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == 0;
}

void serve(int domain, const std::string& credentials, Tally& tally) {
  const auto seat =
      must(Participant::create({.domain = domain, .role = Role::server, .credentials = credentials}));
  const auto dispatcher = must(Dispatcher::create(seat));
  std::unique_ptr<ServerLink> link;
  link = must(ServerLink::create(*dispatcher, {}, {.on_request = [&](const Arrival& arrival) {
    ++(arrival.request.seq >= kForgedSeq ? tally.forged_taken : tally.served);
    static_cast<void>(link->reply(arrival.from, sample_reply(arrival.request)));
  }}));
  const auto status = must(StatusPublisher::create(seat));
  dispatcher->every(
      100ms, [&] { static_cast<void>(status.publish({.server_id = "edge", .lidars = {}, .codecs = {}})); });
  dispatcher->start();
  for (;;) pause();
}

void ask(int domain, const std::string& credentials, Tally& tally) {
  const auto seat = must(Participant::create({.domain = domain, .credentials = credentials}));
  const auto dispatcher = must(Dispatcher::create(seat));
  const auto link = must(ClientLink::create(*dispatcher, kVictim, {.on_reply = [&](const SpotReply& reply) {
    ++(reply.seq >= kForgedSeq ? tally.forged_believed : tally.answered);
  }}));
  dispatcher->start();
  for (std::uint64_t seq = 1;; ++seq, std::this_thread::sleep_for(50ms))
    if (link->send(request_of_victim(seq))) ++tally.asked;  // nobody may be there yet
}

void intrude(int domain, const Intruder& intruder, const std::string& plugins_of, Tally& tally) {
  const Qos qos = intruder_qos(intruder, plugins_of);
  const Entity owner = must(checked(
      dds_create_domain(static_cast<dds_domainid_t>(domain), domain_xml(domain, intruder).c_str()), "d"));
  const auto participant =
      checked(dds_create_participant(static_cast<dds_domainid_t>(domain), qos.get(), nullptr), "participant");
  if (!participant) {
    ++tally.refused;
    tally.tries = true;
    for (;;) pause();
  }
  const Tools tools(participant->handle(), intruder.partition, tally);
  tally.tries = true;
  const std::string name = intruder.partition.substr(std::string(kClientPrefix).size());
  std::uint64_t session = 1;
  for (std::uint64_t seq = kForgedSeq;; ++seq, std::this_thread::sleep_for(20ms)) {
    const SpotRequest request = sample_request(name, seq);
    auto forged_request = must(to_wire(request, 1));
    dds_write(tools.requests_out.handle(), &forged_request.message);
    const liloc_msg_SpotReply forged_reply = to_wire(sample_reply(request), session);
    dds_write(tools.replies_out.handle(), &forged_reply);
    read<liloc_msg_SpotRequest>(tools.requests_in, [&](const liloc_msg_SpotRequest& message) {
      if (message.seq >= kForgedSeq) return;  // its own
      ++tally.overheard;
      session = message.session;
    });
    read<liloc_msg_SpotReply>(tools.replies_in, [&](const liloc_msg_SpotReply& message) {
      if (std::string_view(message.server_id) == ServerLinkOptions{}.server_id) ++tally.stolen;
    });
    read<liloc_msg_ServerStatus>(tools.status_in, [&](const liloc_msg_ServerStatus&) { ++tally.statuses; });
  }
}

}  // namespace liloc::wire

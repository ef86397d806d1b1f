#include "server/web/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <array>

namespace liloc::web {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

constexpr std::array kStages{Stage::hold, Stage::wait, Stage::work};
// A tracked spot takes 4 ms, a search 30 to 100 ms, a device waits 4 s for an answer.
const prometheus::Histogram::BucketBoundaries kSeconds{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05,
                                                       0.1,   0.25,   0.5,   1,    2.5,   5};

// Told from 0 on, so that rates see the first one of each.
constexpr std::array kUsual{std::pair{SpotStatus::verified, Reason::confirmed},
                            std::pair{SpotStatus::provisional, Reason::awaiting_spots},
                            std::pair{SpotStatus::refused, Reason::not_found},
                            std::pair{SpotStatus::refused, Reason::overloaded}};

prometheus::Labels labels_of(SpotStatus status, Reason reason) {
  return {{"status", std::string(liloc::name_of(status))}, {"reason", std::string(liloc::name_of(reason))}};
}

const char* name_of(Stage stage) {
  switch (stage) {
    case Stage::hold:
      return "hold";
    case Stage::wait:
      return "wait";
    case Stage::work:
      return "work";
  }
  return "unknown";
}

/// One family of figures that are read off when asked for.
MetricFamily family(MetricType type, const char* name, const char* help) {
  return {name, help, type, {}};
}

void add(MetricFamily& to, double value, std::vector<ClientMetric::Label> labels = {}) {
  ClientMetric metric;
  metric.label = std::move(labels);
  (to.type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
  to.metric.push_back(std::move(metric));
}

MetricFamily single(MetricType type, const char* name, const char* help, double value) {
  MetricFamily made = family(type, name, help);
  add(made, value);
  return made;
}

void append_server(const ServerFacts& facts, std::vector<MetricFamily>& out) {
  auto info = family(MetricType::Gauge, "liloc_server_info", "1, with the server's name and version");
  add(info, 1, {{"server_id", facts.server_id}, {"version", facts.version}});
  out.push_back(std::move(info));
  out.push_back(single(MetricType::Gauge, "liloc_uptime_seconds", "Since the start", facts.uptime_s));
  out.push_back(single(MetricType::Gauge, "liloc_queue_depth", "Requests that wait", facts.service.queued));
  out.push_back(single(MetricType::Counter, "liloc_dds_samples_lost_total",
                       "Samples that DDS dropped before they were read",
                       static_cast<double>(facts.samples_lost)));
  if (const auto age_s = gpc_age_s(facts))
    out.push_back(single(MetricType::Gauge, "liloc_gpc_age_seconds",
                         "Since the newest ceiling frame of any LiDAR came", *age_s));
  auto clients =
      family(MetricType::Gauge, "liloc_clients", "Connected devices by their last answer; none: not yet");
  const ServiceCounters& s = facts.service;
  const double answered = s.clients_verified + s.clients_provisional + s.clients_refused;
  add(clients, s.clients_verified, {{"state", "verified"}});
  add(clients, s.clients_provisional, {{"state", "provisional"}});
  add(clients, s.clients_refused, {{"state", "refused"}});
  add(clients, std::max(0.0, static_cast<double>(facts.clients) - answered), {{"state", "none"}});
  out.push_back(std::move(clients));
}

void append_lidars(const ServerFacts& facts, std::vector<MetricFamily>& out) {
  auto up = family(MetricType::Gauge, "liloc_lidar_up", "1 where the LiDAR is heard, at its rate or slowly");
  auto rate = family(MetricType::Gauge, "liloc_lidar_rate_hz", "Frames a second");
  auto age = family(MetricType::Gauge, "liloc_lidar_age_seconds", "Since the newest good frame came");
  auto valid = family(MetricType::Gauge, "liloc_lidar_valid_share",
                      "Of the pixels of the frames of two seconds, with a return, median");
  auto clock = family(MetricType::Gauge, "liloc_lidar_clock_offset_seconds",
                      "Its clock ahead of the one that most LiDARs agree on");
  auto corrected =
      family(MetricType::Gauge, "liloc_lidar_clock_corrected", "1 where its stamps are set right by that");
  auto frames = family(MetricType::Counter, "liloc_lidar_frames_total", "Frames that were taken");
  auto dropped = family(MetricType::Counter, "liloc_lidar_dropped_total", "Frames that could not be used");
  for (const LidarFacts& lidar : facts.lidars) {
    const std::vector<ClientMetric::Label> label{{"lidar", lidar.health.id}};
    const auto state = lidar.health.state;
    add(up, wire::is_heard(state) ? 1 : 0, label);
    add(rate, lidar.health.measured_hz, label);
    if (lidar.age_s) add(age, *lidar.age_s, label);
    if (lidar.age_s) add(valid, lidar.health.returns, label);
    if (lidar.age_s) add(clock, lidar.health.clock_offset_s, label);
    if (lidar.age_s) add(corrected, lidar.health.clock_corrected ? 1 : 0, label);
    add(frames, static_cast<double>(lidar.health.frames), label);
    add(dropped, static_cast<double>(lidar.health.malformed), label);
  }
  for (auto* made : {&up, &rate, &age, &valid, &clock, &corrected, &frames, &dropped})
    out.push_back(std::move(*made));
}

void append_process(std::vector<MetricFamily>& out) {  // by the names that Prometheus' own clients use
  const ProcessFacts facts = process_facts();
  out.push_back(
      single(MetricType::Gauge, "process_resident_memory_bytes", "Memory in use", facts.resident_bytes));
  out.push_back(single(MetricType::Counter, "process_cpu_seconds_total", "Processor time", facts.cpu_s));
  out.push_back(single(MetricType::Gauge, "process_threads", "Threads", facts.threads));
  out.push_back(single(MetricType::Gauge, "process_open_fds", "Open files", facts.open_files));
}

}  // namespace

struct Metrics::Impl {
  prometheus::Registry registry;
  prometheus::Family<prometheus::Counter>* requests = nullptr;
  std::array<prometheus::Histogram*, kStages.size()> stages{};
};

Metrics::Metrics() : impl_(std::make_unique<Impl>()) {
  auto& requests = prometheus::BuildCounter()
                       .Name("liloc_requests_total")
                       .Help("Answered requests by status and reason")
                       .Register(impl_->registry);
  impl_->requests = &requests;
  for (const auto& [status, reason] : kUsual) requests.Add(labels_of(status, reason));
  auto& stages =
      prometheus::BuildHistogram()
          .Name("liloc_request_stage_seconds")
          .Help(
              "Time of requests. hold: for the ceiling to catch up; wait: until a worker takes it, hold "
              "included; work: in the localizer")
          .Register(impl_->registry);
  for (const Stage stage : kStages)
    impl_->stages.at(static_cast<std::size_t>(stage)) = &stages.Add({{"stage", name_of(stage)}}, kSeconds);
}

Metrics::~Metrics() = default;

void Metrics::staged(Stage stage, double seconds) {
  impl_->stages.at(static_cast<std::size_t>(stage))->Observe(seconds);
}

void Metrics::answered(const SpotReply& reply) {
  impl_->requests->Add(labels_of(reply.status, reply.reason)).Increment();
}

std::string Metrics::text(const ServerFacts& facts) const {
  std::vector<MetricFamily> families = impl_->registry.Collect();
  append_server(facts, families);
  append_lidars(facts, families);
  append_process(families);
  std::erase_if(families, [](const MetricFamily& made) { return made.metric.empty(); });
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace liloc::web

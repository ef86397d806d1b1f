#pragma once
// The server's figures in Prometheus' text format. deploy/grafana/liloc.json shows all of them.
#include <memory>
#include <string>

#include "server/web/facts.hpp"

namespace liloc::web {

/// No label names a client: their number has no bound. Thread-safe.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  /// A request has left a stage after so long.
  void staged(Stage stage, double seconds);
  /// A request was answered.
  void answered(const SpotReply& reply);
  /// All of it: what was counted, and what the server is now.
  [[nodiscard]] std::string text(const ServerFacts& facts) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace liloc::web

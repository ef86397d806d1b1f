#pragma once
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "common/registration/spot/hypothesis.hpp"

namespace liloc {

/// A way to find candidate poses. Stateless; any thread may call it.
class Proposer {
 public:
  virtual ~Proposer() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Empty when the proposer cannot work on this problem (no gravity, no features).
  [[nodiscard]] virtual std::vector<Candidate> propose(const SpotProblem& problem) const = 0;
};

/// A direction of the device's frame and one of the map's that are taken for the same: up.
struct UpPair {
  Eigen::Vector3d sensor, map;
  bool supported = false;  ///< the device's gravity and the planes it sees agree
};
/// What to search with, likeliest first: gravity as the device says, and where the planes it sees contradict,
/// as they say. Of a device that says nothing, the likeliest that its planes say, alone: features find sooner
/// what that misses.
[[nodiscard]] std::vector<UpPair> ups_to_try(const SpotProblem& problem);

class GravityProposer final : public Proposer {
 public:
  /// Without `up` it takes the device's word.
  explicit GravityProposer(std::optional<UpPair> up = std::nullopt) : up_(std::move(up)) {}
  [[nodiscard]] std::string_view name() const override { return "gravity"; }
  [[nodiscard]] std::vector<Candidate> propose(const SpotProblem& problem) const override;

 private:
  std::optional<UpPair> up_;
};

class FeatureProposer final : public Proposer {
 public:
  explicit FeatureProposer(FeatureSearchOptions options) : options_(options) {}
  [[nodiscard]] std::string_view name() const override { return "features"; }
  [[nodiscard]] std::vector<Candidate> propose(const SpotProblem& problem) const override;

 private:
  FeatureSearchOptions options_;
};

}  // namespace liloc

#pragma once
// What `liloc plan` tells: a table, plan.json.
#include <nlohmann/json.hpp>
#include <string>

#include "server/plan/evaluation.hpp"
#include "server/plan/study.hpp"
#include "server/tools/plan/plan_input.hpp"

namespace liloc::toolbox {

/// All that was found out about a site.
struct PlanFindings {
  Site site;
  plan::DeviceViews devices;
  plan::Evaluation evaluation;
  std::optional<plan::Study> study;
};

/// A table for people.
[[nodiscard]] std::string plan_table(const PlanInput& input, const PlanFindings& findings);

/// The object of plan.json.
[[nodiscard]] nlohmann::ordered_json plan_json(const PlanInput& input, const PlanFindings& findings);

}  // namespace liloc::toolbox

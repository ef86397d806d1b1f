#include <algorithm>
#include <nlohmann/json.hpp>

#include "server/answers/explanation.hpp"

namespace liloc::answers {
namespace {

double yaw_deg(const Pose& T) {  // of the optical axis, seen from above
  const Eigen::Vector3d ahead = T.linear().col(2);
  return degrees(std::atan2(ahead.y(), ahead.x()));
}

std::string place_text(const Pose& T) {
  const Eigen::Vector3d t = T.translation();
  return fmt::format("x {:.2f} y {:.2f} z {:.2f} m, looks to {:.0f} deg", t.x(), t.y(), t.z(), yaw_deg(T));
}

/// As a share of the risk of a whole: odds against, as a probability.
double percent_of(double odds) {
  return 100 * odds / (1 + odds);
}

std::string answer_text(const Answered& answered) {
  const SpotReply& reply = answered.reply;
  std::string text =
      fmt::format("{} request {} at {}: {} ({}), confidence {:.4f}, needed {:.4f}, advice {}\n",
                  reply.client_id, reply.seq, reply.stamp_ns, name_of(reply.status), name_of(reply.reason),
                  reply.confidence, least_confidence(answered.options.risk), name_of(reply.advice));
  if (!reply.text.empty()) text += "  " + reply.text + "\n";
  if (reply.T_map_sensor) text += "  answered: " + place_text(*reply.T_map_sensor) + "\n";
  return text;
}

std::string again_text(const Explanation& explanation) {
  if (explanation.differences.empty()) return "run again: the same to the digit\n";
  std::string text =
      "run again: another answer (another version, another machine, or a search that was cut off)\n";
  for (const std::string& difference : explanation.differences) text += "  " + difference + "\n";
  return text;
}

std::string place_line(std::size_t rank, const Pose& T, const PlaceEvidence& place) {
  return fmt::format(
      "  {}. {}; {:.0f} of {:.0f} searches came there, recognized {:.1f}, contradiction {:.2f}\n", rank,
      place_text(T), place.agreeing, place.searches, place.bits, place.looks.contradiction);
}

std::string places_text(const Evidence& evidence) {
  if (evidence.places.empty()) return "";
  std::string text = fmt::format("places found: {}\n", evidence.places.size());
  for (std::size_t i = 0; i < evidence.places.size(); ++i)
    text += place_line(i + 1, evidence.T_map_sensors[i], evidence.places[i]);
  const Risks risks = risks_of(evidence.places);
  double rivals = 0;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < risks.rivals.size(); ++i) {
    rivals += risks.rivals[i];
    if (risks.rivals[i] > risks.rivals[worst]) worst = i;
  }
  text += "risks that the first is wrong:\n";
  text += fmt::format("  clutter that happens to fit: {:.3g} %\n", percent_of(risks.clutter));
  text += fmt::format("  a twin of it that the ceiling does not see: {:.3g} %\n", percent_of(risks.twin));
  text += fmt::format("  another of the places: {:.3g} %{}\n", percent_of(rivals),
                      rivals > 0 ? fmt::format(", most of all place {}", worst + 2) : "");
  return text;
}

std::string followed_text(const Answered& answered) {
  if (!answered.before || !answered.before->followed) return "";
  const Followed& followed = *answered.before->followed;
  return fmt::format("a pose was followed, at {:.4f} before this spot\n", confidence_of(followed));
}

std::string looks_text(const Explanation& explanation) {
  if (!explanation.T_map_sensor) return "";
  const Judgement& j = explanation.judgement;
  return fmt::format(
      "at the answer: of the device's points {:.1f} % agree with the ceiling, {:.1f} % contradict it, {:.1f} % "
      "it does not "
      "see\n"
      "  of the ceiling's points in view the device sees {:.1f} % and looks through {:.1f} %\n",
      100 * j.agree, 100 * j.conflict, 100 * (1 - j.agree - j.conflict), 100 * j.map_agree,
      100 * j.map_conflict);
}

nlohmann::ordered_json matrix_json(const Pose& T) {
  auto rows = nlohmann::ordered_json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back({T.matrix()(row, 0), T.matrix()(row, 1), T.matrix()(row, 2), T.matrix()(row, 3)});
  return rows;
}

}  // namespace

std::string to_text(const SavedAnswer& saved, const Explanation& explanation) {
  const Evidence& evidence = explanation.again.answer.evidence;
  std::string text = answer_text(saved.answered) + again_text(explanation) + followed_text(saved.answered);
  if (evidence.places.empty())
    text += explanation.T_map_sensor ? "the room was not searched: what was known sufficed\n"
                                     : "no place was found\n";
  return text + places_text(evidence) + looks_text(explanation);
}

std::string to_json(const SavedAnswer& saved, const Explanation& explanation) {
  const SpotReply& reply = saved.answered.reply;
  const Evidence& evidence = explanation.again.answer.evidence;
  nlohmann::ordered_json json{{"client_id", reply.client_id},
                              {"seq", reply.seq},
                              {"stamp_ns", reply.stamp_ns},
                              {"status", name_of(reply.status)},
                              {"reason", name_of(reply.reason)},
                              {"advice", name_of(reply.advice)},
                              {"text", reply.text},
                              {"confidence", reply.confidence},
                              {"needed_confidence", least_confidence(saved.answered.options.risk)},
                              {"same_to_the_digit", explanation.differences.empty()},
                              {"differences", explanation.differences}};
  if (explanation.T_map_sensor) {
    const Judgement& j = explanation.judgement;
    json["T_map_sensor"] = matrix_json(*explanation.T_map_sensor);
    json["device"] = {{"agree", j.agree}, {"contradict", j.conflict}, {"missing", 1 - j.agree - j.conflict}};
    json["ceiling"] = {{"agree", j.map_agree}, {"contradict", j.map_conflict}};
  }
  json["places"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < evidence.places.size(); ++i)
    json["places"].push_back({{"T_map_sensor", matrix_json(evidence.T_map_sensors[i])},
                              {"agreeing", evidence.places[i].agreeing},
                              {"searches", evidence.places[i].searches},
                              {"recognized", evidence.places[i].bits},
                              {"contradiction", evidence.places[i].looks.contradiction}});
  if (!evidence.places.empty()) {
    const Risks risks = risks_of(evidence.places);
    json["odds_against"] = {{"clutter", risks.clutter}, {"twin", risks.twin}, {"rivals", risks.rivals}};
  }
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace liloc::answers

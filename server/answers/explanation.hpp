#pragma once
// Why an answer is what it is: given again, compared, and taken apart.
#include <string>
#include <vector>

#include "server/answers/answer_file.hpp"

namespace liloc::answers {

/// What the judge says of one point.
enum class Word : std::uint8_t {
  agrees,  ///< of the device: on a surface that the ceiling sees; of the ceiling: the device measured it too
  contradicts,  ///< where the other side looked through
  missing       ///< where the other side sees nothing, or something hides it
};
struct Marked {
  Eigen::Vector3f p_map;
  Word word;
};

struct Explanation {
  Rerun again;
  std::vector<std::string> differences;  ///< of the answer given again to the saved one; empty: to the digit
  std::optional<Pose> T_map_sensor;      ///< where the points below are drawn; empty: no place was found
  Judgement judgement;                   ///< of that place
  std::vector<Marked> device;            ///< the device's cloud at that place
  std::vector<Marked> ceiling;           ///< what of the room lies in the device's view there
};

/// Runs it again; takes as long as the answer took.
[[nodiscard]] Explanation explain(const SavedAnswer& saved);

/// For people: the answer, the places that were found, what speaks against the first, what agreed.
[[nodiscard]] std::string to_text(const SavedAnswer& saved, const Explanation& explanation);
/// The same as one JSON object.
[[nodiscard]] std::string to_json(const SavedAnswer& saved, const Explanation& explanation);
/// Top view and side view. `title` stands above.
[[nodiscard]] std::string to_svg(const SavedAnswer& saved, const Explanation& explanation,
                                 const std::string& title);

}  // namespace liloc::answers

#include "common/recording/bags/survey.hpp"

#include <algorithm>

#include "common/recording/bags/limits.hpp"

namespace liloc::bags {
namespace {

Status note_header(std::string_view cdr, TopicSurvey* topic) {
  auto header = header_of(cdr);
  if (!header) return tl::unexpected(header.error());
  if (topic->messages++ == 0) {
    topic->frame_id = std::move(header->frame_id);
    topic->first_ns = topic->last_ns = header->stamp_ns;
  }
  topic->first_ns = std::min(topic->first_ns, header->stamp_ns);
  topic->last_ns = std::max(topic->last_ns, header->stamp_ns);
  return {};
}

bool has_header(std::string_view type) {
  return type == kImage || type == kPoints || type == kImu;
}

Status note_transforms(std::string_view cdr, Frames* frames) {
  const auto all = transforms(cdr);
  if (!all) return tl::unexpected(all.error());
  for (const Transform& t : *all) frames->add(t.parent, t.child, t.T_parent_child);
  return {};
}

Status note_camera(const Message& message, Survey* survey) {
  if (survey->cameras.contains(message.topic)) return {};
  const auto info = camera_info(message.cdr);
  if (!info) return tl::unexpected(info.error());
  survey->cameras.emplace(message.topic, info->value);
  return {};
}

}  // namespace

double TopicSurvey::rate_hz() const {
  const double seconds = 1e-9 * static_cast<double>(last_ns - first_ns);
  return seconds > 0 ? std::clamp(static_cast<double>(messages - 1) / seconds, 0.1, 1000.0) : 1.0;
}

Result<Survey> survey_bag(const std::filesystem::path& bag, const std::vector<std::string>& wanted,
                          const std::function<bool()>& stopped) {
  Survey survey;
  std::vector<std::string> cameras;  // of other topics nobody asks
  for (const std::string& topic : wanted)
    cameras.push_back(topic.substr(0, topic.rfind('/') + 1) + "camera_info");
  const auto note = [&](const Message& message) -> Status {
    if (stopped && stopped()) return fail("{}: stopped by a signal", bag.string());
    auto known = survey.topics.find(message.topic);
    if (known == survey.topics.end() && survey.topics.size() >= kMostTopics)
      return fail("{}: has over {} topics; is it the right file?", bag.string(), kMostTopics);
    if (known == survey.topics.end())
      known =
          survey.topics.emplace(std::string(message.topic), TopicSurvey{std::string(message.type), "", 0, 0, 0})
              .first;
    Status noted;
    if (message.type == "tf2_msgs/msg/TFMessage") noted = note_transforms(message.cdr, &survey.frames);
    if (std::ranges::find(cameras, message.topic) != cameras.end() && message.type == kCameraInfo)
      noted = note_camera(message, &survey);
    if (std::ranges::find(wanted, message.topic) != wanted.end() && has_header(message.type))
      noted = note_header(message.cdr, &known->second);
    if (!noted) survey.left_out[known->first].add(noted.error());
    return {};
  };
  if (const Status read = read_bag(bag, note); !read) return tl::unexpected(read.error());
  return survey;
}

std::string none_of(const std::string& topic, const LeftOutByTopic& left_out) {
  const auto why = left_out.find(topic);
  return topic + ": none of its messages can be used" +
         (why == left_out.end() ? "; record it anew" : "; the first " + why->second.first);
}

Result<Camera> camera_of(const Survey& survey, const std::string& topic) {
  const std::string info = topic.substr(0, topic.rfind('/') + 1) + "camera_info";
  const auto camera = survey.cameras.find(info);
  if (camera == survey.cameras.end() && survey.left_out.contains(info))
    return fail("{}", none_of(info, survey.left_out));
  if (camera == survey.cameras.end())
    return fail("{}: its intrinsics are missing: the bag has no {}; record it too", topic, info);
  return camera->second;
}

}  // namespace liloc::bags

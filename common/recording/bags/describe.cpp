#include "common/recording/bags/describe.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "common/base/distinct_topics.hpp"
#include "common/base/ids.hpp"

namespace liloc::bags {
namespace {

using Types = std::vector<std::string_view>;

/// The topic, if it carries one of the types.
Result<TopicSurvey> topic_of(const std::string& bag, const Survey& survey, const std::string& name,
                             const Types& types) {
  const auto fits = [&](const TopicSurvey& topic) {
    return std::ranges::find(types, topic.type) != types.end();
  };
  const auto topic = survey.topics.find(name);
  if (topic != survey.topics.end() && fits(topic->second)) {
    if (topic->second.messages == 0) return fail("{}: {}", bag, none_of(name, survey.left_out));
    return topic->second;
  }
  if (topic != survey.topics.end())
    return fail("{}: {} carries {}; give one of {}", bag, name, topic->second.type, fmt::join(types, ", "));
  constexpr std::size_t kMostTold = 20;  // a line stays readable; by hand
  std::vector<std::string> fitting;
  for (const auto& [other, found] : survey.topics)
    if (fits(found) && fitting.size() < kMostTold) fitting.push_back(other);
  return fail("{}: has no topic {}; it has {}", bag, name,
              fitting.empty() ? "none of that kind" : fmt::format("{}", fmt::join(fitting, ", ")));
}

Result<GlobalLidar> lidar_of_bag(const std::string& bag, const Survey& survey, const std::string& id,
                                 const std::string& name, const std::string& world_frame) {
  const auto topic = topic_of(bag, survey, name, {kImage, kPoints});
  if (!topic) return tl::unexpected(topic.error());
  const auto camera = camera_of(survey, name);
  if (!camera) return fail("{}: {}; or give --site", bag, camera.error().message);
  const auto T_map_sensor = survey.frames.T_to_from(world_frame, topic->frame_id);
  if (!T_map_sensor)
    return fail("{}: no transform ties {}, the frame of {}, to {}; give --site or --world", bag,
                topic->frame_id, name, world_frame);
  return GlobalLidar{id, *camera, topic->rate_hz(), *T_map_sensor};
}

Result<Site> site_of(const std::string& bag, const Survey& survey, const ConvertOptions& options) {
  if (options.site_file.empty()) {
    Site site{options.world_frame, {}};
    for (const auto& [id, name] : options.lidars) {
      auto lidar = lidar_of_bag(bag, survey, id, name, options.world_frame);
      if (!lidar) return tl::unexpected(lidar.error());
      site.global_lidars.push_back(std::move(*lidar));
    }
    return site;
  }
  const auto known = read_site(options.site_file);
  if (!known) return tl::unexpected(known.error());
  Site site{known->world_frame, {}};
  for (const auto& [id, name] : options.lidars) {
    const auto topic = topic_of(bag, survey, name, {kImage, kPoints});
    if (!topic) return tl::unexpected(topic.error());
    const auto lidar = std::ranges::find(known->global_lidars, id, &GlobalLidar::id);
    if (lidar == known->global_lidars.end())
      return fail("{}: has no LiDAR {}; add it", options.site_file.string(), id);
    site.global_lidars.push_back(*lidar);
  }
  return site;
}

/// Intrinsics, depth scale and place at the IMU, without the rates.
Result<DeviceInfo> own_info(const std::string& bag, const Survey& survey, const ConvertOptions& options,
                            const std::string& id, const TopicSurvey& depth) {
  if (const auto file = options.device_files.find(id); file != options.device_files.end())
    return read_device(file->second);
  const std::string& name = options.devices.at(id);
  const auto camera = camera_of(survey, name);
  if (!camera) return fail("{}: {}; or give --device-file {}=device.json", bag, camera.error().message, id);
  DeviceInfo info;
  info.camera = *camera;
  if (const auto imu = options.imus.find(id); imu != options.imus.end())
    if (const auto topic = survey.topics.find(imu->second); topic != survey.topics.end())
      info.T_imu_sensor = survey.frames.T_to_from(topic->second.frame_id, depth.frame_id);
  return info;
}

Result<DeviceInfo> device_of(const std::string& bag, const Survey& survey, const ConvertOptions& options,
                             const std::string& id) {
  const auto depth = topic_of(bag, survey, options.devices.at(id), {kImage});
  if (!depth) return tl::unexpected(depth.error());
  auto info = own_info(bag, survey, options, id, *depth);
  if (!info) return info;
  info->id = id;
  info->rate_hz = depth->rate_hz();
  info->still_seconds = options.still_seconds.value_or(info->still_seconds);
  info->imu_rate_hz.reset();
  const auto name = options.imus.find(id);
  if (name == options.imus.end()) return info;
  const auto imu = topic_of(bag, survey, name->second, {kImu});
  if (!imu) return tl::unexpected(imu.error());
  info->imu_rate_hz = imu->rate_hz();
  if (info->T_imu_sensor) return info;
  return fail(
      "{}: no transform ties {}, the frame of {}, to {}; give --device-file {}=device.json, or leave out --imu",
      bag, imu->frame_id, name->second, depth->frame_id, id);
}

}  // namespace

std::vector<std::string> topics_of(const ConvertOptions& options) {
  std::vector<std::string> topics;
  for (const auto* names : {&options.lidars, &options.devices, &options.imus})
    for (const auto& [id, topic] : *names) topics.push_back(topic);
  return topics;
}

Status check(const ConvertOptions& options) {
  if (options.lidars.empty()) return fail("--lidar: none is given; a recording needs one; give ID=TOPIC");
  std::vector<std::string> sensors;
  for (const auto* names : {&options.lidars, &options.devices})
    for (const auto& [id, topic] : *names) {
      if (const auto valid = valid_id(id, "id"); !valid) return tl::unexpected(valid.error());
      sensors.push_back(id);
    }
  if (const Status distinct = check_distinct_topics(sensors); !distinct) return distinct;
  if (const auto world = valid_id(options.world_frame, "--world"); !world) return tl::unexpected(world.error());
  const auto orphan = [&](const auto& ids) {
    return std::ranges::find_if(ids, [&](const auto& of) { return !options.devices.contains(of.first); });
  };
  if (const auto of = orphan(options.imus); of != options.imus.end())
    return fail("--imu: there is no --device {}; give both", of->first);
  if (const auto of = orphan(options.truths); of != options.truths.end())
    return fail("--truth: there is no --device {}; give both", of->first);
  if (const auto of = orphan(options.device_files); of != options.device_files.end())
    return fail("--device-file: there is no --device {}; give both", of->first);
  const std::vector<std::string> topics = topics_of(options);
  if (std::set(topics.begin(), topics.end()).size() != topics.size())
    return fail("a topic is given twice; each belongs to one sensor");
  return {};
}

Result<Description> describe(const std::filesystem::path& bag, const Survey& survey,
                             const ConvertOptions& options) {
  auto site = site_of(bag.string(), survey, options);
  if (!site) return tl::unexpected(site.error());
  Description all{std::move(*site), {}};
  for (const auto& [id, topic] : options.devices) {
    auto device = device_of(bag.string(), survey, options, id);
    if (!device) return tl::unexpected(device.error());
    all.devices.push_back(std::move(*device));
  }
  return all;
}

}  // namespace liloc::bags

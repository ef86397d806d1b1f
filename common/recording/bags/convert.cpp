#include "common/recording/bags/convert.hpp"

#include <algorithm>

#include "common/geometry/depth.hpp"
#include "common/recording/bags/describe.hpp"
#include "common/recording/bags/limits.hpp"
#include "common/recording/new_folder.hpp"
#include "common/recording/writer.hpp"

namespace liloc::bags {
namespace {

namespace fs = std::filesystem;

/// Depth of one sensor: where it goes.
struct Stream {
  fs::path folder;
  Camera camera;
  StampNs last_ns = 0;
  std::size_t frames = 0;
};
struct Samples {
  fs::path file;
  std::vector<ImuSample> all;
};

Result<DepthImage> image_of(const Message& message, const Camera& camera) {
  if (message.type == kPoints)
    return point_cloud(message.cdr).map([&](const auto& points) {
      return cloud_to_depth(points.value, camera, points.stamp_ns);
    });
  return depth_image(message.cdr, camera.depth_scale_m).map([](auto&& image) {
    return std::move(image.value);
  });
}

/// Error: it cannot be written.
Status write_frame(const Message& message, Stream& stream, LeftOut& left_out) {
  const auto image = image_of(message, stream.camera).and_then([&](DepthImage of) -> Result<DepthImage> {
    if (of.width == stream.camera.width && of.height == stream.camera.height) return of;
    return fail("is {}x{}, the intrinsics are for {}x{}; correct one of them", of.width, of.height,
                stream.camera.width, stream.camera.height);
  });
  if (!image) return left_out.add(image.error()), Status();
  if (stream.frames > 0 && image->stamp_ns == stream.last_ns) return {};  // the same frame twice
  stream.last_ns = image->stamp_ns;
  ++stream.frames;
  return write_depth(stream.folder, *image);
}

Status take_sample(std::string_view cdr, std::vector<ImuSample>& samples, LeftOut& left_out) {
  const auto sample = imu(cdr);
  if (!sample) return left_out.add(sample.error()), Status();
  if (samples.size() >= kMostSamples) return fail("has over {} samples; cut the bag", kMostSamples);
  samples.push_back(sample->value);
  return {};
}

Status write_sorted(Samples& samples) {
  std::vector<ImuSample>& all = samples.all;
  std::ranges::stable_sort(all, {}, &ImuSample::stamp_ns);
  const auto same = [](const ImuSample& x, const ImuSample& y) { return x.stamp_ns == y.stamp_ns; };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  return write_imu(samples.file, all);
}

/// Everything but the frames and samples; says where those go.
class Outline {
 public:
  Outline(fs::path out, const ConvertOptions& options) : out_(std::move(out)), options_(options) {}

  Conversion<void> write(const Description& description) {
    if (Status written = write_site(out_ / "site.json", description.site); !written)
      return unwritten(written.error());
    for (const GlobalLidar& lidar : description.site.global_lidars)
      streams[options_.lidars.at(lidar.id)] = {out_ / "global" / lidar.id / "depth", lidar.camera};
    for (const DeviceInfo& device : description.devices)
      if (auto written = write_device(device); !written) return written;
    return {};
  }

  std::map<std::string, Stream, std::less<>> streams;   ///< by topic
  std::map<std::string, Samples, std::less<>> samples;  ///< by topic

 private:
  Conversion<void> write_device(const DeviceInfo& device) {
    const fs::path folder = out_ / "devices" / device.id;
    streams[options_.devices.at(device.id)] = {folder / "depth", device.camera};
    if (const auto topic = options_.imus.find(device.id); topic != options_.imus.end())
      samples[topic->second] = {folder / "imu.csv", {}};
    if (const auto file = options_.truths.find(device.id); file != options_.truths.end()) {
      const auto truth = read_tum(file->second);
      if (!truth) return tl::unexpected(truth.error());
      if (const Status written = write_tum(folder / "groundtruth.tum", *truth); !written)
        return unwritten(written.error());
    }
    const Status written = liloc::write_device(folder / "device.json", device);
    if (!written) return unwritten(written.error());
    return {};
  }

  const fs::path out_;
  const ConvertOptions& options_;
};

/// Frames to their folders, samples to memory; what cannot be used to `left_out`.
Conversion<void> read_frames(const fs::path& bag, const ConvertOptions& options, Outline& outline,
                             LeftOutByTopic& left_out) {
  Status written;
  const Status read = read_bag(bag, [&](const Message& message) -> Status {
    Status taken;
    if (options.stopped && options.stopped()) return fail("{}: stopped by a signal", bag.string());
    LeftOut unusable;
    if (const auto stream = outline.streams.find(message.topic); stream != outline.streams.end())
      written = write_frame(message, stream->second, unusable);
    else if (const auto imu = outline.samples.find(message.topic); imu != outline.samples.end())
      taken = take_sample(message.cdr, imu->second.all, unusable);
    if (!written) return written;
    if (!taken) return fail("{}: {}: {}", bag.string(), message.topic, taken.error().message);
    if (unusable.messages > 0) left_out[std::string(message.topic)].add({unusable.first});
    return {};
  });
  if (!written) return unwritten(written.error());
  if (!read) return tl::unexpected(read.error());
  return {};
}

/// What the survey left out of all that was used of it; frames and samples are counted when they are read.
LeftOutByTopic left_out_of(const Survey& survey) {
  LeftOutByTopic left_out;
  for (const auto& [topic, of] : survey.left_out) {
    const std::string& type = survey.topics.at(topic).type;
    if (type == "tf2_msgs/msg/TFMessage" || survey.cameras.contains(topic)) left_out[topic] = of;
  }
  return left_out;
}

Conversion<Converted> convert(const fs::path& bag, const fs::path& out, const ConvertOptions& options) {
  const auto survey = survey_bag(bag, topics_of(options), options.stopped);
  if (!survey) return tl::unexpected(survey.error());
  const auto description = describe(bag, *survey, options);
  if (!description) return tl::unexpected(description.error());
  Outline outline(out, options);
  if (const auto written = outline.write(*description); !written) return tl::unexpected(written.error());
  Converted converted{{}, left_out_of(*survey)};
  if (const auto read = read_frames(bag, options, outline, converted.left_out); !read)
    return tl::unexpected(read.error());
  for (const auto& [topic, stream] : outline.streams) converted.messages[topic] = stream.frames;
  for (auto& [topic, samples] : outline.samples) {
    if (const Status written = write_sorted(samples); !written) return unwritten(written.error());
    converted.messages[topic] = samples.all.size();
  }
  for (const auto& [topic, count] : converted.messages)
    if (count == 0) return fail("{}: {}", bag.string(), none_of(topic, converted.left_out));
  return converted;
}

}  // namespace

Conversion<Converted> convert_bag(const fs::path& bag, const fs::path& out, const ConvertOptions& options) {
  if (const auto files = files_of_bag(bag); !files) return tl::unexpected(files.error());
  if (const Status fine = check(options); !fine) return tl::unexpected(fine.error());
  auto folder = NewFolder::beside(out);
  if (!folder) return tl::unexpected(folder.error());
  auto converted = convert(bag, folder->path(), options);
  if (!converted) return converted;
  if (const Status kept = folder->keep(); !kept) return unwritten(kept.error());
  return converted;
}

}  // namespace liloc::bags

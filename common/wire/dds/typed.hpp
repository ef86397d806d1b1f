#pragma once
// Private to common/wire: readers and writers of the generated types. A topic, its type and its QoS go
// together.
#include <dds/dds.h>
#include <liloc.h>
#include <ros2.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "common/base/log.hpp"
#include "common/wire/dds/dispatcher.hpp"
#include "common/wire/dds/entity.hpp"
#include "common/wire/dds/qos.hpp"

namespace liloc::wire {

/// Descriptor of a generated type, and what a newer ROS 2 looks for in USER_DATA (empty for our own types).
template <class T>
struct TypeOf;

#define LILOC_WIRE_TYPE(type, hash)                                            \
  template <>                                                                  \
  struct TypeOf<type> {                                                        \
    static const dds_topic_descriptor_t* descriptor() { return &type##_desc; } \
    static constexpr const char* user_data = hash;                             \
  }
LILOC_WIRE_TYPE(liloc_msg_SpotRequest, "");
LILOC_WIRE_TYPE(liloc_msg_SpotReply, "");
LILOC_WIRE_TYPE(liloc_msg_ServerStatus, "");
LILOC_WIRE_TYPE(sensor_msgs_msg_dds__Image_,
                "typehash=RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47;");
LILOC_WIRE_TYPE(sensor_msgs_msg_dds__CameraInfo_,
                "typehash=RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275;");
LILOC_WIRE_TYPE(sensor_msgs_msg_dds__PointCloud2_,
                "typehash=RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5;");
LILOC_WIRE_TYPE(sensor_msgs_msg_dds__Imu_,
                "typehash=RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b;");
LILOC_WIRE_TYPE(geometry_msgs_msg_dds__PoseWithCovarianceStamped_,
                "typehash=RIHS01_26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e;");
LILOC_WIRE_TYPE(nav_msgs_msg_dds__Odometry_,
                "typehash=RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0;");
LILOC_WIRE_TYPE(tf2_msgs_msg_dds__TFMessage_,
                "typehash=RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087;");
LILOC_WIRE_TYPE(diagnostic_msgs_msg_dds__DiagnosticArray_,
                "typehash=RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e;");
#undef LILOC_WIRE_TYPE

inline void set_type_hash(dds_qos_t* qos, const std::string& user_data) {
  if (!user_data.empty()) dds_qset_userdata(qos, user_data.data(), user_data.size());
}

/// A topic handle is only needed while an endpoint on it is made.
template <class T>
Result<Entity> make_topic(std::int32_t participant, const std::string& name) {
  return checked(dds_create_topic(participant, TypeOf<T>::descriptor(), name.c_str(), nullptr, nullptr),
                 "topic " + name);
}

/// `parent`: a participant or publisher of `participant`.
template <class T>
Result<Entity> make_writer(std::int32_t participant, std::int32_t parent, const std::string& topic_name,
                           Qos qos) {
  const auto topic = make_topic<T>(participant, topic_name);
  if (!topic) return tl::unexpected(topic.error());
  set_type_hash(qos.get(), TypeOf<T>::user_data);
  return checked(dds_create_writer(parent, topic->handle(), qos.get(), nullptr), "writer of " + topic_name);
}

template <class T>
Result<Entity> make_reader(std::int32_t participant, std::int32_t parent, const std::string& topic_name,
                           Qos qos) {
  const auto topic = make_topic<T>(participant, topic_name);
  if (!topic) return tl::unexpected(topic.error());
  set_type_hash(qos.get(), TypeOf<T>::user_data);
  return checked(dds_create_reader(parent, topic->handle(), qos.get(), nullptr), "reader of " + topic_name);
}

/// Takes what has come, in order. At most 256 a call, so that a flood does not hold the thread.
template <class T>
void take_each(std::int32_t reader, const std::function<void(const T&, const dds_sample_info_t&)>& handle) {
  constexpr int kBatch = 16;  ///< samples on loan at once; by hand
  for (int taken = 0; taken < 256;) {
    std::array<void*, kBatch> samples{};
    std::array<dds_sample_info_t, kBatch> infos;
    const dds_return_t count = dds_take(reader, samples.data(), infos.data(), kBatch, kBatch);
    if (count < 0) log::warning("{}", check(count, "take").error().message);
    if (count <= 0) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      if (infos.at(i).valid_data) guarded([&] { handle(*static_cast<const T*>(samples.at(i)), infos.at(i)); });
    dds_return_loan(reader, samples.data(), count);
    taken += count;
  }
}

/// Reads `topic_name` on the dispatcher's thread for as long as the dispatcher lives. `subscriber` sets the
/// partition; an empty one stands for the default.
template <class T>
Status subscribe(Dispatcher& dispatcher, Entity subscriber, const std::string& topic_name, Qos qos,
                 std::function<void(const T&, const dds_sample_info_t&)> handle) {
  const auto participant = dispatcher.participant().handle();
  const auto parent = subscriber.handle() > 0 ? subscriber.handle() : participant;
  auto reader = make_reader<T>(participant, parent, topic_name, std::move(qos));
  if (!reader) return tl::unexpected(reader.error());
  auto condition = checked(dds_create_readcondition(reader->handle(), DDS_ANY_STATE), "read condition");
  if (!condition) return tl::unexpected(condition.error());
  const auto reader_handle = reader->handle(), condition_handle = condition->handle();
  std::vector<Entity> owned;  // children first
  owned.push_back(std::move(*condition));
  owned.push_back(std::move(*reader));
  owned.push_back(std::move(subscriber));
  return dispatcher.attach(condition_handle, std::move(owned), [reader_handle, handle = std::move(handle)] {
    take_each<T>(reader_handle, handle);
  });
}

}  // namespace liloc::wire

#pragma once
// Somebody in an open domain who means harm: what it sends no program of this project would send.
#include <string>
#include <vector>

#include "common/wire/dds/typed.hpp"

namespace liloc::inputs {

/// One writer of a topic of liloc's own, in partitions of its choice.
template <class Message>
class ForgedWriter {
 public:
  [[nodiscard]] static Result<ForgedWriter> create(const wire::Participant& seat, const char* topic,
                                                   const std::vector<std::string>& partitions) {
    std::vector<const char*> names;
    for (const std::string& partition : partitions) names.push_back(partition.c_str());
    const auto qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>(dds_create_qos(), dds_delete_qos);
    dds_qset_partition(qos.get(), static_cast<std::uint32_t>(names.size()), names.data());
    auto publisher =
        wire::checked(dds_create_publisher(seat.handle(), qos.get(), nullptr), "publisher of a stranger");
    if (!publisher) return tl::unexpected(publisher.error());
    auto writer = wire::make_writer<Message>(seat.handle(), publisher->handle(), topic, wire::reliable_qos(64));
    if (!writer) return tl::unexpected(writer.error());
    ForgedWriter forged;
    forged.publisher_ = std::move(*publisher);
    forged.writer_ = std::move(*writer);
    return forged;
  }
  void write(const Message& message) const { static_cast<void>(dds_write(writer_.handle(), &message)); }

 private:
  ForgedWriter() = default;
  wire::Entity publisher_, writer_;
};

/// Sends what it can think of against one client and all servers of a domain.
class Stranger {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Stranger>> join(int domain, const std::string& victim,
                                                              const std::string& lidar);

  /// One of each forgery, and a client that joins and leaves again under a new name.
  void molest();
  [[nodiscard]] int rounds() const { return rounds_; }

 private:
  explicit Stranger(wire::Participant seat, std::string victim)
      : seat_(std::move(seat)), victim_(std::move(victim)) {}
  void forge_requests();
  void forge_replies();
  void forge_status();
  void forge_images();

  wire::Participant seat_;
  const std::string victim_;
  int rounds_ = 0;
  std::vector<ForgedWriter<liloc_msg_SpotRequest>> requests_;
  std::vector<ForgedWriter<liloc_msg_SpotReply>> replies_;
  std::vector<ForgedWriter<liloc_msg_ServerStatus>> statuses_;
  std::vector<wire::Entity> images_;  ///< writers on a LiDAR's and the victim's topic of images
};

}  // namespace liloc::inputs

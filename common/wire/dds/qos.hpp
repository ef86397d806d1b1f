#pragma once
// Private to common/wire: the QoS of each kind of stream, said once.
#include <dds/dds.h>

#include <memory>
#include <string>

namespace liloc::wire {

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

inline Qos make_qos() {
  return {dds_create_qos(), &dds_delete_qos};
}

/// ROS's sensor data: best effort, volatile, the newest few.
inline Qos sensor_qos(int depth = 5) {
  Qos qos = make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  return qos;
}

/// Nothing lost while the other side is there; a writer waits 20 ms at most.
inline Qos reliable_qos(int depth) {
  Qos qos = make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_MSECS(20));
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  return qos;
}

/// Reliable, and kept for a reader that is matched a moment later.
inline Qos kept_qos(int depth) {
  Qos qos = reliable_qos(depth);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  return qos;
}

inline Qos partition_qos(const std::string& partition) {
  Qos qos = make_qos();
  dds_qset_partition1(qos.get(), partition.c_str());
  return qos;
}

}  // namespace liloc::wire

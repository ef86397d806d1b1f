#pragma once
// A site in processes of its own: a server and a device that do their work, and somebody who tries everything.
#include <sys/types.h>

#include <atomic>
#include <functional>
#include <string>
#include <string_view>

namespace liloc::wire {

/// What happened, in memory that the processes share.
struct Tally {
  // Of the server and the device that belong there.
  std::atomic<int> served = 0;           ///< requests of robotA
  std::atomic<int> asked = 0;            ///< requests that robotA sent
  std::atomic<int> answered = 0;         ///< replies that robotA took
  std::atomic<int> forged_taken = 0;     ///< requests of the intruder that the server took
  std::atomic<int> forged_believed = 0;  ///< replies of the intruder that robotA took
  // Of the intruder.
  std::atomic<int> refused = 0;     ///< entities that it was not let create, by its own library
  std::atomic<int> overheard = 0;   ///< requests of robotA that it read
  std::atomic<int> stolen = 0;      ///< replies for robotA, or in its own partition
  std::atomic<int> statuses = 0;    ///< of the server
  std::atomic<bool> tries = false;  ///< it has come as far as it could and is at work
};

/// One that all processes forked from now on see; never freed.
[[nodiscard]] Tally& shared_tally();

/// A process of this program that runs `work` until it is killed. Made before this process has threads of DDS.
class Process {
 public:
  explicit Process(const std::function<void()>& work);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  [[nodiscard]] bool running() const;

 private:
  pid_t pid_;
};

/// Answers every request and tells its status.
void serve(int domain, const std::string& credentials, Tally& tally);
/// robotA: a request each 50 ms.
void ask(int domain, const std::string& credentials, Tally& tally);

struct Intruder {
  std::string credentials = {};  ///< a folder, used without any check; empty: none
  std::string partition = "robots/robotA";
  bool patched = false;             ///< its library lets it create what its permissions forbid
  std::string permissions_ca = {};  ///< trusted by itself in place of the folder's
  std::string domain_tag = {};
};
/// Writes requests and replies and reads both, and the server's status, in any partition it is told.
/// `plugins_of`: credentials that are in order, to find the plugins by.
void intrude(int domain, const Intruder& intruder, const std::string& plugins_of, Tally& tally);

/// What robotA's clouds hold, to be found by whoever reads along.
inline constexpr std::string_view kPlainText = "a cloud of LiLoc in plain";
/// Records what goes to the server's port: `statuses` counts packets, `overheard` those with kPlainText. Needs
/// the right to record, and says in `refused` that it lacks it.
void read_packets(int domain, Tally& tally);
/// Records what goes to the server's port for a second, then sends it there again and again: as it was and with
/// a byte altered. Counts packets sent in `overheard`; needs the right to record, and says in `refused` that it
/// lacks it.
void replay_packets(int domain, Tally& tally);

}  // namespace liloc::wire

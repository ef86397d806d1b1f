#pragma once
// One process's seat on a DDS domain.
//
//   auto participant = wire::Participant::create({.domain = 3, .role = wire::Role::client});
//   auto dispatcher = wire::Dispatcher::create(*participant);
//   ... subscribe, then (*dispatcher)->start();
//
// Discovery is a star, never a mesh: the server sits at the domain's first port and everyone else knows only
// that one, the second, where a recording or a simulation may stream from, and the third, of a standby.
// CYCLONEDDS_URI, where set, replaces the whole profile.
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace liloc::wire {

enum class Role {
  server,   ///< port index 0; at most one process a host and domain
  source,   ///< port index 1: streams of a recording or a simulation, seen by servers and by clients
  standby,  ///< port index 2: a second server on one host
  client,   ///< no fixed port: devices, ceiling LiDARs, tools
  peer,  ///< finds every process of this host, e.g. the drivers on a robot; takes the lowest free index, so not
         ///< on a host where a server is to start later in the same domain
};

/// Defaults are by hand where nothing else is said.
struct DomainOptions {
  int domain = 0;  ///< 0..230
  Role role = Role::client;
  std::string interface = "lo";  ///< name ("eth0"), address ("10.0.0.7"), or "auto"; "lo" never leaves the host
  /// Hosts of the servers and of sources, for client and source; empty: this host.
  std::vector<std::string> peers = {};
  int receive_buffer_kb = 4096;  ///< lowered, with a warning, to what net.core.rmem_max allows
  /// Folder of deploy/credentials: traffic is then encrypted and signed, and only with those who have their own
  /// from the same keystore. Empty: open to everybody. One identity a process: Cyclone 0.10 holds the
  /// permissions of its first participant against all.
  std::string credentials = {};
};

/// The UDP port of a domain's server, which others find it at.
[[nodiscard]] int server_port(int domain);

/// Errors: domain out of range, an interface or peer that is no plain name.
[[nodiscard]] Status check(const DomainOptions& options);

/// What Cyclone DDS is configured with. Errors as of `check`.
[[nodiscard]] Result<std::string> profile_xml(const DomainOptions& options);

/// Movable; everything created on it must go first. Several in one process share the domain's first profile.
class Participant {
 public:
  /// Errors carry DDS's own text and the remedy: interface not found, port taken by another server; or what is
  /// wrong with the credentials (common/credentials), or that Cyclone DDS has no security plugins here.
  [[nodiscard]] static Result<Participant> create(const DomainOptions& options);

  [[nodiscard]] std::int32_t handle() const;
  [[nodiscard]] int domain() const;

 private:
  struct Impl;
  explicit Participant(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<Impl> impl_;
};

}  // namespace liloc::wire

#include "proto-tests/faults/network_host.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace liloc::faults {
namespace {

constexpr char kRemedy[] = "run it as root, or where unprivileged user namespaces are allowed";

/// A socket for requests about interfaces of the calling thread's network.
class Control {
 public:
  Control() : handle_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ~Control() {
    if (handle_ >= 0) close(handle_);
  }
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;
  [[nodiscard]] bool ask(unsigned long request, ifreq& about) const {
    return ioctl(handle_, request, &about) == 0;
  }

 private:
  int handle_;
};

ifreq about(const char* interface) {
  ifreq request{};
  std::strncpy(request.ifr_name, interface, IFNAMSIZ - 1);
  return request;
}

Status failed(const char* what) {
  return fail("network of our own: {}: {}", what, std::strerror(errno));
}

Status bring_up(const Control& control, const char* interface) {
  ifreq request = about(interface);
  if (!control.ask(SIOCGIFFLAGS, request)) return failed("flags of an interface");
  request.ifr_flags |= IFF_UP | IFF_RUNNING;
  return control.ask(SIOCSIFFLAGS, request) ? Status{} : failed("an interface does not come up");
}

Status set_address(const Control& control, unsigned long request_code, const char* address) {
  ifreq request = about(kInterface);
  sockaddr_in as_socket{};
  as_socket.sin_family = AF_INET;
  if (inet_pton(AF_INET, address, &as_socket.sin_addr) != 1)
    return fail("network of our own: \"{}\" is no IPv4 address", address);
  std::memcpy(&request.ifr_addr, &as_socket, sizeof as_socket);
  return control.ask(request_code, request) ? Status{} : failed("address of an interface");
}

Status set_addresses(const Control& control, const std::string& address) {
  if (const Status set = set_address(control, SIOCSIFADDR, address.c_str()); !set) return set;
  return set_address(control, SIOCSIFNETMASK, "255.255.255.0");
}

/// What `permitted` tries, in this order; exit codes of its process count from 1.
constexpr std::array<const char*, 4> kTried{"namespaces of our own", "mounts of our own", "/dev/net/tun",
                                            "TAP devices"};

/// The exit code: 0, or which of kTried the system refused.
int try_all() {
  const int user = geteuid() == 0 ? 0 : CLONE_NEWUSER;
  if (unshare(user | CLONE_NEWNS | CLONE_NEWNET) != 0) return 1;
  if (mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return 2;
  const int wire = open("/dev/net/tun", O_RDWR | O_CLOEXEC);
  if (wire < 0) return 3;
  ifreq tap = about("probe0");
  tap.ifr_flags = IFF_TAP | IFF_NO_PI;
  return ioctl(wire, TUNSETIFF, &tap) == 0 ? 0 : 4;
}

bool write_line(const char* file, const std::string& line) {
  std::ofstream out(file);
  out << line << std::flush;
  return out.good();
}

}  // namespace

Status permitted() {
  const pid_t child = fork();
  if (child == 0) _exit(try_all());
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status))
    return fail("networks of our own: no process to try them in: {}", std::strerror(errno));
  const auto refused = static_cast<std::size_t>(WEXITSTATUS(status));
  if (refused == 0) return {};
  return fail("{} are not permitted here; {}, with the module tun", kTried.at(refused - 1), kRemedy);
}

Status enter_own_namespaces() {
  const uid_t user = geteuid();
  const gid_t group = getegid();
  if (unshare(user == 0 ? CLONE_NEWNS : CLONE_NEWUSER | CLONE_NEWNS) != 0)
    return fail("namespaces of our own: {}; {}", std::strerror(errno), kRemedy);
  if (user != 0 && !(write_line("/proc/self/setgroups", "deny") &&
                     write_line("/proc/self/uid_map", fmt::format("0 {} 1", user)) &&
                     write_line("/proc/self/gid_map", fmt::format("0 {} 1", group))))
    return fail("namespaces of our own: the user cannot be mapped; {}", kRemedy);
  if (mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0)
    return fail("namespaces of our own: mounts stay shared ({}); {}", std::strerror(errno), kRemedy);
  return {};
}

Status NetworkHost::open(const std::string& address) {
  if (unshare(CLONE_NEWNET) != 0) return fail("network of our own: {}; {}", std::strerror(errno), kRemedy);
  wire_ = ::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (wire_ < 0) return fail("/dev/net/tun: {}; {}, with the module tun", std::strerror(errno), kRemedy);
  ifreq tap = about(kInterface);
  tap.ifr_flags = IFF_TAP | IFF_NO_PI;
  if (ioctl(wire_, TUNSETIFF, &tap) != 0) return failed("TAP device");
  const Control control;
  ifreq hardware = about(kInterface);
  if (!control.ask(SIOCGIFHWADDR, hardware)) return failed("hardware address");
  std::memcpy(mac_.data(), hardware.ifr_hwaddr.sa_data, mac_.size());
  if (const Status up = bring_up(control, "lo"); !up) return up;
  if (const Status set = set_addresses(control, address); !set) return set;
  return bring_up(control, kInterface);
}

Result<std::unique_ptr<NetworkHost>> NetworkHost::create(const std::string& name, const std::string& address) {
  std::unique_ptr<NetworkHost> host(new NetworkHost(name));
  host->thread_ = std::jthread([self = host.get()](const std::stop_token& stop) { self->serve(stop); });
  Status opened;
  host->within([&] { opened = host->open(address); });
  if (!opened) return tl::unexpected(opened.error());
  return host;
}

NetworkHost::~NetworkHost() {
  thread_ = {};
  if (wire_ >= 0) close(wire_);
}

void NetworkHost::serve(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return work_ != nullptr; })) {
    (*work_)();
    work_ = nullptr;
    changed_.notify_all();
  }
}

void NetworkHost::within(const std::function<void()>& work) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return work_ == nullptr; });
  work_ = &work;
  changed_.notify_all();
  changed_.wait(lock, [this, &work] { return work_ != &work; });
}

Status NetworkHost::change_address(const std::string& address) {
  Status changed;
  within([&] { changed = set_addresses(Control(), address); });
  return changed;
}

}  // namespace liloc::faults

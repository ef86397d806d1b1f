#include "common/wire/dds/security.hpp"

#include <dlfcn.h>

#include <chrono>
#include <filesystem>
#include <vector>

#include "common/base/log.hpp"
#include "common/credentials/credentials.hpp"

namespace liloc::wire {
namespace {

using std::filesystem::path;

/// Where the library of DDS that this program runs with keeps its plugins: Debian's in a folder named after it
/// (libddsc0debian), others beside it.
Result<path> plugin_folder() {
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&dds_create_participant), &library) == 0)
    return fail("the library of Cyclone DDS cannot be located; link libddsc.so dynamically");
  const path file(library.dli_fname);
  const std::string name = file.filename().string();  // libddsc.so.0debian
  const auto version = name.find(".so.");
  std::vector<path> folders{file.parent_path()};
  if (version != std::string::npos)
    folders.insert(folders.begin(), file.parent_path() / (name.substr(0, version) + name.substr(version + 4)));
  std::error_code error;
  for (const path& folder : folders)
    if (std::filesystem::exists(folder / "libdds_security_auth.so", error)) return folder;
  return fail(
      "this Cyclone DDS ({}) has no security plugins beside it; install Debian's libddsc0debian, or build it "
      "with "
      "ENABLE_SECURITY",
      file.string());
}

void set_library(dds_qos_t* qos, const std::string& plugin, const path& file, const std::string& function) {
  const std::string prefix = "dds.sec." + plugin + ".library.";
  dds_qset_prop(qos, (prefix + "path").c_str(), file.c_str());
  dds_qset_prop(qos, (prefix + "init").c_str(), ("init_" + function).c_str());
  dds_qset_prop(qos, (prefix + "finalize").c_str(), ("finalize_" + function).c_str());
}

void set_file(dds_qos_t* qos, const char* name, const path& file) {
  dds_qset_prop(qos, name, ("file:" + file.string()).c_str());
}

}  // namespace

Result<Qos> security_qos(const std::string& folder) {
  const auto credentials = read_credentials(folder);
  if (!credentials) return fail("credentials: {}", credentials.error().message);
  const auto plugins = plugin_folder();
  if (!plugins) return fail("credentials: {}", plugins.error().message);
  warn_of(*credentials, std::chrono::system_clock::now());
  Qos qos = make_qos();
  set_library(qos.get(), "auth", *plugins / "libdds_security_auth.so", "authentication");
  set_library(qos.get(), "access", *plugins / "libdds_security_ac.so", "access_control");
  set_library(qos.get(), "crypto", *plugins / "libdds_security_crypto.so", "crypto");
  set_file(qos.get(), "dds.sec.auth.identity_ca", credentials->identity_ca());
  set_file(qos.get(), "dds.sec.auth.identity_certificate", credentials->certificate());
  set_file(qos.get(), "dds.sec.auth.private_key", credentials->key());
  set_file(qos.get(), "org.eclipse.cyclonedds.sec.auth.crl", credentials->revoked());
  set_file(qos.get(), "dds.sec.access.permissions_ca", credentials->permissions_ca());
  set_file(qos.get(), "dds.sec.access.governance", credentials->governance());
  set_file(qos.get(), "dds.sec.access.permissions", credentials->permissions());
  return qos;
}

}  // namespace liloc::wire

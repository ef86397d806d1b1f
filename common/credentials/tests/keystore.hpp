#pragma once
// A keystore of `deploy/credentials`, made for one test program and removed with it.
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): mkdtemp

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace liloc {

class Keystore {
 public:
  Keystore() {
    std::string name = (std::filesystem::temp_directory_path() / "liloc-keystore-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~Keystore() {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
  }
  Keystore(const Keystore&) = delete;
  Keystore& operator=(const Keystore&) = delete;

  /// Runs the command for the site `site`; tests start in the tree's root. True when it succeeded.
  [[nodiscard]] bool run(const std::string& command, const std::string& site = "site") const {
    return shell("deploy/credentials --keystore " + (folder_ / site).string() + " " + command);
  }
  /// Any command, in the keystore's own folder for temporary files. Its output goes to a log there.
  [[nodiscard]] bool shell(const std::string& command) const {
    const std::string log = (folder_ / "log").string();
    const std::string logged = command + " >>" + log + " 2>&1";
    return std::system(logged.c_str()) == 0;  // NOLINT(cert-env33-c,concurrency-mt-unsafe)
  }
  [[nodiscard]] std::filesystem::path party(const std::string& name, const std::string& site = "site") const {
    return folder_ / site / "parties" / name;
  }
  [[nodiscard]] std::filesystem::path authority(const std::string& site = "site") const {
    return folder_ / site / "authority";
  }
  /// A copy of a party's folder, as a thief or a device holds it.
  [[nodiscard]] std::filesystem::path copy(const std::filesystem::path& party, const std::string& as) const {
    const auto target = folder_ / as;
    std::filesystem::copy(party, target, std::filesystem::copy_options::recursive);
    return target;
  }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace liloc

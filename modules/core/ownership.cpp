#include "core/ownership.h"

#include <cerrno>
#include <cstdlib>
#include <sys/stat.h>

#include "core/descriptor.h"
#include "core/error.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

// Reason why code in the file or folder `path` is not trusted; `is_above`: a folder further up.
std::string distrust(const fs::path& path, bool is_above, uid_t user) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return path.string() + " cannot be read: " + reason(errno);
  if (info.st_uid != 0 && info.st_uid != user)
    return path.string() + " belongs to user " + std::to_string(info.st_uid) +
           (user == 0 ? ", and root runs code of system folders only"
                      : ", neither to you nor to root");
  const bool group = (info.st_mode & S_IWGRP) != 0 && info.st_gid != user;
  const bool is_sticky = is_above && user != 0 && (info.st_mode & S_ISVTX) != 0;
  if ((group || (info.st_mode & S_IWOTH) != 0) && !is_sticky)
    return "others may write into " + path.string() +
           (info.st_mode & S_ISVTX ? ": move the file to a folder of " +
                                         std::string(user == 0 ? "the system" : "your own")
                                   : ": run 'chmod go-w' on it");
  return {};
}

} // namespace

bool isForeignLink(const fs::path& path, uid_t user) {
  const fs::path link = path.has_filename() ? path : path.parent_path(); // "link/" means "link"
  struct stat info {
  }, folder{};
  if (::lstat(link.c_str(), &info) != 0 || !S_ISLNK(info.st_mode) || info.st_uid == user)
    return false;
  const fs::path parent = link.parent_path();
  if (::stat(parent.empty() ? "." : parent.c_str(), &folder) != 0) return false;
  constexpr mode_t kShared = S_ISVTX | S_IWOTH;
  return (folder.st_mode & kShared) == kShared && info.st_uid != folder.st_uid;
}

void refuseForeignLink(const fs::path& link, const fs::path& path) {
  if (isForeignLink(link))
    throw FileError(path.string(), 0,
                    "cannot be written: " + (link == path ? "it" : link.string()) +
                        " is a link of another user in a folder that everyone may write into; "
                        "name a file in a folder of your own");
}

bool isOwnFolder(const fs::path& path, uid_t user) {
  struct stat info {};
  return ::lstat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == user;
}

bool isPrivateFolder(const fs::path& path, uid_t user) {
  struct stat info {};
  return isOwnFolder(path, user) && ::lstat(path.c_str(), &info) == 0 &&
         (info.st_mode & 07777) == 0700;
}

RuntimeFolder runtimeFolder() {
  const char* given = std::getenv("XDG_RUNTIME_DIR");
  if (given && isPrivateFolder(given)) return {given, {}};
  RuntimeFolder taken{fs::temp_directory_path() / ("patina-runtime-" + std::to_string(::geteuid())),
                      {}};
  std::string refused = given && *given ? "XDG_RUNTIME_DIR=" + std::string(given) : "";
  ::mkdir(taken.path.c_str(), 0700);
  if (!isPrivateFolder(taken.path)) {
    refused += (refused.empty() ? "" : " or ") + taken.path.string();
    taken.path.clear();
  }
  if (!refused.empty())
    taken.problem =
        refused + " is not used for sockets: it must be a folder of your own with mode 0700";
  return taken;
}

fs::path trustedFile(const fs::path& file, uid_t user) {
  fs::path real;
  // The folder of a link counts, too: a person who can change it chooses the link's target.
  for (const fs::path& name : {file.parent_path() / ".", file}) {
    std::error_code code;
    real = fs::canonical(name, code);
    if (code) throw FileError(name.string(), 0, "cannot be read: " + code.message());
    int depth = name == file ? 0 : 1;
    if (depth == 0 && !fs::is_regular_file(real, code))
      throw FileError(file.string(), 0, "is no plain file");
    for (fs::path at = real;; at = at.parent_path(), ++depth) {
      const std::string cause = distrust(at, depth > 1, user);
      if (!cause.empty()) throw FileError(file.string(), 0, "is not trusted: " + cause);
      if (at == at.root_path()) break;
    }
  }
  return real;
}

} // namespace patina

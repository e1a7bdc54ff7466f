#include "core/output_target.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/descriptor.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/ownership.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxLinks = 40; // limit of the kernel

[[noreturn]] void refuse(const std::string& name, const std::string& cause) {
  throw FileError(name, 0, "cannot be written: " + cause);
}

// Opening /dev/stdout, a link to /proc/self/fd/1, would write a file from its start.
int openDescriptor(const fs::path& path) {
  const std::string parent = path.parent_path();
  const std::string self = "/proc/" + std::to_string(::getpid());
  if (parent != "/proc/self/fd" && parent != "/dev/fd" && parent != self + "/fd") return -1;
  const auto number = parseNumber(path.filename().string());
  return number && *number >= 0 && *number < 65536 ? static_cast<int>(*number) : -1;
}

} // namespace

bool isStandardStream(const fs::path& path) {
  return path == "-";
}

OutputTarget outputTarget(const fs::path& path) {
  const std::string name = path.string();
  OutputTarget target{name};
  if (isStandardStream(path)) {
    target.descriptor = STDOUT_FILENO;
    target.is_stream = true;
    return target;
  }
  fs::path end = path;
  for (int links = 0;; ++links) {
    if (const int descriptor = openDescriptor(end); descriptor >= 0) {
      if (::fcntl(descriptor, F_GETFD) < 0) refuse(name, reason(errno));
      target.descriptor = descriptor;
      target.is_stream = true;
      return target;
    }
    std::error_code none;
    const fs::path next = fs::read_symlink(end, none);
    if (none) break;
    if (links == kMaxLinks) refuse(name, reason(ELOOP));
    refuseForeignLink(end, path);
    end = next.is_absolute() ? next : end.parent_path() / next;
  }
  target.path = end.string();
  struct stat info {};
  if (::stat(target.path.c_str(), &info) != 0) {
    if (errno != ENOENT) refuse(name, reason(errno));
    return target;
  }
  target.exists = true;
  target.permissions = info.st_mode & 07777;
  if (S_ISDIR(info.st_mode)) refuse(name, "it is a folder");
  if (S_ISSOCK(info.st_mode)) refuse(name, "it is a socket");
  target.is_stream = !S_ISREG(info.st_mode);
  constexpr unsigned kAnyWrite = 0222;
  if ((info.st_mode & kAnyWrite) == 0 || ::access(target.path.c_str(), W_OK) != 0)
    refuse(name, "it is read-only");
  return target;
}

bool pathExists(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() == fs::file_type::not_found) return false;
  if (code) throw FileError(path.string(), 0, "cannot be opened: " + code.message());
  return true;
}

} // namespace patina

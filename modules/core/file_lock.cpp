#include "core/file_lock.h"

#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <sys/file.h>
#include <thread>
#include <unistd.h>

#include "core/descriptor.h"
#include "core/disk_error.h"
#include "core/partial_output.h"
#include "core/utc_time.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLockEnd = ".lock";
constexpr const char* kRemovalEnd = "-removal";
constexpr std::chrono::seconds kPatience{60};
constexpr std::chrono::milliseconds kRetryPause{20};

// The lines of a lock file.
struct Holder {
  std::string host;    // its name, boot and process namespace: process numbers are unique in it
  std::string process; // its number
  std::string start;   // when it started, in clock ticks: numbers are used again
  std::string time;    // when it made the lock file, UTC

  std::string text() const { return host + "\n" + process + "\n" + start + "\n" + time + "\n"; }
};

std::string thisHost() {
  char name[256] = {};
  ::gethostname(name, sizeof name - 1);
  std::string boot;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), boot);
  std::error_code none;
  return std::string(name) + " " + boot + " " +
         fs::read_symlink("/proc/self/ns/pid", none).string();
}

// Returns "" if the process has ended.
std::string startOf(const std::string& process) {
  std::ifstream file("/proc/" + process + "/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')'); // the name may have spaces
  if (name_end == std::string::npos) return "";
  std::istringstream fields(text.substr(name_end + 1));
  constexpr int kState = 3, kStart = 22; // numbers of the fields in proc(5)
  std::string field;
  for (int number = kState; number <= kStart && fields >> field; ++number)
    if (number == kState && (field == "Z" || field == "X")) return "";
  return field;
}

Holder thisProcess() {
  const std::string process = std::to_string(::getpid());
  return {thisHost(), process, startOf(process), formatUtc(utcSeconds())};
}

Holder holderOf(const std::string& lock_file) {
  Holder holder;
  std::ifstream file(lock_file);
  for (std::string* line : {&holder.host, &holder.process, &holder.start, &holder.time})
    std::getline(file, *line);
  return holder;
}

// An incomplete lock file is being written, or its process was killed before it could.
bool isAbandoned(const std::string& lock_file) {
  const Holder holder = holderOf(lock_file);
  if (!holder.time.empty())
    return holder.host == thisHost() && startOf(holder.process) != holder.start;
  std::error_code code;
  const auto written = fs::last_write_time(lock_file, code);
  return !code && fs::file_time_type::clock::now() - written > kPatience;
}

// Returns 0 or an errno value. The file appears with its whole content, by a hard link to a draft,
// so that a program that is killed meanwhile leaves no lock without a holder. A file system without
// links gets the file at once and then its content.
int makeLockFile(const std::string& lock_file, const std::string& content) {
  const std::string draft = lock_file + "-" + std::to_string(::getpid());
  const auto write = [&](const std::string& name, int flags) {
    Descriptor file(openRetrying(name.c_str(), O_WRONLY | O_CREAT | flags, 0666));
    if (file.get() < 0) return errno;
    if (writeAllAt(file.get(), content, 0) && file.close() == 0) return 0;
    const int code = errno;
    ::unlink(name.c_str());
    return code;
  };
  if (const int code = write(draft, O_TRUNC | O_NOFOLLOW); code != 0) return code;
  const int linked = ::link(draft.c_str(), lock_file.c_str()) == 0 ? 0 : errno;
  ::unlink(draft.c_str());
  return linked == 0 || linked == EEXIST ? linked : write(lock_file, O_EXCL);
}

// The second file keeps two programs that find the same abandoned lock from each removing one, the
// later one the lock that the other has made since.
void removeAbandoned(const std::string& lock_file) {
  const std::string removing = lock_file + kRemovalEnd;
  if (!isAbandoned(lock_file) || makeLockFile(removing, thisProcess().text()) != 0) return;
  if (isAbandoned(lock_file)) ::unlink(lock_file.c_str());
  ::unlink(removing.c_str());
}

int openedFolder(const std::filesystem::path& folder) {
  const int fd = openRetrying(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (fd < 0) throw DiskError(folder.string(), "cannot be opened: " + reason(errno));
  return fd;
}

} // namespace

FileLock::FileLock(int descriptor, const fs::path& path, Wait wait) {
  int result;
  do {
    result = ::flock(descriptor, LOCK_EX | (wait == Wait::no ? LOCK_NB : 0));
  } while (result != 0 && errno == EINTR);
  if (result == 0) return;
  if (errno == EWOULDBLOCK)
    throw FileError(path.string(), 0,
                    "another program is writing it; close that one, or save to another folder");
  const std::string why = reason(errno);
  std::error_code none;
  const bool is_folder = fs::is_directory(path, none);
  const fs::path folder = is_folder ? path : path.parent_path();
  const std::string name = is_folder ? "" : "." + path.filename().string();
  const std::string lock_file = (folder / (name + kLockEnd)).string();
  const auto end = std::chrono::steady_clock::now() + kPatience;
  for (;; std::this_thread::sleep_for(kRetryPause)) {
    removeAbandoned(lock_file);
    content_ = thisProcess().text();
    const int code = makeLockFile(lock_file, content_);
    if (code == 0) break;
    if (code != EEXIST) throw DiskError(lock_file, "cannot be made: " + reason(code));
    if (wait == Wait::yes && std::chrono::steady_clock::now() < end) continue;
    const Holder holder = holderOf(lock_file);
    throw FileError(path.string(), 0,
                    "another program is writing it, process " + holder.process + " on " +
                        holder.host.substr(0, holder.host.find(' ')) + " since " + holder.time +
                        "; close that one, or remove " + lock_file + " if it has ended");
  }
  lock_file_ = lock_file;
  warnOfOutput(fs::weakly_canonical(fs::absolute(folder), none).string() +
               ": the file system has no locks (" + why + "); lock files take their place");
}

FileLock::~FileLock() {
  if (!lock_file_.empty() && holderOf(lock_file_).text() == content_) ::unlink(lock_file_.c_str());
}

bool isFolderLockFile(const std::string& name) {
  return name.starts_with(kLockEnd);
}

FolderLock::FolderLock(const std::filesystem::path& folder)
    : folder_(openedFolder(folder)), lock_(folder_.get(), folder, FileLock::Wait::yes) {}

} // namespace patina

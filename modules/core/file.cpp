#include "core/file.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/descriptor.h"
#include "core/disk_error.h"
#include "core/ownership.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTemporaryEnd = ".tmp";
constexpr std::int64_t kPart = std::int64_t{4} << 20; // bytes per write-back request

struct Temporary {
  int fd;
  std::string name;
};

// Creates the file next to the target, because a rename is atomic only within one file system.
// Unlike mkstemp it uses the permissions of a plain open.
Temporary createBeside(const std::string& folder, const std::string& filename,
                       PartialOutput& unfinished) {
  static std::atomic<unsigned> counter{0};
  for (;;) {
    std::string name = folder + "/." + filename + "." + std::to_string(::getpid()) + "-" +
                       std::to_string(counter.fetch_add(1)) + std::string(kTemporaryEnd);
    unfinished =
        PartialOutput(name); // registered first, so that an early process exit removes the file
    const int fd = openRetrying(name.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666);
    const int code = errno;
    if (fd < 0) unfinished.done();
    errno = code;
    if (fd >= 0 || code != EEXIST) return {fd, std::move(name)};
  }
}

int renameRetrying(const char* from, const char* to) {
  int result;
  do {
    result = ::rename(from, to);
  } while (result != 0 && errno == EINTR);
  return result;
}

bool syncFolder(const char* folder) {
  const Descriptor directory(openRetrying(folder, O_RDONLY | O_DIRECTORY));
  return directory.get() >= 0 && syncRetrying(directory.get());
}

} // namespace

std::string readFile(const fs::path& path) {
  const Descriptor file(openToRead(path));
  return readAll(file.get(), path.string());
}

AtomicFile::AtomicFile(const fs::path& path)
    : path_(path.string()), target_(outputTarget(path)), file_(-1) {
  if (target_.is_stream) {
    file_.reset(target_.descriptor >= 0 ? ::fcntl(target_.descriptor, F_DUPFD_CLOEXEC, 3)
                                        : openStream(target_.path));
    if (file_.get() < 0) fail("cannot be written");
    return;
  }
  const fs::path end = target_.path, parent = end.parent_path();
  folder_ = parent.empty() ? "." : parent.string();
  const Temporary temporary = createBeside(folder_, end.filename().string(), unfinished_);
  if (temporary.fd < 0) fail("cannot be written");
  file_.reset(temporary.fd);
  temporary_ = temporary.name;
  if (!target_.exists || ::fchmod(file_.get(), target_.permissions) == 0) return;
  const int code = errno;
  ::unlink(temporary_.c_str());
  errno = code;
  fail("cannot be written");
}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::fail(const std::string& what) const {
  throw DiskError(path_, what + ": " + reason(errno));
}

void AtomicFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::string_view part = bytes.substr(0, std::size_t{kPart});
    const bool written =
        target_.is_stream ? writeAll(file_.get(), part) : writeAllAt(file_.get(), part, size_);
    if (!written) fail("cannot be written");
    size_ += static_cast<std::int64_t>(part.size());
    bytes.remove_prefix(part.size());
    if (!target_.is_stream) sendToDisk();
  }
}

// Starts write-back early, to shorten the flush in commit(), which cannot be interrupted.
void AtomicFile::sendToDisk() {
  if (size_ - sent_ < kPart) return;
  ::sync_file_range(file_.get(), sent_, size_ - sent_, SYNC_FILE_RANGE_WRITE);
  const std::int64_t before = std::max<std::int64_t>(0, sent_ - kPart);
  if (sent_ > before) // a length of 0 would mean up to the file's end
    ::sync_file_range(file_.get(), before, sent_ - before,
                      SYNC_FILE_RANGE_WAIT_BEFORE | SYNC_FILE_RANGE_WRITE |
                          SYNC_FILE_RANGE_WAIT_AFTER);
  sent_ = size_;
}

bool AtomicFile::commit() {
  if (target_.is_stream) {
    if (file_.close() != 0) fail("cannot be written");
    return true;
  }
  if (!syncRetrying(file_.get())) fail("cannot be flushed to disk");
  if (file_.close() != 0) fail("cannot be written");
  const auto rename = [&] { return renameRetrying(temporary_.c_str(), target_.path.c_str()); };
  if (unfinished_.finish(rename) != 0) fail("cannot be replaced");
  temporary_.clear();
  // The rename was the last step that may fail: nobody could take it back.
  if (syncFolder(folder_.c_str())) return true;
  const int code = errno;
  warnOfOutput(path_ + ": is written, but its folder cannot be flushed (" + reason(code) +
               "): a power loss soon may undo that");
  errno = code;
  return false;
}

bool writeFileAtomically(const fs::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.append(bytes);
  return file.commit();
}

void writeFileDurably(const fs::path& path, std::string_view bytes) {
  if (!writeFileAtomically(path, bytes))
    throw DiskError(path.string(), "its folder cannot be flushed to disk: " + reason(errno));
}

bool isTemporaryFor(std::string_view filename, std::string_view candidate) {
  const std::string start = "." + std::string(filename) + ".";
  if (!candidate.starts_with(start) || !candidate.ends_with(kTemporaryEnd)) return false;
  candidate.remove_prefix(start.size());
  if (candidate.size() < kTemporaryEnd.size()) return false;
  candidate.remove_suffix(kTemporaryEnd.size());
  return candidate.find_first_not_of("0123456789-") == std::string_view::npos;
}

void makeFolder(const fs::path& folder) {
  std::error_code code;
  refuseForeignLink(folder, folder);
  if (fs::is_directory(folder, code)) return;
  const fs::path parent = folder.parent_path();
  // "a/b/" has the parent "a/b".
  if (!folder.has_filename()) return makeFolder(parent);
  if (!parent.empty()) makeFolder(parent);
  if (::mkdir(folder.c_str(), 0777) != 0) {
    const int cause = errno; // is_directory() may change errno
    if (!fs::is_directory(folder, code))
      throw DiskError(folder.string(),
                      "cannot be made a folder: " +
                          (cause == EEXIST ? "a file stands there" : reason(cause)));
  }
  if (!syncFolder(parent.empty() ? "." : parent.c_str()))
    throw DiskError(folder.string(), "was made, but cannot be flushed: " + reason(errno));
}

} // namespace patina

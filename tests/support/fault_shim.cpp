// Preloaded into a program (LD_PRELOAD), it makes one call that changes the disk fail. Variables of
// the environment: PATINA_FAULT is enospc, eio, eintr, estale, enolck, short (half is written),
// kill, or full (enospc from then on). PATINA_FAULT_AT is the number of the failing call from 1;
// absent: none. PATINA_FAULT_UNDER is an absolute folder; calls on files elsewhere do not count.
// PATINA_FAULT_MARK is a file that is made when the fault happens. PATINA_NO_FLUSH turns flushing
// off: the program may die, but not the machine. PATINA_FAULT_READS includes reads, and
// PATINA_FAULT_WIDER opening to write, locking and removing. PATINA_NO_LOCKS refuses each flock, as
// a file system without locks does. PATINA_FAULT_EARLY interrupts (Ctrl-C) before main().
#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <utility>

namespace {

enum class Call { create, write, flush, rename, cut, read, other };

// Reads the setting on each call: the library may be called before any constructor of its own.
const char* setting(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

bool isUnder(const char* path) {
  const char* folder = setting("PATINA_FAULT_UNDER");
  return *folder && std::strncmp(path, folder, std::strlen(folder)) == 0;
}

bool isUnder(int fd) {
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(fd);
  const ssize_t size = readlink(link.c_str(), path, sizeof path - 1);
  if (size < 0) return false;
  path[size] = 0;
  return isUnder(path);
}

void mark() {
  const long fd = syscall(SYS_openat, AT_FDCWD, setting("PATINA_FAULT_MARK"),
                          O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (fd >= 0) syscall(SYS_close, fd);
}

[[gnu::constructor]] void interruptEarly() {
  if (*setting("PATINA_FAULT_EARLY")) syscall(SYS_kill, getpid(), 2);
}

enum class Verdict { pass, fail, half };

Verdict judge(Call call) {
  static int calls = 0;
  static bool full = false;
  const std::string fault = setting("PATINA_FAULT");
  const bool takes_room = call == Call::create || call == Call::write || call == Call::flush;
  if (full && takes_room) {
    errno = ENOSPC;
    return Verdict::fail;
  }
  const int at = std::atoi(setting("PATINA_FAULT_AT"));
  if (fault == "short" && call != Call::write) return Verdict::pass;
  if (fault == "full" && !takes_room) return Verdict::pass;
  if (at == 0 || ++calls != at) return Verdict::pass;
  mark();
  if (fault == "kill") syscall(SYS_kill, getpid(), 9);
  if (fault == "short") return Verdict::half;
  full = fault == "full";
  errno = ENOSPC;
  constexpr std::pair<const char*, int> kCodes[] = {
      {"eio", EIO}, {"eintr", EINTR}, {"estale", ESTALE}, {"enolck", ENOLCK}};
  for (const auto& [name, code] : kCodes)
    if (fault == name) errno = code;
  return Verdict::fail;
}

template <typename File> bool refuses(File file) {
  return *setting("PATINA_FAULT_WIDER") && isUnder(file) && judge(Call::other) == Verdict::fail;
}

template <typename Function> Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

int flush(const char* name, int fd) {
  if (isUnder(fd) && judge(Call::flush) == Verdict::fail) return -1;
  return *setting("PATINA_NO_FLUSH") ? 0 : next<int (*)(int)>(name)(fd);
}

size_t part(Verdict verdict, size_t size) {
  return verdict == Verdict::half && size > 1 ? size / 2 : size;
}

} // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if (flags & O_CREAT) {
    va_list rest;
    va_start(rest, flags);
    mode = va_arg(rest, mode_t);
    va_end(rest);
    if (isUnder(path) && judge(Call::create) == Verdict::fail) return -1;
  } else if ((flags & O_ACCMODE) != O_RDONLY && refuses(path)) {
    return -1;
  }
  return next<int (*)(const char*, int, ...)>("open")(path, flags, mode);
}

int mkdir(const char* path, mode_t mode) noexcept {
  if (isUnder(path) && judge(Call::create) == Verdict::fail) return -1;
  return next<int (*)(const char*, mode_t)>("mkdir")(path, mode);
}

ssize_t read(int fd, void* bytes, size_t size) {
  if (*setting("PATINA_FAULT_READS") && isUnder(fd) && judge(Call::read) == Verdict::fail)
    return -1;
  return next<ssize_t (*)(int, void*, size_t)>("read")(fd, bytes, size);
}

ssize_t write(int fd, const void* bytes, size_t size) {
  const Verdict verdict = isUnder(fd) ? judge(Call::write) : Verdict::pass;
  if (verdict == Verdict::fail) return -1;
  return next<ssize_t (*)(int, const void*, size_t)>("write")(fd, bytes, part(verdict, size));
}

ssize_t pwrite(int fd, const void* bytes, size_t size, off_t at) {
  const Verdict verdict = isUnder(fd) ? judge(Call::write) : Verdict::pass;
  if (verdict == Verdict::fail) return -1;
  return next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite")(fd, bytes,
                                                                      part(verdict, size), at);
}

int fsync(int fd) {
  return flush("fsync", fd);
}

int fdatasync(int fd) {
  return flush("fdatasync", fd);
}

int rename(const char* from, const char* to) noexcept {
  if (isUnder(to) && judge(Call::rename) == Verdict::fail) return -1;
  return next<int (*)(const char*, const char*)>("rename")(from, to);
}

int ftruncate(int fd, off_t size) noexcept {
  if (isUnder(fd) && judge(Call::cut) == Verdict::fail) return -1;
  return next<int (*)(int, off_t)>("ftruncate")(fd, size);
}

int flock(int fd, int operation) noexcept {
  if (*setting("PATINA_NO_LOCKS")) {
    errno = ENOLCK;
    return -1;
  }
  return refuses(fd) ? -1 : next<int (*)(int, int)>("flock")(fd, operation);
}

int unlink(const char* path) noexcept {
  return refuses(path) ? -1 : next<int (*)(const char*)>("unlink")(path);
}

int remove(const char* path) noexcept {
  return refuses(path) ? -1 : next<int (*)(const char*)>("remove")(path);
}
}

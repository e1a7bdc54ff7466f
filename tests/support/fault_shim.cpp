// Preloaded into a program (LD_PRELOAD), it makes one call that changes the disk fail. In the
// environment:
//   PATINA_FAULT        enospc, eio, eintr, short (half is written), kill, full (enospc from then
//   on) PATINA_FAULT_AT     which call, counted from 1; absent: none PATINA_FAULT_UNDER  absolute
//   folder; calls on files elsewhere do not count PATINA_FAULT_MARK   file that is made when the
//   fault happens PATINA_NO_FLUSH     flushing does nothing: a program may die here, but not the
//   machine
//   PATINA_FAULT_READS  reads count and fail, too
//   PATINA_FAULT_EARLY  an interrupt (Ctrl-C) before main()
#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

enum class Call { create, write, flush, rename, cut, read };

// Read anew each time: the library may be called before any constructor of its own has run.
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
  errno = fault == "eio" ? EIO : fault == "eintr" ? EINTR : ENOSPC;
  return Verdict::fail;
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
}

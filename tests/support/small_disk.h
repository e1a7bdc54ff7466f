// A disk that is full for this program, as long as the value lives.
#pragma once

#include <csignal>
#include <cstdint>

#include <sys/resource.h>

namespace patina::test {

// No file can be written beyond `bytes`; sockets and pipes are not concerned.
class SmallDisk {
 public:
  explicit SmallDisk(std::uintmax_t bytes) : former_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &limit_);
    rlimit small = limit_;
    small.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &limit_);
    std::signal(SIGXFSZ, former_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit limit_{};
  void (*former_)(int);
};

} // namespace patina::test

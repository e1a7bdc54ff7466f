// Preloaded into a program (LD_PRELOAD), it shows it the emulated bus in the folder that
// PATINA_USBFS names (tests/support/emulated_plug.h) in place of the kernel's: the files that
// libusb opens under /sys/bus/usb and /dev/bus/usb, its ioctls on a node, its waiting;
// udev_shim.cpp replaces libudev. libusb itself is the system's. A file `deaf` in the folder makes
// its waiting fail.
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <map>
#include <memory>
#include <mutex>
#include <poll.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/vfs.h>
#include <unistd.h>
#include <vector>

#include "support/usbfs_wire.h"

using patina::UsbfsMessage;

namespace {

template <typename Function> Function next(Function, const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

std::string folder() {
  const char* value = std::getenv(patina::kUsbfsFolder);
  return value ? value : "";
}

// Returns the real path.
std::string moved(const char* path) {
  if (!path) return {};
  for (const char* bus : {"/sys/bus/usb", "/dev/bus/usb"})
    if (std::strncmp(path, bus, std::strlen(bus)) == 0) return folder() + path;
  return path;
}

bool isNode(const char* path) {
  return path && std::strncmp(path, "/dev/bus/usb/", 13) == 0 && std::strlen(path) == 20;
}

// A node that is open.
struct Node {
  explicit Node(int socket) : fd(socket) {}
  // Takes one received message; returns false if there is none.
  bool pull() {
    Done next_done;
    iovec parts[]{{&next_done.head, sizeof next_done.head}, {data, sizeof data}};
    msghdr message{};
    message.msg_iov = parts;
    message.msg_iovlen = 2;
    const ssize_t got = recvmsg(fd, &message, MSG_DONTWAIT);
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) gone = true;
    if (got < static_cast<ssize_t>(sizeof next_done.head)) return false;
    if (next_done.head.kind == UsbfsMessage::reply)
      replied = next_done.head.status;
    else {
      next_done.data.assign(data, data + (got - static_cast<ssize_t>(sizeof next_done.head)));
      done.push_back(std::move(next_done));
    }
    return true;
  }
  bool tell(const UsbfsMessage& head, const void* bytes = nullptr, std::size_t size = 0) {
    iovec parts[]{{const_cast<UsbfsMessage*>(&head), sizeof head},
                  {const_cast<void*>(bytes), size}};
    msghdr message{};
    message.msg_iov = parts;
    message.msg_iovlen = size > 0 ? 2 : 1;
    return sendmsg(fd, &message, MSG_NOSIGNAL) >= 0;
  }
  // Sends a request and waits for the reply.
  int ask(UsbfsMessage::Kind kind, unsigned what) {
    replied = 1;
    if (!tell({.kind = kind, .endpoint = static_cast<std::uint8_t>(what)})) return -ENODEV;
    while (replied == 1 && !gone)
      if (!pull()) {
        pollfd one{fd, POLLIN, 0};
        next(&::poll, "poll")(&one, 1, 100);
      }
    return replied == 1 ? -ENODEV : replied;
  }

  struct Done {
    UsbfsMessage head;
    std::vector<char> data;
  };
  std::mutex lock;
  int fd;
  bool gone = false;
  int replied = 0;
  std::uint32_t last = 0;
  std::map<std::uint32_t, usbdevfs_urb*> sent;
  std::deque<Done> done;
  char data[patina::kMaxUrbBytes];
};

struct Nodes {
  std::mutex lock;
  std::map<int, std::shared_ptr<Node>> open;
};
Nodes& nodes() {
  static Nodes* const kNodes = new Nodes; // it outlives threads that end late
  return *kNodes;
}
std::shared_ptr<Node> nodeOf(int fd) {
  const std::lock_guard lock(nodes().lock);
  const auto found = nodes().open.find(fd);
  return found == nodes().open.end() ? nullptr : found->second;
}

int openNode(const char* path) {
  sockaddr_un place{};
  place.sun_family = AF_UNIX;
  const std::string at = moved(path);
  if (at.size() >= sizeof place.sun_path) return errno = ENAMETOOLONG, -1;
  std::memcpy(place.sun_path, at.data(), at.size());
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  UsbfsMessage hello{.status = -ENOENT};
  if (fd < 0) return -1;
  if (connect(fd, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0) {
    if (recv(fd, &hello, sizeof hello, 0) < static_cast<ssize_t>(sizeof hello))
      hello.status = -ENODEV;
  }
  if (hello.status != 0) {
    ::close(fd);
    return errno = -hello.status, -1;
  }
  const std::lock_guard lock(nodes().lock);
  nodes().open[fd] = std::make_shared<Node>(fd);
  return fd;
}

int submit(Node& node, usbdevfs_urb* urb) {
  const auto size = static_cast<std::size_t>(urb->buffer_length);
  if (size > patina::kMaxUrbBytes) return -EINVAL;
  UsbfsMessage head{.kind = UsbfsMessage::submit,
                    .id = ++node.last,
                    .type = urb->type,
                    .endpoint = urb->endpoint,
                    .bytes = static_cast<std::uint32_t>(size)};
  const bool out = urb->type == USBDEVFS_URB_TYPE_CONTROL || (urb->endpoint & 0x80U) == 0;
  node.sent[head.id] = urb;
  if (!node.gone && node.tell(head, urb->buffer, out ? size : 0)) return 0;
  node.sent.erase(head.id);
  return -ENODEV;
}

int reap(Node& node, usbdevfs_urb** to) {
  while (node.pull()) {
  }
  while (!node.done.empty()) {
    const Node::Done done = std::move(node.done.front());
    node.done.pop_front();
    const auto found = node.sent.find(done.head.id);
    if (found == node.sent.end()) continue;
    usbdevfs_urb* urb = *to = found->second;
    node.sent.erase(found);
    urb->status = done.head.status;
    urb->actual_length = static_cast<int>(done.head.bytes);
    char* room = static_cast<char*>(urb->buffer) +
                 (urb->type == USBDEVFS_URB_TYPE_CONTROL ? patina::kUsbfsSetup : 0);
    if (!done.data.empty()) std::memcpy(room, done.data.data(), done.data.size());
    return 0;
  }
  if (!node.gone) return -EAGAIN;
  if (node.sent.empty()) return -ENODEV;
  *to = node.sent.begin()->second; // the kernel, too, returns requests that will never complete
  (*to)->status = -ENODEV;
  (*to)->actual_length = 0;
  node.sent.erase(node.sent.begin());
  return 0;
}

int discard(Node& node, const usbdevfs_urb* urb) {
  for (const auto& [id, sent] : node.sent) {
    if (sent != urb) continue;
    return node.tell({.kind = UsbfsMessage::discard, .id = id}) ? 0 : -ENODEV;
  }
  return -EINVAL;
}

int nodeCall(Node& node, unsigned long request, void* argument) {
  const std::lock_guard lock(node.lock);
  const auto number = [&] { return *static_cast<unsigned*>(argument); };
  switch (request) {
  case USBDEVFS_GET_CAPABILITIES:
    *static_cast<std::uint32_t*>(argument) =
        USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION |
        USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
    return 0;
  case USBDEVFS_SUBMITURB:
    return submit(node, static_cast<usbdevfs_urb*>(argument));
  case USBDEVFS_REAPURBNDELAY:
    return reap(node, static_cast<usbdevfs_urb**>(argument));
  case USBDEVFS_DISCARDURB:
    return discard(node, static_cast<usbdevfs_urb*>(argument));
  case USBDEVFS_CLAIMINTERFACE:
  case USBDEVFS_DISCONNECT_CLAIM: // both begin with the interface
    return node.ask(UsbfsMessage::claim, number());
  case USBDEVFS_RELEASEINTERFACE:
    return node.ask(UsbfsMessage::release, number());
  case USBDEVFS_CLEAR_HALT:
    return node.ask(UsbfsMessage::clear_halt, number());
  case USBDEVFS_GETDRIVER:
    return -ENODATA;
  case USBDEVFS_IOCTL: // gives the device back to the kernel's driver
    return 0;
  case USBDEVFS_GET_SPEED:
    return 2;
  case USBDEVFS_SETINTERFACE:
  case USBDEVFS_SETCONFIGURATION:
  case USBDEVFS_RESET:
    return node.gone ? -ENODEV : 0;
  default:
    return -ENOTTY;
  }
}

int failing(int code) {
  if (code >= 0) return code;
  errno = -code;
  return -1;
}

} // namespace

// Files and nodes.

#define PATINA_MODE(flags)                                                                         \
  mode_t mode = 0;                                                                                 \
  if (((flags) & (O_CREAT | O_TMPFILE)) != 0) {                                                    \
    va_list list;                                                                                  \
    va_start(list, flags);                                                                         \
    mode = static_cast<mode_t>(va_arg(list, unsigned));                                            \
    va_end(list);                                                                                  \
  }

extern "C" {

int open(const char* path, int flags, ...) {
  PATINA_MODE(flags)
  if (isNode(path)) return openNode(path);
  return next(&::open, "open")(moved(path).c_str(), flags, mode);
}

int open64(const char* path, int flags, ...) {
  PATINA_MODE(flags)
  return open(path, flags, mode);
}

int __open_2(const char* path, int flags) {
  return open(path, flags);
}

int openat(int at, const char* path, int flags, ...) {
  PATINA_MODE(flags)
  return next(&::openat, "openat")(at, moved(path).c_str(), flags, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  return next(&::fopen64, "fopen64")(moved(path).c_str(), mode);
}

DIR* opendir(const char* path) {
  return next(&::opendir, "opendir")(moved(path).c_str());
}

int statfs(const char* path, struct statfs* result) noexcept {
  constexpr long kSysfs = 0x62656572;
  const int code = next(static_cast<int (*)(const char*, struct statfs*)>(&::statfs),
                        "statfs")(moved(path).c_str(), result);
  if (code == 0 && std::strcmp(path, "/sys") == 0) result->f_type = kSysfs;
  return code;
}

int close(int fd) {
  {
    const std::lock_guard lock(nodes().lock);
    nodes().open.erase(fd);
  }
  return next(&::close, "close")(fd);
}

int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list list;
  va_start(list, request);
  void* argument = va_arg(list, void*);
  va_end(list);
  if (const auto node = nodeOf(fd)) return failing(nodeCall(*node, request, argument));
  return next(static_cast<int (*)(int, unsigned long, ...)>(&::ioctl), "ioctl")(fd, request,
                                                                                argument);
}

// The kernel makes a node writable when an URB is done: here that is when there is something to
// read.
int poll(pollfd* fds, nfds_t count, int timeout) {
  std::vector<pollfd> asked(fds, fds + count);
  std::vector<bool> ours(count);
  bool any = false, ready = false;
  for (nfds_t i = 0; i < count; ++i)
    if (const auto node = nodeOf(fds[i].fd)) {
      const std::lock_guard lock(node->lock);
      any = ours[i] = true;
      asked[i].events = POLLIN;
      ready = ready || !node->done.empty();
    }
  if (any && access((folder() + "/deaf").c_str(), F_OK) == 0) return errno = EIO, -1;
  int code = next(&::poll, "poll")(asked.data(), count, ready ? 0 : timeout);
  if (code < 0) return code;
  code = 0;
  for (nfds_t i = 0; i < count; ++i) {
    fds[i].revents = asked[i].revents;
    if (ours[i]) {
      const auto node = nodeOf(fds[i].fd);
      bool has = (asked[i].revents & POLLIN) != 0;
      if (node) {
        const std::lock_guard lock(node->lock);
        has = has || !node->done.empty();
      }
      const bool lost = (asked[i].revents & (POLLHUP | POLLERR)) != 0;
      fds[i].revents = static_cast<short>((has ? POLLOUT : 0) | (lost ? POLLERR | POLLHUP : 0));
    }
    code += fds[i].revents != 0;
  }
  return code;
}
} // extern "C"

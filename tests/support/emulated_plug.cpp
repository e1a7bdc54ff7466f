#include "support/emulated_plug.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <thread>
#include <unistd.h>

#include "core/descriptor.h"
#include "core/error.h"
#include "support/usbfs_wire.h"
#include "usb/usb_bus.h"

namespace patina {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kIsochronous = 0, kControl = 2;

void put16(Bytes& bytes, int value) {
  bytes.push_back(static_cast<std::uint8_t>(value & 0xff));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8 & 0xff));
}

// Descriptors of the device and its configuration (USB 2.0, 9.6).
Bytes descriptorsOf(const EmulatedUsb& device) {
  Bytes bytes{18, 1, 0x00, 0x02, 0, 0, 0, 64};
  put16(bytes, device.vendor);
  put16(bytes, device.product);
  put16(bytes, device.release);
  bytes.insert(bytes.end(), {1, 2, 3, 1});
  const int whole = 9 + 9 + 7 * static_cast<int>(device.endpoints.size());
  bytes.insert(bytes.end(), {9, 2});
  put16(bytes, whole);
  bytes.insert(bytes.end(), {1, 1, 0, 0x80, 50});
  bytes.insert(bytes.end(), {9, 4, 0, 0, static_cast<std::uint8_t>(device.endpoints.size()),
                             static_cast<std::uint8_t>(device.interface_class), 0, 0, 0});
  for (const EmulatedUsb::Endpoint& endpoint : device.endpoints)
    bytes.insert(bytes.end(), {7, 5, endpoint.address,
                               static_cast<std::uint8_t>(endpoint.interrupt ? 3 : 2), 64, 0, 1});
  return bytes;
}

Bytes stringOf(const std::string& text) {
  Bytes bytes{static_cast<std::uint8_t>(2 + 2 * text.size()), 3};
  for (const char c : text) put16(bytes, static_cast<unsigned char>(c));
  return bytes;
}

// Answers the standard requests; absent for requests that the device itself must answer.
std::optional<Bytes> standardAnswer(const EmulatedUsb& device, const UsbRequest& request) {
  if (request.request_type == 0x80 && request.request == 0) return Bytes{1, 0};
  if (request.request_type != 0x80 || request.request != 6) return std::nullopt;
  const Bytes all = descriptorsOf(device);
  switch (request.value >> 8) {
  case 1:
    return Bytes(all.begin(), all.begin() + 18);
  case 2:
    return Bytes(all.begin() + 18, all.end());
  case 3:
    switch (request.value & 0xff) {
    case 0:
      return Bytes{4, 3, 0x09, 0x04};
    case 1:
      return stringOf(device.maker);
    case 2:
      return stringOf(device.name);
    case 3:
      return stringOf(device.serial);
    default:
      return std::nullopt;
    }
  default:
    return std::nullopt;
  }
}

int errorOf(UsbResult result) {
  switch (result) {
  case UsbResult::ok:
    return 0;
  case UsbResult::stall:
    return -EPIPE;
  case UsbResult::gone:
    return -ENODEV;
  default:
    return -EPROTO;
  }
}

void writeSmall(const fs::path& file, std::string_view text) {
  std::ofstream out(file, std::ios::binary);
  if (!out.write(text.data(), static_cast<std::streamsize>(text.size())).flush())
    throw FileError(file.string(), 0, "cannot be written");
}

} // namespace

struct EmulatedUsbDevice::Impl {
  struct Urb {
    UsbfsMessage head;
    std::array<std::byte, kMaxUrbBytes> data;
  };

  // A program that has opened the device.
  struct Session {
    explicit Session(int fd) : socket(fd) {}
    void send(const UsbfsMessage& head, const void* data = nullptr, std::size_t size = 0) const {
      iovec parts[]{{const_cast<UsbfsMessage*>(&head), sizeof head},
                    {const_cast<void*>(data), size}};
      msghdr message{};
      message.msg_iov = parts;
      message.msg_iovlen = size > 0 ? 2 : 1;
      ::sendmsg(socket.get(), &message, MSG_NOSIGNAL);
    }
    void endReads(const std::function<bool(const UsbfsMessage&)>& which) {
      std::erase_if(reads, [&](const UsbfsMessage& read) {
        if (!which(read)) return false;
        send({.kind = UsbfsMessage::done, .id = read.id, .status = -ENOENT});
        return true;
      });
    }
    Descriptor socket;
    std::unique_ptr<UsbTransport> transport; // while the program has claimed the interface
    std::vector<UsbfsMessage> reads;         // pending reads
    bool ended = false;
  };

  Impl(const fs::path& folder, const EmulatedUsb& device_in,
       std::function<std::unique_ptr<UsbTransport>()> open_in)
      : device(device_in), open(std::move(open_in)), listener(-1), wake_read(-1), wake_write(-1) {
    // Like the kernel, assigns a new address to each device and does not soon reuse one.
    const fs::path devices = folder / "sys/bus/usb/devices", nodes = folder / "dev/bus/usb/001";
    std::error_code failed;
    fs::create_directories(devices, failed);
    if (!failed) fs::create_directories(nodes, failed);
    if (failed) throw FileError(folder.string(), 0, "cannot have a bus: " + failed.message());
    static std::atomic<int> last{0};
    for (int tries = 0; address == 0 && tries < 126; ++tries) {
      const int next = 2 + last++ % 126;
      if (!fs::exists(devices / ("1-" + std::to_string(next)))) address = next;
    }
    if (address == 0) throw FileError(folder.string(), 0, "has 126 devices: a bus takes no more");
    const std::string name = "1-" + std::to_string(address);
    char number[8];
    std::snprintf(number, sizeof number, "%03d", address);
    socket_path = nodes / number;
    entry = devices / name;
    listen();
    // The folder appears complete, by a rename, because hot-plug watchers read it at once.
    const fs::path made = folder / ("new-" + name);
    fs::create_directories(made);
    const Bytes descriptors = descriptorsOf(device);
    for (const auto& [file, text] : {std::pair<const char*, std::string>{"busnum", "1\n"},
                                     {"devnum", std::to_string(address) + "\n"},
                                     {"speed", "12\n"},
                                     {"bConfigurationValue", "1\n"},
                                     {"manufacturer", device.maker + "\n"},
                                     {"product", device.name + "\n"},
                                     {"serial", device.serial + "\n"},
                                     {"descriptors", {descriptors.begin(), descriptors.end()}}})
      writeSmall(made / file, text);
    away = made;
    fs::rename(made, entry);
    thread = std::thread([this] { serve(); });
  }

  ~Impl() {
    std::error_code ignored;
    fs::rename(entry, away, ignored);
    fs::remove_all(away, ignored);
    fs::remove(socket_path, ignored);
    [[maybe_unused]] const ssize_t woken = ::write(wake_write.get(), "", 1);
    thread.join();
  }

  void listen() {
    int both[2];
    if (::pipe(both) != 0) throw FileError(socket_path.string(), 0, reason(errno));
    wake_read.reset(both[0]);
    wake_write.reset(both[1]);
    sockaddr_un place{};
    place.sun_family = AF_UNIX;
    const std::string path = socket_path.string();
    if (path.size() >= sizeof place.sun_path)
      throw FileError(path, 0, "is too long a name for a socket: take a shorter folder");
    std::memcpy(place.sun_path, path.data(), path.size());
    ::unlink(path.c_str());
    listener.reset(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
    if (listener.get() < 0 ||
        ::bind(listener.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0 ||
        ::listen(listener.get(), 16) != 0)
      throw FileError(path, 0, "cannot be listened at: " + reason(errno));
  }

  void serve() {
    std::vector<pollfd> polled;
    for (;;) {
      polled = {{wake_read.get(), POLLIN, 0}, {listener.get(), POLLIN, 0}};
      bool reading = false;
      for (const auto& session : sessions) {
        polled.push_back({session->socket.get(), POLLIN, 0});
        reading = reading || !session->reads.empty();
      }
      if (::poll(polled.data(), polled.size(), reading ? 0 : -1) < 0 && errno != EINTR) return;
      if (polled[0].revents != 0) return;
      for (std::size_t i = 2; i < polled.size(); ++i)
        if (polled[i].revents != 0) take(*sessions[i - 2]);
      if (polled[1].revents != 0) accept();
      std::erase_if(sessions, [](const auto& session) { return session->ended; });
      for (const auto& session : sessions) readFor(*session);
    }
  }

  void accept() {
    const int fd = ::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC);
    if (fd < 0) return;
    sessions.push_back(std::make_unique<Session>(fd));
    const bool refused = device.refusal == UsbAccessError::permission;
    sessions.back()->send({.kind = UsbfsMessage::hello, .status = refused ? -EACCES : 0});
    sessions.back()->ended = refused;
  }

  void take(Session& session) {
    Urb urb;
    iovec parts[]{{&urb.head, sizeof urb.head}, {urb.data.data(), urb.data.size()}};
    msghdr message{};
    message.msg_iov = parts;
    message.msg_iovlen = 2;
    const ssize_t got = ::recvmsg(session.socket.get(), &message, MSG_DONTWAIT);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (got < static_cast<ssize_t>(sizeof urb.head)) {
      session.ended = true;
      return;
    }
    const std::size_t size = static_cast<std::size_t>(got) - sizeof urb.head;
    UsbfsMessage answer{.kind = UsbfsMessage::reply, .id = urb.head.id};
    switch (urb.head.kind) {
    case UsbfsMessage::submit:
      return submit(session, urb, size);
    case UsbfsMessage::discard:
      return session.endReads([&](const UsbfsMessage& read) { return read.id == urb.head.id; });
    case UsbfsMessage::claim:
      answer.status = claim(session);
      break;
    case UsbfsMessage::release:
      session.endReads([](const UsbfsMessage&) { return true; });
      session.transport.reset();
      break;
    case UsbfsMessage::clear_halt:
      std::this_thread::sleep_for(std::chrono::duration<double>(device.halt_time));
      break;
    default:
      break;
    }
    session.send(answer);
  }

  int claim(Session& session) {
    const bool taken = std::ranges::any_of(
        sessions, [&](const auto& s) { return s.get() != &session && s->transport; });
    if (taken || device.refusal == UsbAccessError::held_by_driver) return -EBUSY;
    std::unique_ptr<UsbTransport> opened;
    try {
      opened = open();
    } catch (const DeviceError&) {
      return -ENODEV;
    }
    ++claims;
    if (opened->claim(0) != UsbResult::ok) return -EBUSY;
    session.transport = std::move(opened);
    return 0;
  }

  void submit(Session& session, const Urb& urb, std::size_t size) {
    UsbfsMessage done = urb.head;
    done.kind = UsbfsMessage::done;
    done.status = -EPROTO;
    const bool drops = device.refusal == UsbAccessError::other && session.transport;
    const std::size_t bytes = std::min<std::size_t>(urb.head.bytes, kMaxUrbBytes);
    done.bytes = 0;
    if (urb.head.type == kControl && size >= kUsbfsSetup && !drops)
      return control(session, urb, size);
    if (urb.head.type == kIsochronous || !session.transport || drops) return session.send(done);
    if ((urb.head.endpoint & 0x80U) != 0) {
      session.reads.push_back(urb.head);
      session.reads.back().bytes = static_cast<std::uint32_t>(bytes);
      return;
    }
    const UsbCount sent =
        session.transport->write(urb.head.endpoint, std::span(urb.data).first(size), kWait);
    done.status = errorOf(sent.result);
    done.bytes = static_cast<std::uint32_t>(sent.bytes);
    session.send(done);
  }

  void control(Session& session, const Urb& urb, std::size_t size) {
    const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(urb.data[i]); };
    const auto word = [&](std::size_t i) {
      return static_cast<std::uint16_t>(byte(i) | byte(i + 1) << 8);
    };
    const UsbRequest request{static_cast<std::uint8_t>(byte(0)), static_cast<std::uint8_t>(byte(1)),
                             word(2), word(4)};
    const std::size_t most = std::min<std::size_t>(word(6), kMaxUrbBytes - kUsbfsSetup);
    UsbfsMessage done{.kind = UsbfsMessage::done, .id = urb.head.id, .status = -EPIPE};
    std::array<std::byte, kMaxUrbBytes> answer{};
    if (const auto known = standardAnswer(device, request)) {
      done.status = 0;
      done.bytes = static_cast<std::uint32_t>(std::min(known->size(), most));
      std::memcpy(answer.data(), known->data(), done.bytes);
    } else if (session.transport) {
      const bool in = (request.request_type & 0x80U) != 0;
      const UsbCount count =
          in ? session.transport->controlIn(request, std::span(answer).first(most), kWait)
             : session.transport->controlOut(
                   request, std::span(urb.data).subspan(kUsbfsSetup, size - kUsbfsSetup), kWait);
      done.status = errorOf(count.result);
      done.bytes = static_cast<std::uint32_t>(count.bytes);
      return session.send(done, answer.data(), in ? count.bytes : 0);
    }
    session.send(done, answer.data(), done.bytes);
  }

  // Waits one millisecond for data.
  void readFor(Session& session) {
    if (session.reads.empty() || !session.transport) return;
    const UsbfsMessage read = session.reads.front();
    std::array<std::byte, kMaxUrbBytes> data;
    const UsbCount got =
        session.transport->read(read.endpoint, std::span(data).first(read.bytes), 1);
    if (got.result == UsbResult::timeout) { // lets the next endpoint read
      std::rotate(session.reads.begin(), session.reads.begin() + 1, session.reads.end());
      return;
    }
    session.reads.erase(session.reads.begin());
    UsbfsMessage done = read;
    done.kind = UsbfsMessage::done;
    done.status = errorOf(got.result);
    done.bytes = static_cast<std::uint32_t>(got.bytes);
    session.send(done, data.data(), got.bytes);
  }

  static constexpr unsigned kWait = 100; // [ms]
  EmulatedUsb device;
  std::function<std::unique_ptr<UsbTransport>()> open;
  int address = 0;
  fs::path socket_path, entry, away;
  Descriptor listener, wake_read, wake_write;
  std::vector<std::unique_ptr<Session>> sessions;
  std::atomic<std::size_t> claims{0};
  std::thread thread;
};

EmulatedUsbDevice::EmulatedUsbDevice(const fs::path& folder, const EmulatedUsb& device,
                                     std::function<std::unique_ptr<UsbTransport>()> open)
    : impl_(std::make_unique<Impl>(folder, device, std::move(open))) {}

EmulatedUsbDevice::~EmulatedUsbDevice() = default;
EmulatedUsbDevice::EmulatedUsbDevice(EmulatedUsbDevice&&) noexcept = default;

std::size_t EmulatedUsbDevice::claims() const noexcept {
  return impl_->claims;
}

const fs::path& EmulatedUsbDevice::node() const noexcept {
  return impl_->socket_path;
}

} // namespace patina

// The loaded library: lists and opens devices through libusb.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <future>
#include <memory>
#include <thread>

#include <libusb.h>
#include <sched.h>

#include "usb/usb_library.h"
#include "usb/usb_transport.h"

namespace patina {
namespace {

// One opened device through libusb, with its own context.
struct CloseContext {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
struct CloseHandle {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
using Context = std::unique_ptr<libusb_context, CloseContext>;
using Handle = std::unique_ptr<libusb_device_handle, CloseHandle>;

constexpr std::size_t kMaxBytes = 4096; // data bytes per transfer
// Extra time beyond libusb's own time-out.
constexpr std::chrono::milliseconds kGracePeriod{200};
constexpr std::chrono::microseconds kSlice{100'000};
constexpr std::chrono::milliseconds kPollInterval{1}; // used if libusb's event handling fails

struct FreeTransfer {
  void operator()(libusb_transfer* transfer) const { libusb_free_transfer(transfer); }
};
using Transfer = std::unique_ptr<libusb_transfer, FreeTransfer>;

UsbResult resultOf(int code) {
  switch (code) {
  case LIBUSB_SUCCESS:
    return UsbResult::ok;
  case LIBUSB_ERROR_TIMEOUT:
    return UsbResult::timeout;
  case LIBUSB_ERROR_PIPE:
    return UsbResult::stall;
  case LIBUSB_ERROR_NO_DEVICE:
    return UsbResult::gone;
  default:
    return UsbResult::failed;
  }
}

UsbResult resultOf(libusb_transfer_status status) {
  switch (status) {
  case LIBUSB_TRANSFER_COMPLETED:
    return UsbResult::ok;
  case LIBUSB_TRANSFER_TIMED_OUT:
    return UsbResult::timeout;
  case LIBUSB_TRANSFER_STALL:
    return UsbResult::stall;
  case LIBUSB_TRANSFER_NO_DEVICE:
    return UsbResult::gone;
  default:
    return UsbResult::failed;
  }
}

// Reuses one transfer and its buffer, so that a round trip allocates no memory of ours, and a
// transfer that never ends does not refer to a buffer of the caller.
class LibusbTransport final : public UsbTransport {
 public:
  LibusbTransport(Context context, Handle handle)
      : context_(std::move(context)), handle_(std::move(handle)),
        transfer_(libusb_alloc_transfer(0)) {
    libusb_set_auto_detach_kernel_driver(handle_.get(),
                                         1); // fails harmlessly without a driver
  }
  ~LibusbTransport() override {
    if (clearing_.valid()) clearing_.wait();
    if (claimed_ >= 0) libusb_release_interface(handle_.get(), claimed_);
    handle_.reset(); // before the transfer, which may still be in flight
  }
  bool sound() const { return transfer_ != nullptr; }

  UsbResult claim(int number) noexcept override {
    const int code = libusb_claim_interface(handle_.get(), number);
    if (code != LIBUSB_SUCCESS) return resultOf(code);
    claimed_ = number;
    readEndpointTypes();
    return UsbResult::ok;
  }

  UsbCount controlOut(const UsbRequest& request, std::span<const std::byte> data,
                      unsigned timeout_ms) noexcept override {
    if (data.size() > kMaxBytes) return {UsbResult::failed, 0};
    take(data, LIBUSB_CONTROL_SETUP_SIZE);
    return control(request, data.size(), timeout_ms);
  }

  UsbCount controlIn(const UsbRequest& request, std::span<std::byte> data,
                     unsigned timeout_ms) noexcept override {
    if (data.size() > kMaxBytes) return {UsbResult::failed, 0};
    return given(control(request, data.size(), timeout_ms), LIBUSB_CONTROL_SETUP_SIZE, data);
  }

  UsbCount write(std::uint8_t endpoint, std::span<const std::byte> data,
                 unsigned timeout_ms) noexcept override {
    if (data.size() > kMaxBytes) return {UsbResult::failed, 0};
    take(data, 0);
    return move(endpoint & 0x7fU, data.size(), timeout_ms);
  }

  UsbCount read(std::uint8_t endpoint, std::span<std::byte> data,
                unsigned timeout_ms) noexcept override {
    if (data.size() > kMaxBytes) return {UsbResult::failed, 0};
    return given(move(endpoint | 0x80U, data.size(), timeout_ms), 0, data);
  }

 private:
  static void LIBUSB_CALL done(libusb_transfer* transfer) {
    *static_cast<int*>(transfer->user_data) = 1;
  }

  void take(std::span<const std::byte> data, std::size_t at) noexcept {
    if (!data.empty() && !lost_) std::memcpy(buffer_.data() + at, data.data(), data.size());
  }

  UsbCount given(UsbCount count, std::size_t at, std::span<std::byte> data) const noexcept {
    count.bytes = std::min(count.bytes, data.size());
    if (count.bytes > 0) std::memcpy(data.data(), buffer_.data() + at, count.bytes);
    return count;
  }

  void readEndpointTypes() noexcept {
    libusb_config_descriptor* config = nullptr;
    if (libusb_get_active_config_descriptor(libusb_get_device(handle_.get()), &config) != 0) return;
    for (int i = 0; i < config->bNumInterfaces; ++i) {
      const libusb_interface& interface = config->interface[i];
      if (interface.num_altsetting < 1) continue;
      const libusb_interface_descriptor& setting = interface.altsetting[0];
      for (int e = 0; e < setting.bNumEndpoints; ++e) {
        const libusb_endpoint_descriptor& endpoint = setting.endpoint[e];
        if ((endpoint.bmAttributes & 3) == LIBUSB_TRANSFER_TYPE_INTERRUPT)
          interrupt_[endpoint.bEndpointAddress] = true;
      }
    }
    libusb_free_config_descriptor(config);
  }

  UsbCount control(const UsbRequest& request, std::size_t size, unsigned timeout_ms) noexcept {
    if (lost_ || gone_) return {UsbResult::gone, 0};
    if (!isHaltCleared(timeout_ms)) return {UsbResult::stall, 0};
    libusb_fill_control_setup(buffer_.data(), request.request_type, request.request, request.value,
                              request.index, static_cast<std::uint16_t>(size));
    libusb_fill_control_transfer(transfer_.get(), handle_.get(), buffer_.data(), &done, &completed_,
                                 std::max(timeout_ms, 1U));
    return finish();
  }

  UsbCount move(unsigned endpoint, std::size_t size, unsigned timeout_ms) noexcept {
    if (lost_ || gone_) return {UsbResult::gone, 0};
    if (!isHaltCleared(timeout_ms)) return {UsbResult::stall, 0};
    const auto address = static_cast<unsigned char>(endpoint);
    libusb_fill_bulk_transfer(transfer_.get(), handle_.get(), address, buffer_.data(),
                              static_cast<int>(size), &done, &completed_, std::max(timeout_ms, 1U));
    if (interrupt_[address]) transfer_->type = LIBUSB_TRANSFER_TYPE_INTERRUPT;
    return finish();
  }

  UsbCount finish() noexcept {
    using Clock = std::chrono::steady_clock;
    completed_ = 0;
    if (const int code = libusb_submit_transfer(transfer_.get()); code != LIBUSB_SUCCESS) {
      gone_ = code == LIBUSB_ERROR_NO_DEVICE;
      return {resultOf(code), 0};
    }
    const auto until = Clock::now() + std::chrono::milliseconds(transfer_->timeout) + kGracePeriod;
    while (completed_ == 0) {
      using std::chrono::microseconds;
      const auto left = std::chrono::duration_cast<microseconds>(until - Clock::now());
      timeval wait{0, std::clamp(left, microseconds(0), kSlice).count()};
      const int code = libusb_handle_events_timeout_completed(context_.get(), &wait, &completed_);
      if (completed_ != 0) break;
      if (code != LIBUSB_SUCCESS && code != LIBUSB_ERROR_INTERRUPTED)
        libusb_cancel_transfer(transfer_.get()), std::this_thread::sleep_for(kPollInterval);
      if (Clock::now() < until) continue;
      lost_ = true; // only closing the device ends this transfer
      return {UsbResult::gone, 0};
    }
    gone_ = transfer_->status == LIBUSB_TRANSFER_NO_DEVICE;
    const UsbResult result = resultOf(transfer_->status);
    if (result == UsbResult::stall && transfer_->type != LIBUSB_TRANSFER_TYPE_CONTROL)
      clearHalt(transfer_->endpoint);
    return {result, static_cast<std::size_t>(std::max(transfer_->actual_length, 0))};
  }

  // The kernel locks the device while it clears a halt, so other calls would block.
  bool isHaltCleared(unsigned timeout_ms) noexcept {
    if (!clearing_.valid()) return true;
    if (clearing_.wait_for(std::chrono::milliseconds(timeout_ms)) != std::future_status::ready)
      return false;
    clearing_.get();
    return true;
  }

  // Clears a halt in a separate thread: the kernel may take 5 s and accepts no time-out.
  void clearHalt(unsigned char endpoint) noexcept {
    try {
      clearing_ = std::async(std::launch::async, [handle = handle_.get(), endpoint] {
        libusb_clear_halt(handle, endpoint);
      });
    } catch (const std::exception&) {
      lost_ = true; // the endpoint stays halted; the device must be closed
    }
  }

  Context context_;
  Handle handle_;
  Transfer transfer_;
  std::array<unsigned char, LIBUSB_CONTROL_SETUP_SIZE + kMaxBytes> buffer_{};
  std::array<bool, 256> interrupt_{}; // index: endpoint address
  std::future<void> clearing_;        // running clear of a halted endpoint
  int completed_ = 0;
  int claimed_ = -1;
  bool gone_ = false;
  bool lost_ = false; // a transfer never ended, or an endpoint stays halted
};

// Returns nullptr if no memory is left for a transfer.
std::unique_ptr<UsbTransport> makeLibusbTransport(Context context, Handle handle) {
  auto transport = std::make_unique<LibusbTransport>(std::move(context), std::move(handle));
  if (!transport->sound()) return nullptr;
  return transport;
}

// Hot-plug notification through libusb.

class Watch {
 public:
  Watch(Context context, std::function<void()> changed)
      : changed_(std::move(changed)), context_(std::move(context)) {}
  ~Watch() {
    if (!thread_.joinable()) return;
    stopping_ = true;
    libusb_hotplug_deregister_callback(context_.get(), callback_);
    libusb_interrupt_event_handler(context_.get());
    thread_.join();
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  bool begin() {
    if (libusb_hotplug_register_callback(
            context_.get(), LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
            LIBUSB_HOTPLUG_NO_FLAGS, LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY,
            LIBUSB_HOTPLUG_MATCH_ANY, &onHotplug, this, &callback_) != LIBUSB_SUCCESS)
      return false;
    thread_ = std::thread([this] { run(); });
    return true;
  }

 private:
  static int LIBUSB_CALL onHotplug(libusb_context*, libusb_device*, libusb_hotplug_event,
                                   void* self) {
    static_cast<Watch*>(self)->changed_();
    return 0; // keep the callback registered
  }
  void run() {
    // The thread may have inherited a real-time policy, which it does not need.
    const sched_param ordinary{};
    sched_setscheduler(0, SCHED_OTHER, &ordinary);
    while (!stopping_) {
      timeval wait{10, 0};
      if (libusb_handle_events_timeout(context_.get(), &wait) != LIBUSB_SUCCESS)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }

  std::function<void()> changed_;
  Context context_;
  libusb_hotplug_callback_handle callback_ = 0;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

// Implements UsbLibrary::watch.
std::shared_ptr<void> watchLibusb(std::function<void()> changed) {
  libusb_context* raw = nullptr;
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0 || libusb_init(&raw) != LIBUSB_SUCCESS)
    return nullptr;
  const auto watch = std::make_shared<Watch>(Context(raw), std::move(changed));
  return watch->begin() ? watch : nullptr;
}

struct List {
  libusb_device** items = nullptr;
  ssize_t count = 0;
  ~List() {
    if (items) libusb_free_device_list(items, 1);
  }
};

Context openContext(std::string& cause) {
  libusb_context* raw = nullptr;
  const int code = libusb_init(&raw);
  if (code == LIBUSB_SUCCESS) return Context(raw);
  cause = std::string("the USB bus cannot be read (") + libusb_strerror(code) +
          "): is there a /dev/bus/usb? A container must be given it.";
  return nullptr;
}

bool fill(List& list, libusb_context* context, std::string& cause) {
  list.count = libusb_get_device_list(context, &list.items);
  if (list.count >= 0) return true;
  cause =
      std::string("the USB bus cannot be listed: ") + libusb_strerror(static_cast<int>(list.count));
  return false;
}

UsbAccessError refusalOf(int code) {
  switch (code) {
  case LIBUSB_ERROR_ACCESS:
    return UsbAccessError::permission;
  case LIBUSB_ERROR_BUSY:
    return UsbAccessError::held_by_driver;
  case LIBUSB_ERROR_NO_DEVICE:
    return UsbAccessError::gone;
  default:
    return UsbAccessError::other;
  }
}

std::string text(libusb_device_handle* handle, std::uint8_t index) {
  std::array<unsigned char, 256> buffer{};
  const int length = index == 0
                         ? 0
                         : libusb_get_string_descriptor_ascii(handle, index, buffer.data(),
                                                              static_cast<int>(buffer.size()));
  std::string out;
  // Replaces unprintable bytes, because the text is shown on a terminal.
  for (int i = 0; i < length; ++i) {
    const unsigned char c = buffer[static_cast<std::size_t>(i)];
    out += c < 0x20 || c > 0x7e ? '?' : static_cast<char>(c);
  }
  return out;
}

double megabitsOf(libusb_device* device) {
  switch (libusb_get_device_speed(device)) {
  case LIBUSB_SPEED_LOW:
    return 1.5;
  case LIBUSB_SPEED_FULL:
    return 12;
  case LIBUSB_SPEED_HIGH:
    return 480;
  case LIBUSB_SPEED_SUPER:
    return 5000;
  case LIBUSB_SPEED_SUPER_PLUS:
    return 10000;
  default:
    return 0;
  }
}

// Fills the fields that do not require opening the device.
UsbDescriptor numbered(libusb_device* device, const libusb_device_descriptor& descriptor) {
  UsbDescriptor out;
  out.vendor = descriptor.idVendor;
  out.product = descriptor.idProduct;
  out.bus = libusb_get_bus_number(device);
  out.address = libusb_get_device_address(device);
  out.megabits = megabitsOf(device);
  out.release = descriptor.bcdDevice;
  return out;
}

UsbDescriptor found(libusb_device* device, const libusb_device_descriptor& descriptor) {
  UsbDescriptor out = numbered(device, descriptor);
  libusb_device_handle* raw = nullptr;
  if (const int code = libusb_open(device, &raw); code != LIBUSB_SUCCESS) {
    out.refusal = refusalOf(code);
    return out;
  }
  const Handle handle(raw);
  out.openable = true;
  const std::string maker = text(raw, descriptor.iManufacturer);
  const std::string product = text(raw, descriptor.iProduct);
  out.name = maker.empty() || product.empty() ? maker + product : maker + " " + product;
  out.serial = text(raw, descriptor.iSerialNumber);
  return out;
}

std::vector<UsbDescriptor> listAll(std::string& cause) {
  std::vector<UsbDescriptor> devices;
  const Context context = openContext(cause);
  List list;
  if (!context || !fill(list, context.get(), cause)) return devices;
  for (ssize_t i = 0; i < list.count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(list.items[i], &descriptor) == 0)
      devices.push_back(found(list.items[i], descriptor));
  }
  return devices;
}

std::unique_ptr<UsbTransport> openFirst(const std::function<bool(const UsbDescriptor&)>& wanted,
                                        std::optional<UsbAccessError>& refusal,
                                        std::string& cause) {
  Context context = openContext(cause);
  if (!context) return nullptr;
  Handle handle;
  {
    List list;
    if (!fill(list, context.get(), cause)) return nullptr;
    for (ssize_t i = 0; i < list.count && !handle; ++i) {
      libusb_device_descriptor descriptor{};
      if (libusb_get_device_descriptor(list.items[i], &descriptor) != 0 ||
          !wanted(numbered(list.items[i], descriptor)))
        continue;
      libusb_device_handle* raw = nullptr;
      const int code = libusb_open(list.items[i], &raw);
      if (code == LIBUSB_SUCCESS)
        handle.reset(raw);
      else
        refusal = refusalOf(code);
    }
  }
  if (!handle) return nullptr;
  auto transport = makeLibusbTransport(std::move(context), std::move(handle));
  if (!transport) cause = "no memory for a USB transfer: close other programs";
  return transport;
}

} // namespace

} // namespace patina

extern "C" __attribute__((visibility("default"))) const patina::UsbLibrary* patinaUsbLibrary() {
  static const patina::UsbLibrary kLibrary{&patina::listAll, &patina::openFirst,
                                           &patina::watchLibusb};
  return &kLibrary;
}

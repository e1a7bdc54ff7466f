#include "usb/libusb/libusb_transport.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <future>
#include <thread>

namespace patina {
namespace {

constexpr std::size_t kMost = 4096;              // bytes of data of a transfer
constexpr std::chrono::milliseconds kGrace{200}; // for what libusb itself would end by its time
constexpr std::chrono::microseconds kSlice{100'000};
constexpr std::chrono::milliseconds kNap{1}; // where it cannot wait itself

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

// One transfer and its buffer are made once and used again, so that a round trip allocates nothing
// of ours, and what never ends leaves no buffer of the caller's to the bus.
class LibusbTransport final : public UsbTransport {
 public:
  LibusbTransport(Context context, Handle handle)
      : context_(std::move(context)), handle_(std::move(handle)),
        transfer_(libusb_alloc_transfer(0)) {
    libusb_set_auto_detach_kernel_driver(handle_.get(),
                                         1); // no driver to detach: an error, no harm
  }
  ~LibusbTransport() override {
    if (mending_.valid()) mending_.wait();
    if (claimed_ >= 0) libusb_release_interface(handle_.get(), claimed_);
    handle_.reset(); // before the transfer, which may be on its way still
  }
  bool sound() const { return transfer_ != nullptr; }

  UsbResult claim(int number) noexcept override {
    const int code = libusb_claim_interface(handle_.get(), number);
    if (code != LIBUSB_SUCCESS) return resultOf(code);
    claimed_ = number;
    learnEndpoints();
    return UsbResult::ok;
  }

  UsbCount controlOut(const UsbRequest& request, std::span<const std::byte> data,
                      unsigned timeout_ms) noexcept override {
    if (data.size() > kMost) return {UsbResult::failed, 0};
    take(data, LIBUSB_CONTROL_SETUP_SIZE);
    return control(request, data.size(), timeout_ms);
  }

  UsbCount controlIn(const UsbRequest& request, std::span<std::byte> data,
                     unsigned timeout_ms) noexcept override {
    if (data.size() > kMost) return {UsbResult::failed, 0};
    return given(control(request, data.size(), timeout_ms), LIBUSB_CONTROL_SETUP_SIZE, data);
  }

  UsbCount write(std::uint8_t endpoint, std::span<const std::byte> data,
                 unsigned timeout_ms) noexcept override {
    if (data.size() > kMost) return {UsbResult::failed, 0};
    take(data, 0);
    return move(endpoint & 0x7fU, data.size(), timeout_ms);
  }

  UsbCount read(std::uint8_t endpoint, std::span<std::byte> data,
                unsigned timeout_ms) noexcept override {
    if (data.size() > kMost) return {UsbResult::failed, 0};
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

  void learnEndpoints() noexcept {
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
    if (!mended(timeout_ms)) return {UsbResult::stall, 0};
    libusb_fill_control_setup(buffer_.data(), request.request_type, request.request, request.value,
                              request.index, static_cast<std::uint16_t>(size));
    libusb_fill_control_transfer(transfer_.get(), handle_.get(), buffer_.data(), &done, &completed_,
                                 std::max(timeout_ms, 1U));
    return finish();
  }

  UsbCount move(unsigned endpoint, std::size_t size, unsigned timeout_ms) noexcept {
    if (lost_ || gone_) return {UsbResult::gone, 0};
    if (!mended(timeout_ms)) return {UsbResult::stall, 0};
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
    const auto until = Clock::now() + std::chrono::milliseconds(transfer_->timeout) + kGrace;
    while (completed_ == 0) {
      using std::chrono::microseconds;
      const auto left = std::chrono::duration_cast<microseconds>(until - Clock::now());
      timeval wait{0, std::clamp(left, microseconds(0), kSlice).count()};
      const int code = libusb_handle_events_timeout_completed(context_.get(), &wait, &completed_);
      if (completed_ != 0) break;
      if (code != LIBUSB_SUCCESS && code != LIBUSB_ERROR_INTERRUPTED)
        libusb_cancel_transfer(transfer_.get()), std::this_thread::sleep_for(kNap);
      if (Clock::now() < until) continue;
      lost_ = true; // nobody tells any more what becomes of it: only closing ends that
      return {UsbResult::gone, 0};
    }
    gone_ = transfer_->status == LIBUSB_TRANSFER_NO_DEVICE;
    const UsbResult result = resultOf(transfer_->status);
    if (result == UsbResult::stall && transfer_->type != LIBUSB_TRANSFER_TYPE_CONTROL)
      mend(transfer_->endpoint);
    return {result, static_cast<std::size_t>(std::max(transfer_->actual_length, 0))};
  }

  // Meanwhile the kernel holds the whole device: whatever is asked of it would wait in there.
  bool mended(unsigned timeout_ms) noexcept {
    if (!mending_.valid()) return true;
    if (mending_.wait_for(std::chrono::milliseconds(timeout_ms)) != std::future_status::ready)
      return false;
    mending_.get();
    return true;
  }

  // The kernel may take 5 s to end a halt, and takes no other time: so in a thread of its own.
  void mend(unsigned char endpoint) noexcept {
    try {
      mending_ = std::async(std::launch::async, [handle = handle_.get(), endpoint] {
        libusb_clear_halt(handle, endpoint);
      });
    } catch (const std::exception&) {
      lost_ = true; // it stays halted: to be closed
    }
  }

  Context context_;
  Handle handle_;
  Transfer transfer_;
  std::array<unsigned char, LIBUSB_CONTROL_SETUP_SIZE + kMost> buffer_{};
  std::array<bool, 256> interrupt_{}; // by address of the endpoint
  std::future<void> mending_;         // an endpoint that had stalled
  int completed_ = 0;
  int claimed_ = -1;
  bool gone_ = false;
  bool lost_ = false; // a transfer that never ended, or an endpoint that stays halted
};

} // namespace

std::unique_ptr<UsbTransport> makeLibusbTransport(Context context, Handle handle) {
  auto transport = std::make_unique<LibusbTransport>(std::move(context), std::move(handle));
  if (!transport->sound()) return nullptr;
  return transport;
}

} // namespace patina

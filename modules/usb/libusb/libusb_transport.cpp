#include "usb/libusb/libusb_transport.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace patina {
namespace {

constexpr std::size_t kMostControl = 4096; // bytes of data of a control transfer

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

// Transfers are made once and used again, so that a round trip allocates nothing of ours.
class LibusbTransport final : public UsbTransport {
 public:
  LibusbTransport(Context context, Handle handle)
      : context_(std::move(context)), handle_(std::move(handle)),
        transfer_(libusb_alloc_transfer(0)) {
    libusb_set_auto_detach_kernel_driver(handle_.get(),
                                         1); // no driver to detach: an error, no harm
  }
  ~LibusbTransport() override {
    if (claimed_ >= 0) libusb_release_interface(handle_.get(), claimed_);
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
    if (data.size() > kMostControl) return {UsbResult::failed, 0};
    unsigned char* room = control_.data() + LIBUSB_CONTROL_SETUP_SIZE;
    if (!data.empty()) std::memcpy(room, data.data(), data.size());
    return control(request, data.size(), timeout_ms);
  }

  UsbCount controlIn(const UsbRequest& request, std::span<std::byte> data,
                     unsigned timeout_ms) noexcept override {
    if (data.size() > kMostControl) return {UsbResult::failed, 0};
    const UsbCount count = control(request, data.size(), timeout_ms);
    if (count.bytes > 0)
      std::memcpy(data.data(), control_.data() + LIBUSB_CONTROL_SETUP_SIZE, count.bytes);
    return count;
  }

  UsbCount write(std::uint8_t endpoint, std::span<const std::byte> data,
                 unsigned timeout_ms) noexcept override {
    // libusb never writes to what it sends.
    auto* bytes = reinterpret_cast<unsigned char*>(const_cast<std::byte*>(data.data()));
    return move(endpoint & 0x7fU, bytes, data.size(), timeout_ms);
  }

  UsbCount read(std::uint8_t endpoint, std::span<std::byte> data,
                unsigned timeout_ms) noexcept override {
    return move(endpoint | 0x80U, reinterpret_cast<unsigned char*>(data.data()), data.size(),
                timeout_ms);
  }

 private:
  static void LIBUSB_CALL done(libusb_transfer* transfer) {
    *static_cast<int*>(transfer->user_data) = 1;
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
    libusb_fill_control_setup(control_.data(), request.request_type, request.request, request.value,
                              request.index, static_cast<std::uint16_t>(size));
    libusb_fill_control_transfer(transfer_.get(), handle_.get(), control_.data(), &done,
                                 &completed_, std::max(timeout_ms, 1U));
    return finish();
  }

  UsbCount move(unsigned endpoint, unsigned char* data, std::size_t size,
                unsigned timeout_ms) noexcept {
    const auto address = static_cast<unsigned char>(endpoint);
    libusb_fill_bulk_transfer(transfer_.get(), handle_.get(), address, data, static_cast<int>(size),
                              &done, &completed_, std::max(timeout_ms, 1U));
    if (interrupt_[address]) transfer_->type = LIBUSB_TRANSFER_TYPE_INTERRUPT;
    return finish();
  }

  // A transfer never outlives the call: its buffer is the caller's.
  UsbCount finish() noexcept {
    if (gone_) return {UsbResult::gone, 0};
    completed_ = 0;
    if (const int code = libusb_submit_transfer(transfer_.get()); code != LIBUSB_SUCCESS) {
      gone_ = code == LIBUSB_ERROR_NO_DEVICE;
      return {resultOf(code), 0};
    }
    while (completed_ == 0) {
      const int code = libusb_handle_events_completed(context_.get(), &completed_);
      if (code != LIBUSB_SUCCESS && code != LIBUSB_ERROR_INTERRUPTED)
        libusb_cancel_transfer(transfer_.get());
    }
    gone_ = transfer_->status == LIBUSB_TRANSFER_NO_DEVICE;
    const UsbResult result = resultOf(transfer_->status);
    if (result == UsbResult::stall && transfer_->type != LIBUSB_TRANSFER_TYPE_CONTROL)
      libusb_clear_halt(handle_.get(), transfer_->endpoint);
    return {result, static_cast<std::size_t>(std::max(transfer_->actual_length, 0))};
  }

  Context context_;
  Handle handle_;
  Transfer transfer_;
  std::array<unsigned char, LIBUSB_CONTROL_SETUP_SIZE + kMostControl> control_{};
  std::array<bool, 256> interrupt_{}; // by address of the endpoint
  int completed_ = 0;
  int claimed_ = -1;
  bool gone_ = false;
};

} // namespace

std::unique_ptr<UsbTransport> makeLibusbTransport(Context context, Handle handle) {
  auto transport = std::make_unique<LibusbTransport>(std::move(context), std::move(handle));
  if (!transport->sound()) return nullptr;
  return transport;
}

} // namespace patina

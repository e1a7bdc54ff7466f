#include "usb/libusb/libusb_watch.h"

#include <atomic>
#include <sched.h>
#include <thread>

#include "usb/libusb/libusb_transport.h"

namespace patina {
namespace {

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
            LIBUSB_HOTPLUG_MATCH_ANY, &told, this, &callback_) != LIBUSB_SUCCESS)
      return false;
    thread_ = std::thread([this] { run(); });
    return true;
  }

 private:
  static int LIBUSB_CALL told(libusb_context*, libusb_device*, libusb_hotplug_event, void* self) {
    static_cast<Watch*>(self)->changed_();
    return 0; // and again
  }
  void run() {
    // It may have been begun by a thread of real time, which has no hurry here.
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

} // namespace

std::shared_ptr<void> watchLibusb(std::function<void()> changed) {
  libusb_context* raw = nullptr;
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0 || libusb_init(&raw) != LIBUSB_SUCCESS)
    return nullptr;
  const auto watch = std::make_shared<Watch>(Context(raw), std::move(changed));
  return watch->begin() ? watch : nullptr;
}

} // namespace patina

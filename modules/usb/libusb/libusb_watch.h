// Tells when something is plugged in or pulled out.
#pragma once

#include <functional>
#include <memory>

namespace patina {

// As UsbLibrary::watch.
std::shared_ptr<void> watchLibusb(std::function<void()> changed);

} // namespace patina

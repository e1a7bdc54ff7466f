// A device behind a plug-in, so that no fault of the plug-in's is the loop's.
#pragma once

#include <memory>
#include <string_view>

#include "haptics/devices/device.h"
#include "haptics/devices/plugin/patina_device.h"

namespace patina {

// What is older gets no force. [s]
inline constexpr double kPluginStale = 4e-3;

// The plug-in is opened, exchanged with and closed in a thread of its own, below the servo's
// priority; forces and states are handed over newest value first, without a lock. A call that does
// not return shows as age: from kPluginStale on the force that waits for it is zero, from
// kOldestAge on the device is silent. An answer that is none (an error, a number that is not
// finite, a place further than 10 m, no orientation) is left out, and the very next force is zero.
// Where the servo itself hands over nothing for 5 ms, the plug-in gets zero, too. After each of
// these the force comes back over a quarter of a second. None is above what the plug-in says it
// renders.
//
// `device` is "plugin:NAME" or "plugin:NAME:ARGUMENT". Throws Error, and DeviceError where it
// cannot be opened or does not answer within a second. Destroying it waits a second at most: a
// plug-in that hangs in a call is left to itself.
std::unique_ptr<Device> makePluginDevice(std::string_view device);
std::unique_ptr<Device> makePluginDevice(const patina_device& plugin, std::string name,
                                         std::string argument);

} // namespace patina

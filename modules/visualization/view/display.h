// Whether anything can be drawn here.
#pragma once

#include <chrono>

namespace patina {

// VTK of Debian 12 and 13 draws through X11 only and aborts without it, even off screen. Throws
// Error that says to use xvfb-run if DISPLAY is not set, or has not answered for `patience`: a
// server that starts, or starts afresh because its last client left, refuses connections meanwhile.
// Call before the first render window.
void requireDisplay(std::chrono::milliseconds patience = std::chrono::seconds(10));

} // namespace patina

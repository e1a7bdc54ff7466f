// Checks for a display.
#pragma once

#include <chrono>

namespace patina {

// VTK of Debian 12 and 13 draws through X11 only and aborts without it, even off screen. Throws an
// Error that names xvfb-run if DISPLAY is not set or does not answer within `timeout`: a server
// that starts or restarts refuses connections meanwhile. Call before the first render window.
void requireDisplay(std::chrono::milliseconds patience = std::chrono::seconds(10));

} // namespace patina

// Whether anything can be drawn here.
#pragma once

namespace patina {

// VTK of Debian 12 draws through X11 only and aborts without it, even off screen. Throws Error that
// says to use xvfb-run if DISPLAY is not set or does not answer. Call before the first render
// window.
void requireDisplay();

} // namespace patina

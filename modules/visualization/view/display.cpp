#include "visualization/view/display.h"

#include <cstdlib>
#include <string>
#include <thread>

#include <X11/Xlib.h>

#include "core/error.h"
#include "core/memory_left.h"

namespace patina {

void requireDisplay(std::chrono::milliseconds patience) {
  static const std::string remedy =
      "; run it in a desktop session, or under: xvfb-run -a -s \"-screen 0 1280x800x24\"";
  const char* value = std::getenv("DISPLAY");
  if (value == nullptr || *value == '\0')
    throw Error("pictures need an X display and DISPLAY is not set" + remedy);
  // Software OpenGL ends the program if it cannot allocate this much.
  if (memoryIsLimited()) requireMemory(400e6, "a picture");
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + patience;
  Display* connection = XOpenDisplay(value);
  while (connection == nullptr && Clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    connection = XOpenDisplay(value);
  }
  if (connection == nullptr)
    throw Error("the X display " + std::string(value) + " does not answer" + remedy);
  // The first connection stays open until the process ends: an X server without the option -noreset
  // restarts after its last client leaves, and VTK, which opens and closes its own connections,
  // aborts if it connects at that moment.
  static Display* const held = connection;
  if (held != connection) XCloseDisplay(connection);
}

} // namespace patina

#include "visualization/display.h"

#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "core/error.h"

namespace patina {
namespace {

bool answers(const std::string& socket_path, bool is_abstract) {
  const int handle = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (handle < 0) return false;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::size_t shift = is_abstract ? 1 : 0; // an abstract name begins with a zero byte
  std::memcpy(address.sun_path + shift, socket_path.data(), socket_path.size());
  const auto length =
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + shift + socket_path.size());
  const bool ok = connect(handle, reinterpret_cast<const sockaddr*>(&address), length) == 0;
  close(handle);
  return ok;
}

} // namespace

void requireDisplay() {
  static const std::string remedy =
      "; run it in a desktop session, or under: xvfb-run -a -s \"-screen 0 1280x800x24\"";
  const char* value = std::getenv("DISPLAY");
  if (value == nullptr || *value == '\0')
    throw Error("pictures need an X display and DISPLAY is not set" + remedy);
  const std::string display = value;
  // Only a local display (":99", "unix:0.0") can be asked cheaply; a remote one is taken at its
  // word.
  const auto colon = display.find(':');
  if (colon == std::string::npos || (colon != 0 && display.substr(0, colon) != "unix")) return;
  std::string number;
  for (std::size_t i = colon + 1; i < display.size() && std::isdigit(display[i]) != 0; ++i)
    number += display[i];
  const std::string socket_path = "/tmp/.X11-unix/X" + number;
  if (socket_path.size() > 100 || (!answers(socket_path, false) && !answers(socket_path, true)))
    throw Error("the X display " + display + " does not answer" + remedy);
}

} // namespace patina

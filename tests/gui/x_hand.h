// A hand on the X server's own pointer and keyboard: what a program gets from it has come through
// the window system.
#pragma once

#include <cstdint>

namespace patina::test {

class XHand {
 public:
  XHand();
  ~XHand();
  XHand(const XHand&) = delete;
  XHand& operator=(const XHand&) = delete;
  bool works() const { return connection_ != nullptr; }

  // In pixels of the screen. Each returns when the server has taken it.
  void moveTo(int x, int y);
  void button(int number, bool down); // 1 left, 2 middle, 3 right, 4 and 5 the wheel
  void key(std::uint32_t keysym, bool down);
  // Sends a window a message of the type kMark, which comes to it after all that the hand has done.
  void mark(std::uint32_t window, std::uint32_t number);
  static constexpr std::uint32_t kMark = 0x7fffff01; // no atom of a server's

 private:
  void fake(std::uint8_t type, std::uint8_t detail, int x, int y);

  void* connection_ = nullptr; // xcb's
};

// Starts a window manager on this display, once, if one is installed; true when it is there.
bool hasWindowManager();

} // namespace patina::test

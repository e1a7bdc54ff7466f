// A hand on the X server's own pointer and keyboard: a program gets its events through the window
// system.
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

  // Positions are pixels of the screen. Each call returns when the server has handled it.
  void moveTo(int x, int y);
  void button(int number, bool down); // 1 left, 2 middle, 3 right, 4 and 5 the wheel
  void key(std::uint32_t keysym, bool down);
  // Sends a window a message of the type kMark, which arrives after all earlier events of the hand.
  void mark(std::uint32_t window, std::uint32_t number);
  static constexpr std::uint32_t kMark = 0x7fffff01; // no server has this atom

 private:
  void fake(std::uint8_t type, std::uint8_t detail, int x, int y);

  void* connection_ = nullptr; // a connection of xcb
};

// Starts a window manager on this display once, if one is installed; returns whether it runs.
bool hasWindowManager();

} // namespace patina::test

// patina-udev: writes the udev rules of the haptic devices, as root. It is a program of its own so
// that root runs neither a plug-in nor a library of a device: it loads none and reads no variable.
#include <exception>
#include <iostream>

#include "usb/usb_bus.h"

int main(int count, char** words) {
  if (count > 2 || (count == 2 && words[1][0] == '-')) {
    std::cerr << "Usage: patina-udev [FOLDER], by default " << patina::kUdevFolder << '\n';
    return 2;
  }
  try {
    std::cout << patina::installUdevRules(count == 2 ? words[1] : patina::kUdevFolder).string()
              << '\n';
  } catch (const std::exception& error) {
    std::cerr << "patina-udev: " << error.what() << '\n';
    return 2;
  }
  return 0;
}

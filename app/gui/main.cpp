#include <cstdlib>
#include <iostream>

int main() {
  if (std::getenv("DISPLAY") == nullptr) {
    std::cerr << "patina-gui: no DISPLAY; run it in a desktop session or under xvfb-run -a\n";
    return 2;
  }
  return 0;
}

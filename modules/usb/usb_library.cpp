#include "usb/usb_library.h"

#include "core/loaded_library.h"

namespace patina {

const UsbLibrary* usbLibrary(std::string& cause) {
#ifdef PATINA_HAS_LIBUSB
  using Table = const UsbLibrary* (*)();
  static const auto table =
      reinterpret_cast<Table>(loadedSymbol("patina_libusb.so", "patinaUsbLibrary", cause));
  if (table) return table();
  cause =
      "the USB bus cannot be read: libusb 1.0 is not there (" + cause + "): install libusb-1.0-0";
#else
  cause = "the USB bus cannot be read: this build has no libusb, it was configured with "
          "PATINA_USB=OFF";
#endif
  return nullptr;
}

} // namespace patina

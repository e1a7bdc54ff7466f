// Known haptic devices by vendor and product number, and advice for access errors.
#include <array>
#include <cstdio>

#include "core/file.h"
#include "usb/usb_bus.h"

namespace patina {
namespace {

struct Known {
  std::uint16_t vendor;
  std::uint16_t product; // 0 = every product of this vendor is a haptic device
  std::string_view name;
};

// The Falcon reports its serial chip's vendor number, so the product must match too.
constexpr Known kKnown[] = {
    {0x0403, 0xcb48, "Novint Falcon"},
    {0x1451, 0, "Force Dimension"},
    {0x2988, 0, "3D Systems Touch"},
    {0x256f, 0, "3Dconnexion SpaceMouse"},
    {0x046d, 0xc603, "3Dconnexion SpaceMouse"}, // older models have Logitech's vendor number
    {0x046d, 0xc605, "3Dconnexion SpaceMouse"},
    {0x046d, 0xc606, "3Dconnexion SpaceMouse"},
    {0x046d, 0xc621, "3Dconnexion SpaceMouse"},
    {0x046d, 0xc623, "3Dconnexion SpaceMouse"},
    {0x046d, 0xc625, "3Dconnexion SpaceMouse"},
    {0x046d, 0xc626, "3Dconnexion SpaceMouse"},
    {0x046d, 0xc627, "3Dconnexion SpaceMouse"},
    {0x046d, 0xc628, "3Dconnexion SpaceMouse"},
    {0x046d, 0xc629, "3Dconnexion SpaceMouse"},
    {0x046d, 0xc62b, "3Dconnexion SpaceMouse"},
};

std::string hex4(std::uint16_t value) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "%04x", static_cast<unsigned>(value));
  return text.data();
}

} // namespace

std::string vendorProductText(std::uint16_t vendor, std::uint16_t product) {
  return hex4(vendor) + ":" + hex4(product);
}

std::string_view hapticName(std::uint16_t vendor, std::uint16_t product) {
  for (const Known& known : kKnown) {
    if (known.vendor == vendor && (known.product == 0 || known.product == product))
      return known.name;
  }
  return {};
}

std::string usbAdvice(UsbAccessError refusal, std::uint16_t vendor, std::uint16_t product) {
  switch (refusal) {
  case UsbAccessError::permission:
    return "no permission: run 'patina devices --install-udev' as root, which puts "
           "SUBSYSTEM==\"usb\", "
           "ATTR{idVendor}==\"" +
           hex4(vendor) + "\", ATTR{idProduct}==\"" + hex4(product) +
           "\", TAG+=\"uaccess\" and its like into /etc/udev/rules.d/, then 'udevadm control "
           "--reload', and plug the device in again";
  case UsbAccessError::held_by_driver:
    return "a driver or another program holds it: close that program, or unload the driver that "
           "'lsusb -t' names";
  case UsbAccessError::gone:
    return "it was unplugged while it was checked: plug it in again";
  case UsbAccessError::other:
    break;
  }
  return "it does not answer: plug it in again, without a hub, and look at 'dmesg'";
}

std::string udevRules() {
  std::string text =
      "# Gives the user at this machine access to haptic devices and probes that Patina supports.\n"
      "# 'patina devices --install-udev' writes this into /etc/udev/rules.d; then run\n"
      "# 'udevadm control --reload' and plug the device in again.\n"
      "ACTION==\"remove\", GOTO=\"patina_end\"\n";
  std::string_view last;
  for (const Known& known : kKnown) {
    if (known.name != last) text += "# " + std::string(known.name) + "\n";
    last = known.name;
    text += "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"" + hex4(known.vendor) + "\"";
    if (known.product != 0) text += ", ATTR{idProduct}==\"" + hex4(known.product) + "\"";
    text += ", TAG+=\"uaccess\"\n";
  }
  // ModemManager would send commands to an unknown serial line.
  const std::string probe =
      "==\"" + std::string(kProbeName) + "*\", TAG+=\"uaccess\", ENV{ID_MM_DEVICE_IGNORE}=\"1\"\n";
  return text + "# Probes: docs/usb_protocol.md\nSUBSYSTEM==\"usb\", ATTR{product}" + probe +
         "SUBSYSTEM==\"tty\", ATTRS{product}" + probe + "LABEL=\"patina_end\"\n";
}

std::filesystem::path installUdevRules(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "70-patina.rules";
  const auto heading = [](const std::string& text) { return text.substr(0, text.find('\n')); };
  if (pathExists(file) && std::filesystem::is_regular_file(file) &&
      std::filesystem::file_size(file) > 0 && heading(readFile(file)) != heading(udevRules()))
    throw FileError(file.string(), 0, "holds other rules than Patina's; remove it first");
  try {
    writeFileAtomically(file, udevRules());
  } catch (const FileError& error) {
    throw Error(std::string(error.what()) +
                "; run this as root (sudo), or name a folder of your own");
  }
  return file;
}

} // namespace patina

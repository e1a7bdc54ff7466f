// The part of libudev that libusb calls: for usbfs_shim.cpp, which moves the paths.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <dirent.h>
#include <string>
#include <sys/inotify.h>
#include <unistd.h>

#include "support/usbfs_wire.h"

extern "C" {

struct udev {};
struct udev_list_entry {
  std::string path;
  udev_list_entry* next = nullptr;
};
struct udev_enumerate {
  std::deque<udev_list_entry> entries;
};
struct udev_device {
  std::string name, node;
  const char* action = nullptr;
};
struct udev_monitor {
  int fd = -1;
};

static constexpr const char* kDevices = "/sys/bus/usb/devices/";

static udev_device* deviceOf(const std::string& name, const char* action) {
  char node[32];
  std::snprintf(node, sizeof node, "/dev/bus/usb/001/%03d", std::atoi(name.c_str() + 2));
  return new udev_device{name, node, action};
}

udev* udev_new() {
  return new udev;
}
udev* udev_unref(udev* it) {
  delete it;
  return nullptr;
}
udev_enumerate* udev_enumerate_new(udev*) {
  return new udev_enumerate;
}
int udev_enumerate_add_match_subsystem(udev_enumerate*, const char*) {
  return 0;
}
int udev_enumerate_add_match_property(udev_enumerate*, const char*, const char*) {
  return 0;
}
int udev_enumerate_scan_devices(udev_enumerate* it) {
  DIR* devices = opendir(kDevices);
  if (!devices) return 0;
  while (const dirent* entry = readdir(devices))
    if (entry->d_name[0] != '.') it->entries.push_back({std::string(kDevices) + entry->d_name});
  closedir(devices);
  for (std::size_t i = 1; i < it->entries.size(); ++i) it->entries[i - 1].next = &it->entries[i];
  return 0;
}
udev_list_entry* udev_enumerate_get_list_entry(udev_enumerate* it) {
  return it->entries.empty() ? nullptr : &it->entries.front();
}
udev_enumerate* udev_enumerate_unref(udev_enumerate* it) {
  delete it;
  return nullptr;
}
udev_list_entry* udev_list_entry_get_next(udev_list_entry* it) {
  return it->next;
}
const char* udev_list_entry_get_name(udev_list_entry* it) {
  return it->path.c_str();
}
udev_device* udev_device_new_from_syspath(udev*, const char* path) {
  return deviceOf(path + std::strlen(kDevices), nullptr);
}
const char* udev_device_get_devnode(udev_device* it) {
  return it->node.c_str();
}
const char* udev_device_get_sysname(udev_device* it) {
  return it->name.c_str();
}
const char* udev_device_get_action(udev_device* it) {
  return it->action;
}
udev_device* udev_device_unref(udev_device* it) {
  delete it;
  return nullptr;
}
udev_monitor* udev_monitor_new_from_netlink(udev*, const char*) {
  auto* it = new udev_monitor{inotify_init1(IN_NONBLOCK | IN_CLOEXEC)};
  const char* folder = std::getenv(patina::kUsbfsFolder);
  const std::string devices = std::string(folder ? folder : "") + kDevices;
  inotify_add_watch(it->fd, devices.c_str(), IN_MOVED_TO | IN_MOVED_FROM);
  return it;
}
int udev_monitor_filter_add_match_subsystem_devtype(udev_monitor*, const char*, const char*) {
  return 0;
}
int udev_monitor_enable_receiving(udev_monitor*) {
  return 0;
}
int udev_monitor_get_fd(udev_monitor* it) {
  return it->fd;
}
udev_device* udev_monitor_receive_device(udev_monitor* it) {
  alignas(inotify_event) char room[sizeof(inotify_event) + 16]; // one event: "1-126" takes 16
  if (read(it->fd, room, sizeof room) < static_cast<ssize_t>(sizeof(inotify_event))) return nullptr;
  const auto* event = reinterpret_cast<const inotify_event*>(room);
  if (event->len == 0) return nullptr;
  return deviceOf(event->name, (event->mask & IN_MOVED_TO) != 0 ? "add" : "remove");
}
udev_monitor* udev_monitor_unref(udev_monitor* it) {
  close(it->fd);
  delete it;
  return nullptr;
}
} // extern "C"

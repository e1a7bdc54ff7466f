#include "haptics/plugin/plugin_library.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <map>

#include "core/error.h"
#include "core/loaded_library.h"
#include "core/ownership.h"
#include "haptics/plugin/plugin_abi.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "plugin:", kFile = "patina_device_", kEnd = ".so";

bool isName(std::string_view name) {
  return !name.empty() && name.size() <= 64 && std::ranges::all_of(name, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_';
  });
}

std::vector<fs::path> folders() {
  std::vector<fs::path> list;
  if (const char* given = std::getenv("PATINA_DEVICES")) {
    std::string_view rest = given;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(':'), rest.size());
      if (end > 0) list.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  std::ranges::copy(libraryFolders(), std::back_inserter(list));
  return list;
}

// File of each name; the first folder takes precedence.
std::map<std::string, fs::path> files() {
  std::map<std::string, fs::path> found;
  for (const fs::path& folder : folders()) {
    std::error_code code;
    for (fs::directory_iterator item(folder, code), end; !code && item != end;
         item.increment(code)) {
      const std::string file = item->path().filename();
      if (!file.starts_with(kFile) || !file.ends_with(kEnd)) continue;
      const std::string name = file.substr(kFile.size(), file.size() - kFile.size() - kEnd.size());
      if (isName(name)) found.try_emplace(name, item->path());
    }
  }
  return found;
}

// Returns printable text, with or without a terminating zero.
template <std::size_t room> std::string textOf(const char (&bytes)[room]) {
  std::string text;
  for (const char c : bytes) {
    if (c == 0) break;
    text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return text;
}

const patina_device& judged(const std::string& file, const patina_device* plugin) {
  if (!plugin)
    throw DeviceError(file + " has no device to offer: its patina_device_entry returns nothing");
  if (plugin->abi != PATINA_DEVICE_ABI || plugin->size != sizeof(patina_device) ||
      !plugin->describe || !plugin->open || !plugin->exchange || !plugin->close)
    throw DeviceError(file +
                      " is incomplete: its abi must be PATINA_DEVICE_ABI, its size "
                      "sizeof(patina_device), and describe, open, exchange and close must be "
                      "there");
  return *plugin;
}

} // namespace

bool isPlugin(std::string_view device) {
  return device.starts_with(kPrefix);
}

PluginName pluginName(std::string_view device) {
  const std::string_view given = device.substr(std::min(kPrefix.size(), device.size()));
  const std::size_t end = std::min(given.find(':'), given.size());
  PluginName out{std::string(given.substr(0, end)),
                 std::string(given.substr(std::min(end + 1, given.size())))};
  if (!isPlugin(device) || !isName(out.name))
    throw Error("device = " + std::string(device) +
                ": it must be plugin:NAME or plugin:NAME:ARGUMENT, the name of letters, digits, - "
                "and _");
  return out;
}

const patina_device& loadedPlugin(const std::string& name) {
  const auto known = files();
  const auto found = known.find(name);
  if (found == known.end()) {
    std::string places;
    for (const fs::path& folder : folders())
      places += (places.empty() ? "" : ", ") + folder.string();
    throw DeviceError("there is no plug-in " + name + ": put " + std::string(kFile) + name +
                      std::string(kEnd) + " into one of " + places +
                      ", or name its folder in PATINA_DEVICES");
  }
  std::string file;
  try {
    file = trustedFile(found->second).string();
    requirePluginAbi(file);
  } catch (const FileError& error) {
    throw DeviceError(error.what());
  }
  void* library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const char* cause = ::dlerror();
    throw DeviceError(file + " cannot be loaded: " + (cause ? cause : "unknown reason"));
  }
  using Entry = const patina_device* (*)();
  const auto entry = reinterpret_cast<Entry>(::dlsym(library, pluginEntryName().c_str()));
  if (!entry) throw DeviceError(file + " is no plug-in: it has no " + pluginEntryName());
  return judged(file, entry());
}

PluginFound described(const std::string& name, const patina_device& plugin) {
  patina_device_description given{};
  plugin.describe(&given);
  PluginFound found{name, textOf(given.name), textOf(given.note), {}, {}};
  if (found.caption.empty()) found.caption = name;
  found.limits.max_force = std::isfinite(given.max_force) ? std::max(given.max_force, 0.) : 0.;
  if (std::isfinite(given.max_stiffness) && given.max_stiffness > 0)
    found.limits.max_stiffness = given.max_stiffness;
  const Vec3 low(given.workspace_low), high(given.workspace_high);
  if (low.allFinite() && high.allFinite() && (low.array() < high.array()).all())
    found.limits.workspace = Box3(low, high);
  return found;
}

GuardSpec guardFor(const DeviceLimits& limits) {
  GuardSpec guard;
  guard.max_force = std::max(limits.max_force.value_or(0), 1e-9); // practically no force
  guard.workspace = limits.workspace;
  return guard;
}

std::vector<PluginFound> installedPlugins() {
  std::vector<PluginFound> list;
  for (const auto& [name, file] : files()) {
    try {
      list.push_back(described(name, loadedPlugin(name)));
    } catch (const DeviceError& error) {
      list.push_back({name, {}, {}, {}, error.what()});
    }
  }
  return list;
}

} // namespace patina

#include "haptics/plugin/plugin_abi.h"

#include <cstring>
#include <link.h>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "haptics/plugin/patina_device.h"

namespace patina {
namespace {

constexpr std::string_view kEntry = "patina_device_entry", kVersion = "_v";

// Copies the value at `offset`; nothing if it is not all in the file.
template <typename T> std::optional<T> valueAt(std::string_view bytes, std::uint64_t offset) {
  T value;
  if (offset > bytes.size() || bytes.size() - offset < sizeof value) return std::nullopt;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

std::string_view contentOf(std::string_view bytes, const ElfW(Shdr) & section) {
  if (section.sh_offset > bytes.size()) return {};
  return bytes.substr(section.sh_offset, section.sh_size);
}

// Calls `use` with the name of each function that the library exports. Returns false if the bytes
// are no shared library.
template <typename Use> bool forEachExport(std::string_view bytes, const Use& use) {
  constexpr unsigned char kClass = sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32;
  const auto header = valueAt<ElfW(Ehdr)>(bytes, 0);
  if (!header || std::memcmp(header->e_ident, ELFMAG, SELFMAG) != 0 ||
      header->e_ident[EI_CLASS] != kClass || header->e_type != ET_DYN ||
      header->e_shentsize != sizeof(ElfW(Shdr)))
    return false;
  const auto sectionAt = [&](std::uint64_t i) {
    return valueAt<ElfW(Shdr)>(bytes, header->e_shoff + i * sizeof(ElfW(Shdr)));
  };
  for (std::uint64_t i = 0; i < header->e_shnum; ++i) {
    const auto section = sectionAt(i);
    if (!section || section->sh_type != SHT_DYNSYM) continue;
    const auto text = sectionAt(section->sh_link);
    const std::string_view symbols = contentOf(bytes, *section);
    const std::string_view names = text ? contentOf(bytes, *text) : std::string_view();
    for (std::uint64_t at = 0; const auto symbol = valueAt<ElfW(Sym)>(symbols, at);
         at += sizeof(ElfW(Sym))) {
      if (symbol->st_shndx == SHN_UNDEF || symbol->st_name >= names.size()) continue;
      const std::string_view name = names.substr(symbol->st_name);
      use(name.substr(0, name.find('\0')));
    }
  }
  return true;
}

} // namespace

std::string pluginEntryName() {
  return std::string(kEntry) + std::string(kVersion) + std::to_string(PATINA_DEVICE_ABI);
}

void requirePluginAbi(const std::filesystem::path& file) {
  const std::string bytes = readFile(file), wanted = pluginEntryName(), path = file.string();
  bool is_sound = false, is_former = false;
  std::string others;
  const bool is_library = forEachExport(bytes, [&](std::string_view name) {
    if (!name.starts_with(kEntry)) return;
    is_sound = is_sound || name == wanted;
    name.remove_prefix(kEntry.size());
    is_former = is_former || name.empty();
    if (name.starts_with(kVersion) && parseNumber(name.substr(kVersion.size())))
      others += (others.empty() ? "" : " and ") + std::string(name.substr(kVersion.size()));
  });
  if (is_sound) return;
  if (!is_library) throw DeviceError(path + " cannot be loaded: it is no shared library");
  if (others.empty() && is_former) others.push_back('0');
  if (others.empty()) throw DeviceError(path + " is no plug-in: it has no " + wanted);
  throw DeviceError(
      path + " is made for version " + others + " of patina_device.h, this program reads version " +
      std::to_string(PATINA_DEVICE_ABI) + ": build it again with this version's header");
}

} // namespace patina

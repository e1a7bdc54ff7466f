// Version of patina_device.h that a plug-in was built with, read from its file.
#pragma once

#include <filesystem>
#include <string>

namespace patina {

// Name of the function that a plug-in of this version exports: patina_device_entry_vNUMBER.
std::string pluginEntryName();

// Looks for that name among the symbols of the file (ELF); no code of the file is run. Throws
// DeviceError if the file is no shared library, no plug-in, or one of other versions only.
void requirePluginAbi(const std::filesystem::path& file);

} // namespace patina

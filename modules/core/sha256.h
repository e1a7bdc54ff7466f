// SHA-256 of bytes, as 64 lower-case hexadecimal digits.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patina {

std::string sha256(std::string_view bytes);
// The same of a file's bytes, of which few are in memory at a time. Throws FileError.
std::string sha256OfFile(const std::filesystem::path& path);

} // namespace patina

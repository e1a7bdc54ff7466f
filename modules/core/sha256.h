// SHA-256 of bytes, as 64 lower-case hexadecimal digits.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patina {

std::string sha256(std::string_view bytes);
// Hashes a file piece by piece. Throws FileError.
std::string sha256OfFile(const std::filesystem::path& path);

// MD5 (RFC 1321) as 32 such digits, for formats that check a copy by it; it is no protection
// against a forger.
std::string md5(std::string_view bytes);

} // namespace patina

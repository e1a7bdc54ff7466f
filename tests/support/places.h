// Paths of the project's files and the programs under test.
#pragma once

#include <filesystem>
#include <string>

namespace patina::test {

std::filesystem::path sourceFolder();
std::filesystem::path programFolder();

// Path of a library in programFolder() for LD_PRELOAD, in which the loader takes a space or a colon
// for the end of a name: if the folder's path has one, a link elsewhere is used.
std::string preloadable(const std::string& library);

} // namespace patina::test

// Where the tests find the project's files and the programs under test.
#pragma once

#include <filesystem>
#include <string>

namespace patina::test {

std::filesystem::path sourceFolder();
std::filesystem::path programFolder();

// The path of a library in programFolder() for LD_PRELOAD, in which the loader takes a space or a
// colon for the end of a name: where the folder's path has one, it is that of a link elsewhere.
std::string preloadable(const std::string& library);

} // namespace patina::test

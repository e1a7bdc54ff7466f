// Where the tests find the project's files and the programs under test.
#pragma once

#include <filesystem>

namespace patina::test {

std::filesystem::path sourceFolder();
std::filesystem::path programFolder();

} // namespace patina::test

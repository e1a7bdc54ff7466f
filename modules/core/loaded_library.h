// Own libraries that are loaded on first use, because linking them would slow down every start.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace patina {

// Folders that are searched: the program's own and the installed libraries' folder.
std::vector<std::filesystem::path> libraryFolders();

// Address of `symbol` in the library `file` in these folders; nullptr and `cause` on failure.
void* loadedSymbol(const std::string& file, const char* symbol, std::string& cause);

} // namespace patina

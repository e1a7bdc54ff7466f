// Libraries of our own that are loaded when they are first asked for: linked, what they stand on
// would cost every start its time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace patina {

// Where they lie: beside the running program, and where libraries are installed.
std::vector<std::filesystem::path> libraryFolders();

// The address of `symbol` in the library `file`, which is looked for there. nullptr if there is
// none, and `cause` says why.
void* loadedSymbol(const std::string& file, const char* symbol, std::string& cause);

} // namespace patina

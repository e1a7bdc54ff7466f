// Libraries of our own that are loaded when they are first asked for: linked, what they stand on
// would cost every start its time.
#pragma once

#include <string>

namespace patina {

// The address of `symbol` in the library `file`, which is looked for beside the running program and
// where libraries are installed. nullptr if there is none, and `cause` says why.
void* loadedSymbol(const std::string& file, const char* symbol, std::string& cause);

} // namespace patina

// The library of pictures, loaded when it is first asked for. Internal to the workspace.
#pragma once

#include <string>

#include "workspace/images/images.h"

namespace patina {

// Throws FileError(name) saying what is missing and where it was looked for.
const ImageLibrary& imageLibrary(const std::string& name);

} // namespace patina

// The library of pictures, loaded when it is first asked for. For what reads and writes
// picture files.
#pragma once

#include <string>

#include "pictures/images/images.h"

namespace patina {

// Throws FileError(name) saying what is missing and where it was looked for.
const ImageLibrary& imageLibrary(const std::string& name);

// Throws FileError(name) unless every value is a finite number.
void requireFinite(const ImageRows& rows, const std::string& name);

} // namespace patina

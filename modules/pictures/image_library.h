// Picture library for reading and writing files, loaded at first use.
#pragma once

#include <string>

#include "pictures/images/images.h"

namespace patina {

// Throws FileError(name) naming the missing part and where it was searched.
const ImageLibrary& imageLibrary(const std::string& name);

// Throws FileError(name) unless every value is a finite number.
void requireFinite(const ImageRows& rows, const std::string& name);

} // namespace patina

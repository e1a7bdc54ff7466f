// Shared by pictures and plots; not for other modules.
#pragma once

#include <filesystem>

#include <vtkRenderWindow.h>

#include "visualization/view/picture.h"

namespace patina {

void checkPictureSize(const PictureSize& size); // throws Error
// What the window last drew. Throws Error if that is a single colour.
void writeWindowPng(vtkRenderWindow& window, const std::filesystem::path& path);

} // namespace patina

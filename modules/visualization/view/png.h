// Shared by pictures and plots; internal to the module.
#pragma once

#include <filesystem>

#include <vtkRenderWindow.h>

#include "visualization/view/picture.h"

namespace patina {

void checkPictureSize(const PictureSize& size); // throws Error
// Writes the window's last frame. Throws Error if it has a single colour.
void writeWindowPng(vtkRenderWindow& window, const std::filesystem::path& path);

} // namespace patina

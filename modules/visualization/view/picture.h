// Renders pictures without a window.
#pragma once

#include <filesystem>

#include "visualization/view/scan_picture.h"
#include "visualization/view/scene_view.h"

namespace patina {

struct PictureSize {
  int width = 1280, height = 960; // pixels, 16 .. 16384
};

// PNG, anti-aliased, written atomically. Throws Error without a display (see display.h) or if
// nothing could be drawn, FileError if the file cannot be written. The view must not be attached to
// a window elsewhere.
//
//   SceneView view;
//   view.setMesh(mesh);
//   view.setField(field);
//   view.showOnly(parseLayers("mesh,slice"));
//   view.setView(ViewPreset::iso);
//   renderToPng(view, {1280, 960}, "picture.png");
void renderToPng(SceneView& view, const PictureSize& size, const std::filesystem::path& path);
void renderToPng(ScanPicture& view, const PictureSize& size, const std::filesystem::path& path);

} // namespace patina

// Replays a recording in a view, with its force over time beside it, and writes it as a video.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "scene/tool_sample.h"
#include "visualization/values/figure.h"
#include "visualization/view/scene_view.h"

namespace patina {

constexpr int kVideoFrameRate = 25; // [1/s]

Figure withEvenSides(Figure figure); // a video has no others

// Writes one frame at a time, so that a window can go on in between. The file appears at the end; a
// destroyed writer leaves none.
class VideoWriter {
 public:
  // A Theora video (.ogv) in real time. Sides of the figure are made even; its background must not
  // be transparent. The plot takes the right third. Of each frame's time the last sample is shown.
  // Throws Error for another extension, without samples and as drawFigure() does; FileError.
  VideoWriter(SceneView& view, std::vector<ToolSample> samples, Figure figure,
              const std::filesystem::path& path);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  int frames() const;
  int written() const;
  // Returns false after the last frame, when the file is complete. Throws FileError.
  bool writeNext();

 private:
  struct Impl;
  std::unique_ptr<Impl> my_;
};

} // namespace patina

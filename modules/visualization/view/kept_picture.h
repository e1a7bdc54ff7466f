// Copy of what a renderer has drawn, with its depth. Later frames take it instead of drawing the
// bodies again, while only what another renderer draws in front of them moves. Internal to the
// module.
#pragma once

#include <vtkRenderPass.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

namespace patina {

// Draws a renderer's bodies as it does without a pass, but for its 2D actors.
vtkSmartPointer<vtkRenderPass> bodiesPass();

class KeptPicture {
 public:
  // The renderer must fill its window, which must have one sample per pixel.
  explicit KeptPicture(vtkRenderer& renderer);
  ~KeptPicture();
  KeptPicture(const KeptPicture&) = delete;
  KeptPicture& operator=(const KeptPicture&) = delete;

  void keepNext(); // copies the picture at the end of the renderer's next render
  void drop();     // to be called when the bodies have changed
  bool has() const;
  // Render pass that draws the copy, for vtkRenderer::SetPass().
  vtkRenderPass& pass() const;

 private:
  class Pass;
  void ended(); // the renderer has drawn
  vtkRenderer& renderer_;
  vtkSmartPointer<Pass> pass_;
  unsigned long observer_ = 0;
  bool wanted_ = false;
};

} // namespace patina

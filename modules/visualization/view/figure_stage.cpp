#include "visualization/view/figure_stage.h"

#include <cmath>
#include <map>
#include <utility>

#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkProperty.h>
#include <vtkRendererCollection.h>
#include <vtkWindowToImageFilter.h>

#include "core/memory_left.h"
#include "visualization/view/display.h"
#include "visualization/view/png.h"

namespace patina {
namespace {

constexpr double kManyPixels = 30e6; // Larger pictures are smoothed by fewer samples.
constexpr double kBytesPerSample = 8, kBytesPerPixel = 50; // measured

// Also frees what the renderers hold in the window's OpenGL context.
void removeRenderers(vtkRenderWindow& window) {
  while (vtkRenderer* renderer = window.GetRenderers()->GetFirstRenderer()) {
    renderer->ReleaseGraphicsResources(&window);
    window.RemoveRenderer(renderer);
  }
}

// Widths of lines and sizes of points are in pixels, unlike texts. Restores them when destroyed.
class MagnifiedLines {
 public:
  MagnifiedLines(vtkRenderWindow& window, double factor) {
    for (int i = 0; i < window.GetRenderers()->GetNumberOfItems(); ++i) {
      auto* renderer = vtkRenderer::SafeDownCast(window.GetRenderers()->GetItemAsObject(i));
      vtkActorCollection* actors = renderer->GetActors();
      for (int k = 0; k < actors->GetNumberOfItems(); ++k) {
        auto* actor = vtkActor::SafeDownCast(actors->GetItemAsObject(k));
        if (actor != nullptr) before_.insert({actor->GetProperty(), {}});
      }
    }
    for (auto& [property, sizes] : before_) {
      sizes = {property->GetLineWidth(), property->GetPointSize()};
      property->SetLineWidth(static_cast<float>(factor * sizes.first));
      property->SetPointSize(static_cast<float>(factor * sizes.second));
    }
  }
  ~MagnifiedLines() {
    for (const auto& [property, sizes] : before_) {
      property->SetLineWidth(sizes.first);
      property->SetPointSize(sizes.second);
    }
  }
  MagnifiedLines(const MagnifiedLines&) = delete;
  MagnifiedLines& operator=(const MagnifiedLines&) = delete;

 private:
  std::map<vtkProperty*, std::pair<float, float>> before_;
};

} // namespace

FigureStage::FigureStage(SceneView& view, const Figure& figure)
    : view_(view), magnification_(figure.magnification),
      shown_in_(view.renderer().GetRenderWindow()), style_(view.backgroundStyle()) {
  checkPictureSize({figure.width, figure.height});
  requireDisplay();
  const double pixels = static_cast<double>(figure.width) * figure.height;
  const int samples = pixels > kManyPixels ? 2 : 8;
  requireMemory(pixels * (samples * kBytesPerSample + kBytesPerPixel), "the figure",
                "; choose a smaller width, dpi or scale");
  if (shown_in_ != nullptr) removeRenderers(*shown_in_);
  window_->SetOffScreenRendering(1);
  window_->SetMultiSamples(samples);
  window_->SetSize(figure.width, figure.height);
  window_->SetDPI(static_cast<int>(std::lround(72 * figure.magnification)));
  view.attachTo(*window_);
  for (int i = 0; i < window_->GetRenderers()->GetNumberOfItems(); ++i) {
    auto* renderer = vtkRenderer::SafeDownCast(window_->GetRenderers()->GetItemAsObject(i));
    smoothed_[renderer] = renderer->GetUseFXAA();
    renderer->SetUseFXAA(false);
  }
  view.setInteracting(false);
  view.setFigureParts(figure.without);
  if (figure.background != FigureBackground::as_seen) {
    palette::BackgroundStyle style = palette::kWhite;
    style.plates = figure.background == FigureBackground::white;
    view.setBackgroundStyle(style);
  }
  view.prepare();
  if (shown_in_ != nullptr || figure.keeps_camera) return;
  view.fit(); // for the figure's ratio of width to height
  view.prepare();
}

FigureStage::~FigureStage() {
  removeRenderers(*window_); // They outlive the window and would keep a pointer to it.
  view_.setFigureParts(std::nullopt);
  view_.setBackgroundStyle(style_);
  for (const auto& [renderer, smooth] : smoothed_) renderer->SetUseFXAA(smooth);
  if (shown_in_ != nullptr) view_.attachTo(*shown_in_);
}

vtkSmartPointer<vtkImageData> FigureStage::draw() {
  const MagnifiedLines lines(*window_, magnification_);
  window_->Render();
  const vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window_);
  grab->ReadFrontBufferOff();
  grab->ShouldRerenderOff();
  grab->Update();
  return grab->GetOutput();
}

vtkSmartPointer<vtkImageData> FigureStage::drawOver(double grey) {
  view_.renderer().GradientBackgroundOff();
  view_.renderer().SetBackground(grey, grey, grey);
  return draw();
}

} // namespace patina

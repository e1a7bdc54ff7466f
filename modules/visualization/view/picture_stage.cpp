#include "visualization/view/picture_stage.h"

#include <algorithm>

#include <vtkCameraPass.h>
#include <vtkLightsPass.h>
#include <vtkObjectFactory.h>
#include <vtkOpaquePass.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkOverlayPass.h>
#include <vtkRenderPassCollection.h>
#include <vtkRenderState.h>
#include <vtkSequencePass.h>
#include <vtkTranslucentPass.h>

#include "visualization/values/scene_setup.h"

namespace patina {
namespace {

constexpr unsigned kColorBit = 0x4000, kLinear = 0x2601, kScissorTest = 0x0C11;

class HalfSizePass : public vtkRenderPass {
 public:
  static HalfSizePass* New() { VTK_STANDARD_NEW_BODY(HalfSizePass); }

  void Render(const vtkRenderState* state) override {
    vtkRenderer* renderer = state->GetRenderer();
    auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
    int width, height, x, y;
    renderer->GetTiledSizeAndOrigin(&width, &height, &x, &y);
    const int half_width = (width + 1) / 2, half_height = (height + 1) / 2;

    vtkOpenGLState* gl = window->GetState();
    gl->PushFramebufferBindings();
    half_->SetContext(window);
    half_->PopulateFramebuffer(half_width, half_height);
    half_->StartNonOrtho(half_width, half_height);
    vtkRenderState bodies(renderer);
    bodies.SetPropArrayAndCount(state->GetPropArray(), state->GetPropArrayCount());
    bodies.SetFrameBuffer(half_);
    bodies_->Render(&bodies);
    NumberOfRenderedProps = bodies_->GetNumberOfRenderedProps();
    gl->PopFramebufferBindings();

    gl->PushReadFramebufferBinding();
    half_->Bind(vtkOpenGLFramebufferObject::GetReadMode());
    half_->ActivateReadBuffer(0);
    gl->vtkglDisable(kScissorTest);
    const int from[] = {0, half_width, 0, half_height}, to[] = {x, x + width, y, y + height};
    vtkOpenGLFramebufferObject::Blit(from, to, kColorBit, kLinear);
    gl->PopReadFramebufferBinding();
    gl->vtkglEnable(kScissorTest);
    gl->vtkglViewport(x, y, width, height);
    gl->vtkglScissor(x, y, width, height);
    texts_->Render(state);
  }

  void ReleaseGraphicsResources(vtkWindow* window) override {
    bodies_->ReleaseGraphicsResources(window);
    texts_->ReleaseGraphicsResources(window);
    half_->ReleaseGraphicsResources(window);
    vtkRenderPass::ReleaseGraphicsResources(window);
  }

 protected:
  HalfSizePass() {
    const vtkNew<vtkRenderPassCollection> passes;
    passes->AddItem(vtkNew<vtkLightsPass>());
    passes->AddItem(vtkNew<vtkOpaquePass>());
    passes->AddItem(vtkNew<vtkTranslucentPass>());
    const vtkNew<vtkSequencePass> sequence;
    sequence->SetPasses(passes);
    bodies_->SetDelegatePass(sequence);
  }

 private:
  vtkNew<vtkCameraPass> bodies_;
  vtkNew<vtkOverlayPass> texts_;
  vtkNew<vtkOpenGLFramebufferObject> half_;
};

} // namespace

PictureStage::PictureStage() : axes(axesActor()) {}

void PictureStage::setUp() {
  setBackground(*scene, ground);
  addLights(*scene);
  overlay->SetLayer(1);
  overlay->InteractiveOff();
  overlay->SetActiveCamera(&camera());
  addLights(*overlay);
  corner->SetLayer(1);
  corner->InteractiveOff();
  corner->AddActor(axes);
}

void PictureStage::attachTo(vtkRenderWindow& window) {
  window.SetNumberOfLayers(2);
  for (vtkRenderer* renderer : {scene.Get(), overlay.Get(), corner.Get()})
    window.AddRenderer(renderer);
}

void PictureStage::setGround(const palette::BackgroundStyle& style) {
  ground = style;
  setBackground(*scene, style);
  dirty = true;
}

void PictureStage::setHalfSize(bool on) {
  if (on && !half_size_) half_size_ = vtkSmartPointer<HalfSizePass>::New();
  scene->SetPass(on ? half_size_.Get() : nullptr);
}

std::array<int, 2> PictureStage::size() const {
  auto* window = scene->GetRenderWindow();
  return window ? std::array{window->GetSize()[0], window->GetSize()[1]} : std::array{0, 0};
}

double PictureStage::placeCorner(double distance, double share, double lines) {
  Vec3 back =
      (Vec3(camera().GetPosition()) - Vec3(camera().GetFocalPoint())).normalized() * distance;
  vtkCamera* small = corner->GetActiveCamera();
  small->SetPosition(back.data());
  small->SetFocalPoint(0, 0, 0);
  small->SetViewUp(camera().GetViewUp());
  const auto [wide, high] = size();
  const double side = std::max(share * high, lines * letters().pixels);
  corner->SetViewport(0, 0, std::min(1.0, side / std::max(1, wide)),
                      std::min(1.0, side / std::max(1, high)));
  corner->ResetCameraClippingRange();
  return side;
}

bool PictureStage::finishFrame() {
  scene->ResetCameraClippingRange();
  const CameraState place = placeOf(camera());
  const bool changed = dirty || place != drawn_from_ || size() != drawn_size_;
  drawn_from_ = place;
  drawn_size_ = size();
  dirty = false;
  return changed;
}

} // namespace patina

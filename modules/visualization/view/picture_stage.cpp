#include "visualization/view/picture_stage.h"

#include <algorithm>
#include <limits>

#include <vtkBoundingBox.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkOverlayPass.h>
#include <vtkRenderState.h>

#include "visualization/values/scene_setup.h"

namespace patina {
namespace {

constexpr unsigned kColorBit = 0x4000, kDepthBit = 0x0100, kLinear = 0x2601, kNearest = 0x2600,
                   kScissorTest = 0x0C11;

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
    half_->PopulateFramebuffer(half_width, half_height, true, 1, VTK_UNSIGNED_CHAR, true, 32, 0,
                               window->GetStencilCapable() != 0);
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
    vtkOpenGLFramebufferObject::Blit(from, to, kDepthBit, kNearest);
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
  HalfSizePass() = default;

 private:
  vtkSmartPointer<vtkRenderPass> bodies_ = bodiesPass();
  vtkNew<vtkOverlayPass> texts_;
  vtkNew<vtkOpenGLFramebufferObject> half_;
};

// Least and largest depth of what a renderer shows; {inf, -inf} if it shows nothing.
std::array<double, 2> depthsOf(vtkRenderer& renderer, vtkCamera& camera) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  std::array<double, 2> depths{kInfinite, -kInfinite};
  const vtkBoundingBox box(renderer.ComputeVisiblePropBounds());
  if (!box.IsValid()) return depths;
  const Vec3 eye(camera.GetPosition()), along(camera.GetDirectionOfProjection());
  for (int i = 0; i < 8; ++i) {
    Vec3 corner;
    box.GetCorner(i, corner.data());
    const double depth = (corner - eye).dot(along);
    depths = {std::min(depths[0], depth), std::max(depths[1], depth)};
  }
  return depths;
}

} // namespace

PictureStage::PictureStage() : axes(axesActor()) {}

void PictureStage::setUp() {
  setBackground(*scene, ground);
  addLights(*scene);
  foreground->SetLayer(1);
  foreground->PreserveDepthBufferOn();
  foreground->InteractiveOff();
  foreground->SetActiveCamera(&camera());
  addLights(*foreground);
  overlay->SetLayer(2);
  overlay->InteractiveOff();
  overlay->SetActiveCamera(&camera());
  addLights(*overlay);
  corner->SetLayer(2);
  corner->InteractiveOff();
  corner->AddActor(axes);
}

void PictureStage::attachTo(vtkRenderWindow& window) {
  window.SetNumberOfLayers(3);
  for (vtkRenderer* renderer : {scene.Get(), foreground.Get(), overlay.Get(), corner.Get()})
    window.AddRenderer(renderer);
}

void PictureStage::setGround(const palette::BackgroundStyle& style) {
  ground = style;
  setBackground(*scene, style);
  dirty = true;
}

void PictureStage::setHalfSize(bool on) {
  if (on && !half_size_) half_size_ = vtkSmartPointer<HalfSizePass>::New();
  is_half_size_ = on;
  choosePass();
}

// The last of both that draws anything smooths what the other has drawn, too.
void PictureStage::setSmooth(bool on) {
  const bool in_front = foreground->VisibleActorCount() > 0, of_bodies = on && !in_front;
  foreground->SetUseFXAA(on && in_front);
  // A kept picture keeps its edges while something moves before it.
  if (scene->GetUseFXAA() == of_bodies || (kept_.has() && changed_)) return;
  scene->SetUseFXAA(of_bodies);
  kept_.drop();
  choosePass();
}

void PictureStage::choosePass() {
  scene->SetPass(kept_.has() ? &kept_.pass() : is_half_size_ ? half_size_.Get() : nullptr);
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

void PictureStage::setRange() {
  vtkBoundingBox all;
  for (vtkRenderer* renderer : {scene.Get(), foreground.Get()})
    if (const vtkBoundingBox box(renderer->ComputeVisiblePropBounds()); box.IsValid())
      all.AddBox(box);
  if (!all.IsValid()) return;
  std::array<double, 6> bounds{};
  all.GetBounds(bounds.data());
  scene->ResetCameraClippingRange(bounds.data());
  fitted_ = depthsOf(*foreground, camera());
}

bool PictureStage::frontIsInRange() const {
  const auto [low, high] = depthsOf(*foreground, camera());
  const double* range = camera().GetClippingRange();
  return low >= std::min(range[0], fitted_[0]) && high <= std::max(range[1], fitted_[1]);
}

bool PictureStage::finishFrame() {
  const CameraState place = placeOf(camera());
  const bool bodies = dirty || place != drawn_from_ || size() != drawn_size_ || !frontIsInRange();
  changed_ = bodies || front_dirty;
  auto* window = scene->GetRenderWindow();
  if (bodies) {
    setRange();
    kept_.drop();
  } else if (front_dirty && !kept_.has() && window != nullptr && window->GetMultiSamples() == 0) {
    kept_.keepNext();
  }
  choosePass();
  drawn_from_ = place;
  drawn_size_ = size();
  dirty = front_dirty = false;
  return changed_;
}

} // namespace patina

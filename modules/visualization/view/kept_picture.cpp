#include "visualization/view/kept_picture.h"

#include <array>

#include <vtkCameraPass.h>
#include <vtkCommand.h>
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

namespace patina {
namespace {

constexpr unsigned kColorAndDepth = 0x4000 | 0x0100, kUnscaled = 0x2600, kScissor = 0x0C11;

} // namespace

vtkSmartPointer<vtkRenderPass> bodiesPass() {
  const vtkNew<vtkRenderPassCollection> passes;
  passes->AddItem(vtkNew<vtkLightsPass>());
  passes->AddItem(vtkNew<vtkOpaquePass>());
  passes->AddItem(vtkNew<vtkTranslucentPass>());
  const vtkNew<vtkSequencePass> sequence;
  sequence->SetPasses(passes);
  auto bodies = vtkSmartPointer<vtkCameraPass>::New();
  bodies->SetDelegatePass(sequence);
  return bodies;
}

class KeptPicture::Pass : public vtkRenderPass {
 public:
  static Pass* New() { VTK_STANDARD_NEW_BODY(Pass); }

  void Render(const vtkRenderState* state) override {
    auto* window = windowOf(*state->GetRenderer());
    NumberOfRenderedProps = 0;
    if (has_ && window == window_ && sizeOf(*window) == size_)
      return copy(*window, *copy_, *window->GetRenderFramebuffer());
    has_ = false; // the window has another size since, or is another
    bodies_->Render(state);
    texts_->Render(state);
  }

  void keep(vtkRenderer& renderer) {
    vtkOpenGLRenderWindow* window = windowOf(renderer);
    const int* size = window->GetSize();
    copy_->SetContext(window);
    // The window makes its own buffer the same way, and depth is copied between equal formats only.
    copy_->PopulateFramebuffer(size[0], size[1], true, 1, VTK_UNSIGNED_CHAR, true, 32, 0,
                               window->GetStencilCapable() != 0);
    copy(*window, *window->GetRenderFramebuffer(), *copy_);
    window_ = window;
    size_ = sizeOf(*window);
    has_ = true;
  }
  void drop() { has_ = false; }
  bool has() const { return has_; }

  void ReleaseGraphicsResources(vtkWindow* window) override {
    has_ = false;
    copy_->ReleaseGraphicsResources(window);
    bodies_->ReleaseGraphicsResources(window);
    texts_->ReleaseGraphicsResources(window);
    vtkRenderPass::ReleaseGraphicsResources(window);
  }

 private:
  static vtkOpenGLRenderWindow* windowOf(vtkRenderer& renderer) {
    return vtkOpenGLRenderWindow::SafeDownCast(renderer.GetRenderWindow());
  }

  static void copy(vtkOpenGLRenderWindow& window, vtkOpenGLFramebufferObject& from,
                   vtkOpenGLFramebufferObject& to) {
    const int* size = window.GetSize();
    const int all[] = {0, size[0], 0, size[1]};
    vtkOpenGLState* gl = window.GetState();
    from.Bind(vtkOpenGLFramebufferObject::GetReadMode());
    from.ActivateReadBuffer(0);
    to.Bind(vtkOpenGLFramebufferObject::GetDrawMode());
    to.ActivateDrawBuffer(0);
    gl->vtkglDisable(kScissor);
    vtkOpenGLFramebufferObject::Blit(all, all, kColorAndDepth, kUnscaled);
    gl->vtkglEnable(kScissor);
    vtkOpenGLFramebufferObject* shown = window.GetRenderFramebuffer();
    shown->Bind();
    shown->ActivateDrawBuffer(0);
    shown->ActivateReadBuffer(0);
    gl->vtkglViewport(0, 0, size[0], size[1]);
    gl->vtkglScissor(0, 0, size[0], size[1]);
  }

  static std::array<int, 2> sizeOf(vtkOpenGLRenderWindow& window) {
    return {window.GetSize()[0], window.GetSize()[1]};
  }

  vtkNew<vtkOpenGLFramebufferObject> copy_;
  vtkSmartPointer<vtkRenderPass> bodies_ = bodiesPass();
  vtkNew<vtkOverlayPass> texts_;
  const vtkOpenGLRenderWindow* window_ = nullptr; // shown in the copy
  std::array<int, 2> size_{};
  bool has_ = false;
};

KeptPicture::KeptPicture(vtkRenderer& renderer)
    : renderer_(renderer), pass_(vtkSmartPointer<Pass>::New()) {
  observer_ = renderer.AddObserver(vtkCommand::EndEvent, this, &KeptPicture::ended);
}

KeptPicture::~KeptPicture() {
  renderer_.RemoveObserver(observer_);
}

void KeptPicture::ended() {
  if (!wanted_) return;
  pass_->keep(renderer_);
  wanted_ = false;
}

void KeptPicture::keepNext() {
  wanted_ = true;
}

void KeptPicture::drop() {
  wanted_ = false;
  pass_->drop();
}

bool KeptPicture::has() const {
  return pass_->has();
}

vtkRenderPass& KeptPicture::pass() const {
  return *pass_;
}

} // namespace patina

#include "visualization/view/kept_picture.h"

#include <vtkCommand.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkRenderState.h>

namespace patina {
namespace {

constexpr unsigned kColorAndDepth = 0x4000 | 0x0100, kUnscaled = 0x2600, kScissor = 0x0C11;

} // namespace

class KeptPicture::Pass : public vtkRenderPass {
 public:
  static Pass* New() { VTK_STANDARD_NEW_BODY(Pass); }

  void Render(const vtkRenderState* state) override {
    auto* window = windowOf(*state->GetRenderer());
    copy(*window, *copy_, *window->GetRenderFramebuffer());
    NumberOfRenderedProps = 0;
  }

  void keep(vtkRenderer& renderer) {
    vtkOpenGLRenderWindow* window = windowOf(renderer);
    const int* size = window->GetSize();
    copy_->SetContext(window);
    // The window makes its own buffer the same way, and depth is copied between equal formats only.
    copy_->PopulateFramebuffer(size[0], size[1], true, 1, VTK_UNSIGNED_CHAR, true, 32, 0,
                               window->GetStencilCapable() != 0);
    copy(*window, *window->GetRenderFramebuffer(), *copy_);
  }

  void ReleaseGraphicsResources(vtkWindow* window) override {
    copy_->ReleaseGraphicsResources(window);
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

  vtkNew<vtkOpenGLFramebufferObject> copy_;
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
  has_ = true;
}

void KeptPicture::keepNext() {
  wanted_ = true;
}

void KeptPicture::drop() {
  wanted_ = has_ = false;
}

bool KeptPicture::has() const {
  return has_;
}

vtkRenderPass& KeptPicture::pass() const {
  return *pass_;
}

} // namespace patina

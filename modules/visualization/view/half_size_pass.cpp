#include "visualization/view/half_size_pass.h"

#include <vtkLightsPass.h>
#include <vtkObjectFactory.h>
#include <vtkOpaquePass.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkRenderPassCollection.h>
#include <vtkRenderState.h>
#include <vtkRenderer.h>
#include <vtkSequencePass.h>
#include <vtkTranslucentPass.h>

namespace patina {
namespace {
// As OpenGL numbers them.
constexpr unsigned kColorBit = 0x4000, kLinear = 0x2601, kScissorTest = 0x0C11;
} // namespace

vtkStandardNewMacro(HalfSizePass)

    HalfSizePass::HalfSizePass() {
  const vtkNew<vtkRenderPassCollection> passes;
  passes->AddItem(vtkNew<vtkLightsPass>());
  passes->AddItem(vtkNew<vtkOpaquePass>());
  passes->AddItem(vtkNew<vtkTranslucentPass>());
  const vtkNew<vtkSequencePass> sequence;
  sequence->SetPasses(passes);
  bodies_->SetDelegatePass(sequence);
}

HalfSizePass::~HalfSizePass() = default;

void HalfSizePass::Render(const vtkRenderState* state) {
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

void HalfSizePass::ReleaseGraphicsResources(vtkWindow* window) {
  bodies_->ReleaseGraphicsResources(window);
  texts_->ReleaseGraphicsResources(window);
  half_->ReleaseGraphicsResources(window);
  vtkRenderPass::ReleaseGraphicsResources(window);
}

} // namespace patina

#include "visualization/view/picture.h"

#include <string_view>

#include <vtkImageData.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkRendererCollection.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include "core/error.h"
#include "core/file.h"
#include "visualization/view/display.h"
#include "visualization/view/png.h"

namespace patina {

void checkPictureSize(const PictureSize& size) {
  if (size.width < 16 || size.height < 16 || size.width > 16384 || size.height > 16384)
    throw Error("a picture is 16 to 16384 pixels wide and high");
}

void writeWindowPng(vtkRenderWindow& window, const std::filesystem::path& path) {
  const vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(&window);
  grab->SetInputBufferTypeToRGB();
  grab->ReadFrontBufferOff();
  grab->ShouldRerenderOff();
  grab->Update();
  auto* pixels = grab->GetOutput()->GetPointData()->GetScalars();
  double range[2] = {0, 0};
  if (pixels != nullptr) pixels->GetRange(range, -1);
  if (range[0] == range[1])
    throw Error("nothing was drawn: OpenGL gave an empty picture; check that `glxinfo` works here");
  const vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(grab->GetOutputPort());
  writer->WriteToMemoryOn();
  writer->Write();
  const auto* bytes = writer->GetResult();
  if (bytes == nullptr) throw FileError(path.string(), 0, "cannot be encoded as PNG");
  auto* data = const_cast<vtkUnsignedCharArray*>(static_cast<const vtkUnsignedCharArray*>(bytes));
  writeFileAtomically(path, std::string_view(reinterpret_cast<const char*>(data->GetPointer(0)),
                                             static_cast<std::size_t>(data->GetNumberOfValues())));
}

namespace {

template <class View>
void renderView(View& view, const PictureSize& size, const std::filesystem::path& path) {
  checkPictureSize(size);
  requireDisplay();
  const vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(8);
  window->SetSize(size.width, size.height);
  view.attachTo(*window);
  view.prepare();
  view.fit(); // for the picture's aspect ratio
  view.prepare();
  window->Render();
  writeWindowPng(*window, path);
  // The renderers outlive the window and would keep a pointer to it.
  while (vtkRenderer* renderer = window->GetRenderers()->GetFirstRenderer())
    window->RemoveRenderer(renderer);
}

} // namespace

void renderToPng(SceneView& view, const PictureSize& size, const std::filesystem::path& path) {
  renderView(view, size, path);
}

void renderToPng(ScanPicture& view, const PictureSize& size, const std::filesystem::path& path) {
  renderView(view, size, path);
}

} // namespace patina

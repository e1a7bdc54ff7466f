// The view's picture of a mesh's own colours, compared with VTK's picture of the same colours as
// point values and as a texture through the mesh's own coordinates.
#include <array>

#include <gtest/gtest.h>
#include <vtkCamera.h>
#include <vtkFloatArray.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTexture.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include "core/file.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/shapes.h"
#include "picture/picture_support.h"
#include "pictures/picture_file.h"
#include "session/open/session.h"
#include "support/fresh_folder.h"
#include "visualization/layers/image_surface.h"
#include "visualization/surfaces/surface_data.h"

namespace patina {
namespace {

constexpr int kPixels = 400;

// Returns the colour of a corner of the cube.
std::array<float, 3> colorOf(const Vec3& p) {
  return {p.x() > 0 ? 1.0F : 0.2F, p.y() > 0 ? 0.9F : 0.1F, p.z() > 0 ? 0.8F : 0.0F};
}
std::array<float, 3> colorOfSide(std::size_t side) {
  return {static_cast<float>(side % 3) / 2, static_cast<float>(side % 2), side < 3 ? 0.2F : 0.9F};
}
std::size_t sideOf(const TriangleMesh& mesh, std::size_t face) {
  const Vec3 n = faceNormal(mesh, face);
  Eigen::Index axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  return static_cast<std::size_t>(axis) + (n[axis] > 0 ? 3 : 0);
}
// Each side of the cube shows the whole picture.
Vec2 uvOf(const TriangleMesh& mesh, std::size_t face, int corner) {
  const std::size_t axis = sideOf(mesh, face) % 3;
  const Vec3 p = mesh.corner(face, corner);
  const Eigen::Index right = axis == 0 ? 1 : 0, up = axis == 2 ? 1 : 2;
  return {p[right] / 0.05 + 0.5, p[up] / 0.05 + 0.5};
}

Picture checks() {
  Picture picture{128, 128, 3, {}};
  for (int j = 0; j < 128; ++j)
    for (int i = 0; i < 128; ++i) {
      const bool dark = (i / 32 + j / 32) % 2 == 0;
      for (const float value :
           {dark ? 0.2F : 0.9F, static_cast<float>(i) / 128, static_cast<float>(j) / 128})
        picture.texel.push_back(value);
    }
  return picture;
}

class ColorPicture : public testing::Test {
 protected:
  void SetUp() override {
    PATINA_NEEDS_DISPLAY();
    folder_ = test::freshFolder("color picture");
    mesh_ = box(Vec3::Constant(0.05), 1);
    for (std::size_t f = 0; f < mesh_.triangles.size(); ++f)
      mesh_.corner_uvs.push_back({uvOf(mesh_, f, 0), uvOf(mesh_, f, 1), uvOf(mesh_, f, 2)});
  }

  vtkSmartPointer<vtkImageData> draw(vtkActor& actor) {
    const vtkNew<vtkRenderer> renderer;
    renderer->AddActor(&actor);
    renderer->SetBackground(1, 1, 1);
    renderer->GetActiveCamera()->SetPosition(0.11, -0.15, 0.09);
    renderer->GetActiveCamera()->SetViewUp(0, 0, 1);
    renderer->ResetCamera();
    const vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(kPixels, kPixels);
    window->AddRenderer(renderer);
    const vtkNew<vtkWindowToImageFilter> grab;
    grab->SetInput(window);
    grab->ReadFrontBufferOff();
    grab->Update();
    return grab->GetOutput();
  }

  vtkSmartPointer<vtkImageData> drawFile(const std::filesystem::path& file) {
    OpenedScene opened = openScene(file, {.unit = MeshUnit::m});
    EXPECT_TRUE(opened.scene.objects[0].paint && opened.scene.objects[0].paint->color);
    if (!opened.scene.objects[0].paint) return nullptr;
    ImageSurface surface;
    surface.set(opened.scene.objects[0], 0.001, nullptr);
    surface.prepare(PaintQuantity::color, nullptr);
    property_ = vtkSmartPointer<vtkProperty>::New();
    property_->DeepCopy(surface.actor().GetProperty());
    return draw(surface.actor());
  }

  // The cube with three points of its own for each triangle.
  vtkSmartPointer<vtkPolyData> bare() {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    const vtkNew<vtkPoints> points;
    const vtkNew<vtkCellArray> triangles;
    const vtkNew<vtkFloatArray> normals;
    normals->SetNumberOfComponents(3);
    for (std::size_t f = 0; f < mesh_.triangles.size(); ++f) {
      const Vec3 n = faceNormal(mesh_, f);
      triangles->InsertNextCell(3);
      for (int c = 0; c < 3; ++c) {
        triangles->InsertCellPoint(points->InsertNextPoint(mesh_.corner(f, c).data()));
        normals->InsertNextTuple3(n.x(), n.y(), n.z());
      }
    }
    data->SetPoints(points);
    data->SetPolys(triangles);
    data->GetPointData()->SetNormals(normals);
    return data;
  }

  vtkSmartPointer<vtkImageData> drawTruth(vtkPolyData& data, vtkTexture* texture) {
    const vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(&data);
    const vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    const vtkNew<vtkProperty> property;
    property->DeepCopy(property_);
    property->RemoveAllTextures();
    actor->SetProperty(property);
    if (texture) actor->SetTexture(texture);
    return draw(*actor);
  }

  static void expectEqual(vtkImageData* seen, vtkImageData* truth) {
    ASSERT_TRUE(seen && truth);
    double sum = 0;
    int covered = 0, different = 0;
    for (int y = 0; y < kPixels; ++y)
      for (int x = 0; x < kPixels; ++x) {
        double most = 0;
        bool background = true;
        for (int c = 0; c < 3; ++c) {
          const double a = seen->GetScalarComponentAsDouble(x, y, 0, c);
          const double b = truth->GetScalarComponentAsDouble(x, y, 0, c);
          most = std::max(most, std::abs(a - b));
          background = background && b == 255;
        }
        if (background && most == 0) continue;
        ++covered;
        sum += most;
        if (most > 24) ++different;
      }
    EXPECT_GT(covered, kPixels * kPixels / 5);
    EXPECT_LT(sum / covered, 1.5);         // levels of 255
    EXPECT_LT(different, 0.015 * covered); // along edges between two colours
  }

  static std::string text(const std::array<float, 3>& c) {
    return " " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]);
  }
  std::string vertices(bool colored, const char* keyword) const {
    std::string out;
    for (const Vec3& p : mesh_.positions)
      out += keyword + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
             std::to_string(p.z()) + (colored ? text(colorOf(p)) : "") + "\n";
    return out;
  }
  vtkSmartPointer<vtkUnsignedCharArray> rgb() const {
    auto values = vtkSmartPointer<vtkUnsignedCharArray>::New();
    values->SetNumberOfComponents(3);
    return values;
  }
  static void insert(vtkUnsignedCharArray& values, const std::array<float, 3>& c) {
    values.InsertNextTuple3(std::round(255 * c[0]), std::round(255 * c[1]), std::round(255 * c[2]));
  }
  vtkSmartPointer<vtkImageData> truthOfSides() {
    const auto data = bare();
    const auto values = rgb();
    for (std::size_t f = 0; f < mesh_.triangles.size(); ++f)
      for (int c = 0; c < 3; ++c) insert(*values, colorOfSide(sideOf(mesh_, f)));
    data->GetPointData()->SetScalars(values); // no two triangles share a point
    return drawTruth(*data, nullptr);
  }
  vtkSmartPointer<vtkImageData> truthOfPicture() {
    const auto data = bare();
    const vtkNew<vtkFloatArray> coordinates;
    coordinates->SetNumberOfComponents(2);
    for (const auto& corners : mesh_.corner_uvs)
      for (const Vec2& uv : corners) coordinates->InsertNextTuple2(uv.x(), uv.y());
    data->GetPointData()->SetTCoords(coordinates);
    const Picture picture = checks();
    const vtkNew<vtkImageData> image;
    image->SetDimensions(picture.width, picture.height, 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    auto* to = static_cast<unsigned char*>(image->GetScalarPointer());
    for (const float value : picture.texel)
      *to++ = static_cast<unsigned char>(std::lround(255 * value));
    const vtkNew<vtkTexture> texture;
    texture->SetInputData(image);
    texture->InterpolateOn();
    return drawTruth(*data, texture);
  }
  // Faces as OBJ names them, with their corners' texture points.
  std::string mappedFaces(const std::string& after_side_begins = {}) const {
    std::string out, last;
    for (std::size_t f = 0; f < mesh_.triangles.size(); ++f) {
      if (const std::string name = "side" + std::to_string(sideOf(mesh_, f));
          !after_side_begins.empty() && name != last)
        out += after_side_begins + (last = name) + "\n";
      for (const Vec2& uv : mesh_.corner_uvs[f])
        out += "vt " + std::to_string(uv.x()) + " " + std::to_string(uv.y()) + "\n";
      out += "f";
      for (std::size_t c = 0; c < 3; ++c)
        out +=
            " " + std::to_string(mesh_.triangles[f][c] + 1) + "/" + std::to_string(3 * f + c + 1);
      out += "\n";
    }
    return out;
  }

  std::filesystem::path folder_;
  TriangleMesh mesh_;
  vtkSmartPointer<vtkProperty> property_;
};

TEST_F(ColorPicture, VertexColoursMatchPointValues) {
  std::string obj = vertices(true, "v ");
  for (const Triangle& t : mesh_.triangles)
    obj += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
           std::to_string(t[2] + 1) + "\n";
  writeFileAtomically(folder_ / "a.obj", obj);
  const auto seen = drawFile(folder_ / "a.obj");
  const auto data = bare();
  const auto values = rgb();
  for (std::size_t f = 0; f < mesh_.triangles.size(); ++f)
    for (int c = 0; c < 3; ++c) insert(*values, colorOf(mesh_.corner(f, c)));
  data->GetPointData()->SetScalars(values);
  expectEqual(seen, drawTruth(*data, nullptr));
}

TEST_F(ColorPicture, FaceColoursMatchThoseOfTheirPoints) {
  std::string ply = "ply\nformat ascii 1.0\nelement vertex " +
                    std::to_string(mesh_.positions.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                    std::to_string(mesh_.triangles.size()) +
                    "\nproperty list uchar int vertex_indices\nproperty float red\nproperty float "
                    "green\nproperty float blue\nend_header\n" +
                    vertices(false, "");
  for (std::size_t f = 0; f < mesh_.triangles.size(); ++f) {
    const Triangle& t = mesh_.triangles[f];
    ply += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) +
           text(colorOfSide(sideOf(mesh_, f))) + "\n";
  }
  writeFileAtomically(folder_ / "a.ply", ply);
  const auto seen = drawFile(folder_ / "a.ply");
  expectEqual(seen, truthOfSides());
}

TEST_F(ColorPicture, MaterialColoursMatchThoseOfTheirFacesPoints) {
  std::string mtl;
  for (std::size_t side = 0; side < 6; ++side)
    mtl += "newmtl side" + std::to_string(side) + "\nKd" + text(colorOfSide(side)) + "\n";
  writeFileAtomically(folder_ / "a.mtl", mtl);
  writeFileAtomically(folder_ / "a.obj",
                      "mtllib a.mtl\n" + vertices(false, "v ") + mappedFaces("usemtl "));
  const auto seen = drawFile(folder_ / "a.obj");
  expectEqual(seen, truthOfSides());
}

TEST_F(ColorPicture, TextureColoursMatchTheTexture) {
  writePicture(folder_ / "checks.png", checks(), 8);
  writeFileAtomically(folder_ / "a.mtl", "newmtl skin\nmap_Kd checks.png\n");
  writeFileAtomically(folder_ / "a.obj",
                      "mtllib a.mtl\nusemtl skin\n" + vertices(false, "v ") + mappedFaces());
  const auto of_obj = drawFile(folder_ / "a.obj");
  expectEqual(of_obj, truthOfPicture());

  std::string ply = plyBytes(mesh_);
  ply.insert(ply.find("element vertex"), "comment TextureFile checks.png\n");
  writeFileAtomically(folder_ / "a.ply", ply);
  const auto of_ply = drawFile(folder_ / "a.ply");
  expectEqual(of_ply, truthOfPicture());
}

} // namespace
} // namespace patina

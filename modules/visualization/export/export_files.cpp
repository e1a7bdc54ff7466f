#include "visualization/export/export_files.h"

#include <algorithm>
#include <numeric>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include "core/csv.h"
#include "core/error.h"
#include "core/file.h"
#include "visualization/export/xml_file.h"
#include "visualization/surfaces/surface_data.h"

namespace patina {
namespace {

vtkSmartPointer<vtkDoubleArray> pointArray(vtkPolyData* data, const char* name, int components) {
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(data->GetNumberOfPoints());
  data->GetPointData()->AddArray(array);
  return array;
}

void addCellArray(vtkPolyData* data, const char* name, const std::vector<std::int32_t>& values) {
  const vtkNew<vtkIntArray> array;
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  data->GetCellData()->AddArray(array);
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
    case '&':
      safe += "&amp;";
      break;
    case '<':
      safe += "&lt;";
      break;
    case '>':
      safe += "&gt;";
      break;
    case '"':
      safe += "&quot;";
      break;
    default:
      safe += c;
    }
  }
  return safe;
}

} // namespace

void writeMeshVtp(const std::filesystem::path& path, const TriangleMesh& mesh,
                  const std::vector<VertexValues>& values,
                  const std::vector<std::int32_t>& object) {
  const auto data = plainData(mesh);
  std::vector<std::int32_t> face(mesh.triangles.size());
  std::iota(face.begin(), face.end(), 0);
  addCellArray(data, "face", face);
  if (!object.empty()) addCellArray(data, "object", object);
  for (const VertexValues& one : values) {
    const vtkNew<vtkFloatArray> array;
    array->SetName(one.name.c_str());
    array->SetNumberOfValues(static_cast<vtkIdType>(one.values.size()));
    std::copy(one.values.begin(), one.values.end(), array->GetPointer(0));
    data->GetPointData()->AddArray(array);
  }
  writePolyData(path, data);
}

void writeToolPathVtp(const std::filesystem::path& path, const std::vector<ToolSample>& samples) {
  const vtkNew<vtkPolyData> data;
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const vtkNew<vtkCellArray> lines;
  if (!samples.empty()) lines->InsertNextCell(static_cast<int>(samples.size()));
  for (const ToolSample& sample : samples)
    lines->InsertCellPoint(points->InsertNextPoint(sample.tip.data()));
  data->SetPoints(points);
  // VTK reads beyond its cells where a line has one point.
  samples.size() > 1 ? data->SetLines(lines) : data->SetVerts(lines);
  const auto time = pointArray(data, "t [s]", 1);
  const auto force = pointArray(data, "force [N]", 3);
  const auto vcp = pointArray(data, "vcp [m]", 3);
  const auto depth = pointArray(data, "depth [m]", 1);
  const auto contact = pointArray(data, "contact", 1);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const auto at = static_cast<vtkIdType>(s);
    time->SetValue(at, samples[s].t);
    force->SetTuple(at, samples[s].force.data());
    vcp->SetTuple(at, samples[s].vcp.data());
    depth->SetValue(at, samples[s].depth);
    contact->SetValue(at, samples[s].contact ? 1 : 0);
  }
  writePolyData(path, data);
}

void writeCollectionVtm(const std::filesystem::path& path,
                        const std::vector<std::pair<std::string, std::string>>& files) {
  std::string text = "<?xml version=\"1.0\"?>\n"
                     "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\">\n"
                     "  <vtkMultiBlockDataSet>\n";
  for (std::size_t i = 0; i < files.size(); ++i)
    text += "    <DataSet index=\"" + std::to_string(i) + "\" name=\"" + escaped(files[i].first) +
            "\" file=\"" + escaped(files[i].second) + "\"/>\n";
  text += "  </vtkMultiBlockDataSet>\n</VTKFile>\n";
  writeFileAtomically(path, text);
}

const std::vector<std::string>& toolSampleColumns() {
  static const std::vector<std::string> columns = {
      "t [s]",   "x [m]",     "y [m]",     "z [m]",     "fx [N]",    "fy [N]", "fz [N]",
      "contact", "depth [m]", "vcp_x [m]", "vcp_y [m]", "vcp_z [m]", "nx",     "ny",
      "nz",      "step [ns]", "fault",     "held",      "snap"};
  return columns;
}

std::vector<double> toolSampleRow(const ToolSample& s) {
  return {s.t,
          s.tip[0],
          s.tip[1],
          s.tip[2],
          s.force[0],
          s.force[1],
          s.force[2],
          s.contact ? 1.0 : 0.0,
          s.depth,
          s.vcp[0],
          s.vcp[1],
          s.vcp[2],
          s.normal[0],
          s.normal[1],
          s.normal[2],
          static_cast<double>(s.step_ns),
          s.fault ? 1.0 : 0.0,
          static_cast<double>(s.held),
          s.snap ? 1.0 : 0.0};
}

void writeToolSamplesCsv(const std::filesystem::path& path,
                         const std::vector<ToolSample>& samples) {
  CsvWriter writer(path, toolSampleColumns());
  for (const ToolSample& sample : samples) writer.add(toolSampleRow(sample));
  writer.commit();
}

} // namespace patina

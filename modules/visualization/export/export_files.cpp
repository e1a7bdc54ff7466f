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
  constexpr std::pair<char, const char*> kEntities[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  std::string safe;
  for (const char c : text) {
    const auto* entity = std::find_if(std::begin(kEntities), std::end(kEntities),
                                      [c](const auto& one) { return one.first == c; });
    entity == std::end(kEntities) ? safe += c : safe += entity->second;
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
  // VTK reads past its cells if a line has a single point.
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
  std::vector<double> row{s.t};
  row.reserve(toolSampleColumns().size());
  const auto add = [&](const Vec3& v) { row.insert(row.end(), v.data(), v.data() + 3); };
  add(s.tip);
  add(s.force);
  row.insert(row.end(), {s.contact ? 1.0 : 0.0, s.depth});
  add(s.vcp);
  add(s.normal);
  row.insert(row.end(), {static_cast<double>(s.step_ns), s.fault ? 1.0 : 0.0,
                         static_cast<double>(s.constraint_count), s.relocating ? 1.0 : 0.0});
  return row;
}

void writeToolSamplesCsv(const std::filesystem::path& path,
                         const std::vector<ToolSample>& samples) {
  CsvWriter writer(path, toolSampleColumns());
  for (const ToolSample& sample : samples) writer.add(toolSampleRow(sample));
  writer.commit();
}

std::vector<ToolSample> readToolSamplesCsv(const std::filesystem::path& path) {
  const std::vector<std::string>& columns = toolSampleColumns();
  constexpr std::ptrdiff_t kShown = 15; // The others are not drawn.
  CsvReader reader(
      path,
      {{columns.begin(), columns.begin() + kShown}, {}, {columns.begin() + kShown, columns.end()}});
  std::vector<ToolSample> samples;
  std::vector<double> row;
  while (reader.next(row)) {
    ToolSample s;
    s.t = row[0];
    s.tip = Vec3(row[1], row[2], row[3]);
    s.force = Vec3(row[4], row[5], row[6]);
    s.contact = row[7] != 0;
    s.depth = row[8];
    s.vcp = Vec3(row[9], row[10], row[11]);
    s.normal = Vec3(row[12], row[13], row[14]);
    s.surface = s.tip + s.depth * s.normal;
    if (!samples.empty() && !(s.t >= samples.back().t))
      throw FileError(path.string(), reader.line(), "the time decreases: not one recording");
    samples.push_back(s);
  }
  return samples;
}

} // namespace patina

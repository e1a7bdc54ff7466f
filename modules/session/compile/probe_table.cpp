#include "session/compile/probe_table.h"

#include <cmath>

#include "core/csv.h"
#include "core/numbers.h"

namespace patina {

std::vector<std::string> probeColumns(bool has_values) {
  std::vector<std::string> columns = {"x [m]", "y [m]", "z [m]",  "phi [m]", "nx",     "ny",
                                      "nz",    "face",  "cx [m]", "cy [m]",  "cz [m]", "in_band"};
  if (!has_values) return columns;
  for (const Channel& row : kChannels)
    columns.push_back(std::string(row.key) +
                      (row.unit.empty() ? "" : " [" + std::string(row.unit) + "]"));
  columns.insert(columns.end(), {"relief [m]", "red", "green", "blue", "cover", "texture [m]"});
  return columns;
}

std::vector<double> probeRow(const Probe& probe, bool has_values) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec3 &p = probe.position, &g = probe.gradient;
  Vec3 normal = g.norm() > 0 ? Vec3(g.normalized()) : Vec3::Zero(), closest = probe.closest.point;
  if (!p.allFinite()) normal.setConstant(nan);
  if (!p.allFinite() || !std::isfinite(probe.closest.distance)) closest.setConstant(nan);
  const double face = probe.closest.surface.face;
  std::vector<double> row{p.x(),       p.y(),       p.z(),       probe.distance,
                          normal.x(),  normal.y(),  normal.z(),  face,
                          closest.x(), closest.y(), closest.z(), probe.in_band ? 1.0 : 0.0};
  if (!has_values) return row;
  const SurfaceValues& values = probe.values;
  for (const Channel& channel : kChannels) row.push_back(values.material.*channel.value);
  row.push_back(values.height);
  const double cover = values.color[3];
  for (std::size_t c = 0; c < 3; ++c) row.push_back(cover > 0 ? values.color[c] / cover : 0);
  row.insert(row.end(), {cover, probe.texture.value_or(0)});
  return row;
}

std::string pinLabel(const CompiledScene& scene, const Pin& pin) {
  constexpr double kOnSurface = 0.01; // voxels: as exact as a picked point is
  const double distance = probeAt(scene, pin.position).distance;
  const bool on_surface = std::abs(distance) < kOnSurface * scene.built.field->grid.voxel;
  return on_surface ? pin.name : pin.name + " " + formatLength(distance);
}

std::string pinTable(const CompiledScene& scene, const ProbeOf& probe) {
  std::string text = "pin," + csvHeader(probeColumns(true));
  for (const Pin& pin : scene.scene.pins)
    text += pin.name + "," +
            csvRow(probeRow(probe ? probe(pin.position) : probeAt(scene, pin.position), true));
  return text;
}

} // namespace patina

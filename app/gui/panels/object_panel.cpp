#include "app/gui/panels/object_panel.h"

#include <QVBoxLayout>

#include "app/gui/toolkit/words.h"
#include "core/numbers.h"

namespace patina {
namespace {

QString sizeInMillimetres(const TriangleMesh& mesh) {
  const Box3 box = bounds(mesh);
  if (box.isEmpty()) return QStringLiteral("–");
  const Vec3 mm = 1000 * box.sizes();
  const auto number = [](double side) { return QString::number(side, 'f', side < 100 ? 1 : 0); };
  return QStringLiteral("%1 × %2 × %3 mm").arg(number(mm[0]), number(mm[1]), number(mm[2]));
}

QString layerMeaning(const std::string& name) {
  if (name == "top") return ObjectPanel::tr("index of the blocks");
  if (name == "distance") return ObjectPanel::tr("distance at every stored node");
  if (name == "face") return ObjectPanel::tr("nearest triangle of every stored node");
  if (name == "sample") return ObjectPanel::tr("distance and gradient for the servo");
  if (name == "coarse") return ObjectPanel::tr("for contact deeper than the band");
  return {};
}

} // namespace

ObjectPanel::ObjectPanel(QWidget* parent) : QGroupBox(tr("Mesh and field"), parent) {
  layoutIn<QVBoxLayout>(this);
  clear();
}

void ObjectPanel::clear() {
  delete facts_;
  facts_ = new FactTable(this);
  layout()->addWidget(facts_);
}

void ObjectPanel::meshRows(const TriangleMesh& mesh) {
  facts_->row(tr("Triangles"), shownText(formatCount(mesh.triangles.size())));
  facts_->row(tr("Vertices"), shownText(formatCount(mesh.positions.size())));
  facts_->row(tr("Size"), sizeInMillimetres(mesh));
}

void ObjectPanel::showMesh(const TriangleMesh& mesh, const QString& name) {
  clear();
  facts_->heading(name);
  meshRows(mesh);
}

void ObjectPanel::showScene(const CompiledScene& scene) {
  clear();
  QStringList names;
  for (const SceneObject& object : scene.scene.objects) names << shownText(object.name);
  facts_->heading(names.join(QStringLiteral(", ")));
  meshRows(*scene.mesh);
  const MeshReport& report = scene.mesh_report;
  facts_->row(
      tr("Watertight"), report.watertight ? tr("yes") : tr("no"),
      tr("Every edge has two faces. Contact works without that, too; inside and outside are then "
         "determined by the winding number."));
  facts_->row(
      tr("Sides"),
      shownText(
          describeSides(sideCounts(report.triangles - report.non_finite - report.degenerate,
                                   scene.built.report.open_triangles, scene.scene.field.sides))),
      tr("Closed parts have an inside. Open ones, such as a terrain, become plates as thick as the "
         "band, or two-sided with surface.sides = two and a tip radius."));
  const FieldReport& found = scene.built.report;
  if (!found.parts.empty())
    facts_->row(
        tr("Decided"), shownText(describeParts(found.parts)),
        tr("Chosen automatically, or by surface.sides: one, two or closed apply to every part with "
           "a boundary."));
  if (!found.holes.empty())
    facts_->row(tr("Largest hole"), shownText(describeHole(found.holes.front())),
                tr("Treated as closed: the space behind it is solid"), true);
  const auto defect = [&](const QString& caption, std::size_t count, const QString& tip) {
    if (count > 0) facts_->row(caption, shownText(formatCount(count)), tip, true);
  };
  defect(tr("Not finite"), report.non_finite, tr("Triangles with a NaN corner: left out"));
  defect(tr("Degenerate"), report.degenerate, tr("Triangles without area: left out"));
  defect(tr("Duplicate"), report.duplicate, tr("Duplicate triangles"));
  defect(tr("Boundary edges"), report.boundary_edges,
         tr("Edges with one face: a hole or a boundary"));
  defect(tr("Non-manifold edges"), report.non_manifold_edges, tr("Edges with three faces or more"));
  defect(tr("Misoriented edges"), report.misoriented_edges,
         tr("Edges whose two faces have inconsistent orientation"));
  if (report.widest_crack > 0)
    facts_->row(tr("Widest crack"), inWords(report.widest_crack),
                tr("Gaps between vertices, or a vertex and an edge, that are treated as closed"));

  const FieldReport& built = scene.built.report;
  const SurfaceField& field = *scene.built.field;
  facts_->heading(tr("Field"));
  facts_->row(tr("Voxel"), inWords(field.grid.voxel));
  facts_->row(tr("Nodes"), QStringLiteral("%1 × %2 × %3")
                               .arg(field.grid.nodes[0])
                               .arg(field.grid.nodes[1])
                               .arg(field.grid.nodes[2]));
  facts_->row(tr("Blocks"), shownText(formatCount(field.blockCount())),
              tr("Blocks of 8³ nodes that lie within the band"));
  facts_->row(tr("Built in"), QStringLiteral("%1 s").arg(built.seconds, 0, 'f', 2));
  if (built.ambiguous_signs > 0)
    facts_->row(tr("Ambiguous signs"), shownText(formatCount(built.ambiguous_signs)),
                tr("Nodes where the two inside tests disagree; the majority decides"), true);
  for (const LayerBytes& layer : field.layerBytes())
    facts_->row(tr("Layer %1").arg(shownText(layer.name)),
                shownText(formatBytes(static_cast<double>(layer.bytes))), layerMeaning(layer.name));
  facts_->row(tr("Together"), shownText(formatBytes(static_cast<double>(field.bytes()))));
}

} // namespace patina

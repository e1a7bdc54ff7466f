#include "app/gui/panels/object_panel.h"

#include <QLabel>
#include <QVBoxLayout>
#include <QVariant>

#include "app/gui/widgets/elided_label.h"
#include "app/gui/widgets/words.h"
#include "core/numbers.h"

namespace patina {
namespace {

QString text(const std::string& words) {
  return QString::fromStdString(words);
}

QString sizeInMillimetres(const TriangleMesh& mesh) {
  const Box3 box = bounds(mesh);
  if (box.isEmpty()) return QStringLiteral("–");
  const Vec3 mm = 1000 * box.sizes();
  const auto number = [](double side) { return QString::number(side, 'f', side < 100 ? 1 : 0); };
  return QStringLiteral("%1 × %2 × %3 mm").arg(number(mm[0]), number(mm[1]), number(mm[2]));
}

QString layerMeaning(const std::string& name) {
  if (name == "top") return ObjectPanel::tr("which block is where");
  if (name == "distance") return ObjectPanel::tr("distance at every stored node");
  if (name == "face") return ObjectPanel::tr("nearest triangle of every stored node");
  if (name == "sample") return ObjectPanel::tr("distance and gradient as the servo reads them");
  if (name == "coarse") return ObjectPanel::tr("for contact deeper than the band");
  return {};
}

} // namespace

ObjectPanel::ObjectPanel(QWidget* parent)
    : QGroupBox(tr("Mesh and field"), parent), grid_(nullptr) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  clear();
}

void ObjectPanel::clear() {
  delete body_;
  body_ = new QWidget(this);
  grid_ = new QGridLayout(body_);
  grid_->setContentsMargins(0, 0, 0, 0);
  grid_->setHorizontalSpacing(10);
  grid_->setVerticalSpacing(3);
  grid_->setColumnStretch(1, 1);
  layout()->addWidget(body_);
  rows_ = 0;
}

void ObjectPanel::row(const QString& caption, const QString& value, const QString& tip, bool bad) {
  auto* left = new QLabel(caption, body_);
  left->setProperty("quiet", true);
  auto* right = new ElidedLabel(body_);
  right->setText(value);
  right->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  right->setProperty("bad", bad);
  for (QLabel* label : std::initializer_list<QLabel*>{left, right}) label->setToolTip(tip);
  grid_->addWidget(left, rows_, 0);
  grid_->addWidget(right, rows_++, 1);
}

void ObjectPanel::heading(const QString& words) {
  auto* label = new ElidedLabel(body_);
  label->setText(words);
  QFont bold = font();
  bold.setBold(true);
  label->setFont(bold);
  label->setContentsMargins(0, rows_ > 0 ? 6 : 0, 0, 0);
  grid_->addWidget(label, rows_++, 0, 1, 2);
}

void ObjectPanel::meshRows(const TriangleMesh& mesh) {
  row(tr("Triangles"), text(formatCount(mesh.triangles.size())));
  row(tr("Vertices"), text(formatCount(mesh.positions.size())));
  row(tr("Size"), sizeInMillimetres(mesh));
}

void ObjectPanel::showMesh(const TriangleMesh& mesh, const QString& name) {
  clear();
  heading(name);
  meshRows(mesh);
}

void ObjectPanel::showScene(const CompiledScene& scene) {
  clear();
  QStringList names;
  for (const SceneObject& object : scene.scene.objects) names << text(object.name);
  heading(names.join(QStringLiteral(", ")));
  meshRows(*scene.mesh);
  const MeshReport& report = scene.mesh_report;
  row(tr("Watertight"), report.watertight ? tr("yes") : tr("no"),
      tr("Every edge has two faces. Contact works either way; inside and outside are then told by "
         "the winding number."));
  row(tr("Sides"),
      text(describeSides(sideCounts(report.triangles - report.non_finite - report.degenerate,
                                    scene.built.report.open_triangles, scene.scene.field.sides))),
      tr("Closed parts have an inside. Open ones, such as a terrain, are the front of a plate as "
         "thick as the band, or felt from both sides with surface.sides = two and a tip radius."));
  const FieldReport& found = scene.built.report;
  if (!found.parts.empty())
    row(tr("Decided"), text(describeParts(found.parts)),
        tr("By the program, or by surface.sides: one, two or closed hold for every part with a "
           "rim."));
  if (!found.holes.empty())
    row(tr("Largest hole"), text(describeHole(found.holes.front())),
        tr("Closed over: what lies behind it is solid"), true);
  const auto defect = [&](const QString& caption, std::size_t count, const QString& tip) {
    if (count > 0) row(caption, text(formatCount(count)), tip, true);
  };
  defect(tr("Not finite"), report.non_finite, tr("Triangles with a NaN corner: left out"));
  defect(tr("Degenerate"), report.degenerate, tr("Triangles without area: left out"));
  defect(tr("Duplicate"), report.duplicate, tr("Triangles that are there twice"));
  defect(tr("Boundary edges"), report.boundary_edges, tr("Edges with one face: a hole or a rim"));
  defect(tr("Non-manifold edges"), report.non_manifold_edges, tr("Edges with three faces or more"));
  defect(tr("Misoriented edges"), report.misoriented_edges,
         tr("Edges whose two faces run the same way"));
  if (report.widest_crack > 0)
    row(tr("Widest crack"), inWords(report.widest_crack),
        tr("Between corners, or a corner and an edge, that count as joined"));

  const FieldReport& built = scene.built.report;
  const SurfaceField& field = *scene.built.field;
  heading(tr("Field"));
  row(tr("Voxel"), inWords(field.grid.voxel));
  row(tr("Nodes"), QStringLiteral("%1 × %2 × %3")
                       .arg(field.grid.nodes[0])
                       .arg(field.grid.nodes[1])
                       .arg(field.grid.nodes[2]));
  row(tr("Blocks"), text(formatCount(field.blockCount())),
      tr("Blocks of 8³ nodes that lie within the band"));
  row(tr("Built in"), QStringLiteral("%1 s").arg(built.seconds, 0, 'f', 2));
  if (built.ambiguous_signs > 0)
    row(tr("Ambiguous signs"), text(formatCount(built.ambiguous_signs)),
        tr("Nodes where the two rules for inside and outside disagree; the majority stands"), true);
  for (const LayerBytes& layer : field.layerBytes())
    row(tr("Layer %1").arg(text(layer.name)), text(formatBytes(static_cast<double>(layer.bytes))),
        layerMeaning(layer.name));
  row(tr("Together"), text(formatBytes(static_cast<double>(field.bytes()))));
}

} // namespace patina

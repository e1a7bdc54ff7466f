#include "app/gui/control/probe_controller.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QColor>

#include "app/gui/state/tool_choice.h"
#include "app/gui/toolkit/words.h"
#include "core/numbers.h"
#include "scene/surface_pick.h"

namespace patina {
namespace {

QString shortNumber(double value) {
  return shownText(formatNumber(std::round(value * 1e4) / 1e4));
}

// Formats "3 N s/m", "50 µm".
QString channelWords(const Channel& row, double value) {
  if (row.unit == "m") return inWords(value);
  return (shortNumber(value) + QStringLiteral(" ") + shownText(row.unit)).trimmed();
}

QString fixed(double value, int decimals) {
  return QString::number(shownAs(value, decimals), 'f', decimals);
}

QString layerWords(Layer layer) {
  return layer == Layer::slice ? tr("Slice") : layer == Layer::iso ? tr("Iso-surface") : tr("Mesh");
}

QStringList valueWords(const SurfaceValues& values) {
  const Material& m = values.material;
  QStringList words{tr("%1 N/m").arg(m.stiffness, 0, 'f', 0)};
  if (m.static_friction > 0 || m.dynamic_friction > 0)
    words << tr("friction %1 / %2")
                 .arg(shortNumber(m.static_friction), shortNumber(m.dynamic_friction));
  for (const Channel& row : kChannels) {
    const double value = valueOf(m, row.channel);
    if (row.channel <= MaterialChannel::dynamic_friction || !(value > 0)) continue;
    const bool rough = row.channel == MaterialChannel::roughness;
    words << (rough ? tr("rough") : captionOf(Tool::material(row.channel))) + QStringLiteral(" ") +
                 channelWords(row, value);
  }
  if (values.height != 0) words << tr("relief %1 mm").arg(fixed(1000 * values.height, 3));
  if (const double cover = values.color[3]; cover > 0) {
    const auto part = [&](std::size_t c) { return std::min(1.0, values.color[c] / cover); };
    words << tr("colour %1").arg(QColor::fromRgbF(part(0), part(1), part(2)).name());
    if (cover < 0.995) words.back() += tr(" at %1 %").arg(100 * cover, 0, 'f', 0);
  }
  return words;
}

} // namespace

QString probeWords(const Scene& scene, Layer layer, const Probe& probe) {
  const auto triple = [](const Vec3& v, int decimals) {
    return QStringLiteral("%1, %2, %3")
        .arg(fixed(v.x(), decimals), fixed(v.y(), decimals), fixed(v.z(), decimals));
  };
  QStringList words{layerWords(layer), triple(1e3 * probe.position, 3) + tr(" mm")};
  words << tr("distance %1 mm").arg(fixed(1e3 * probe.distance, 3));
  words << tr("gradient %1").arg(triple(probe.gradient, 2));
  if (probe.object) words << shownText(scene.objects[*probe.object].name);
  if (probe.texture) words << tr("texture %1 µm").arg(fixed(1e6 * *probe.texture, 2));
  return (words + valueWords(probe.values)).join(QStringLiteral(" · "));
}

ProbeController::ProbeController(SceneWidget& view, QObject* parent)
    : QObject(parent), view_(view) {}

void ProbeController::refresh() {
  if (refreshes_++ % 3 != 0) return;
  const auto front = scene_ && view_.isVisible() ? view_.frontUnderPointer() : std::nullopt;
  const QString words =
      front ? probeWords(scene_->scene, front->layer, probeAt(*scene_, front->point)) : QString();
  if (words != std::exchange(words_, words)) emit underPointer(words);
}

void GapFinder::setScene(std::shared_ptr<const CompiledScene> scene) {
  if (!scene || !scene_ || scene->mesh != scene_->mesh) {
    jobs_.discardResult();
    tree_ = nullptr;
    asked_ = false;
    last_face_ = -1;
  }
  scene_ = std::move(scene);
}

std::optional<Vec3> GapFinder::nearestTo(const ToolSample& sample) {
  if (!scene_ || sample.contact || sample.attracted) return std::nullopt;
  const SurfaceField& field = *scene_->paint.field;
  const GridSample at = FieldSampler(field, scene_->scene.sampler).at(sample.tip);
  if (at.region == FieldRegion::interior || at.phi < 0) return std::nullopt;
  if (at.region == FieldRegion::band && at.gradient.norm() > 0)
    return sample.tip - at.phi * at.gradient.normalized();
  if (!tree_) {
    if (std::exchange(asked_, true)) return std::nullopt;
    jobs_.start([this, scene = scene_](Progress& progress, const Background::Post& post) {
      std::shared_ptr<const TriangleTree> tree;
      try {
        tree = std::make_shared<const TriangleTree>(hapticTriangles(*scene, progress).mesh);
      } catch (const std::exception&) { // Cancelled, or too large: there is no line.
      }
      post(true, [this, tree] { tree_ = tree; });
    });
    return std::nullopt;
  }
  const ClosestPoint closest = tree_->closestPoint(sample.tip, last_face_);
  last_face_ = closest.surface.face;
  if (!(closest.distance > 0)) return std::nullopt;
  const Vec3 way = (closest.point - sample.tip) / closest.distance;
  // Baked relief is before or behind the mesh.
  return firstSurfaceAlong(field, sample.tip, way).value_or(closest.point);
}

} // namespace patina

#include "app/gui/control/probe_controller.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QColor>

#include "app/gui/state/tool_choice.h"
#include "app/gui/toolkit/words.h"
#include "core/numbers.h"

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

} // namespace patina

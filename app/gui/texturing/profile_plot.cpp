#include "app/gui/texturing/profile_plot.h"

#include <algorithm>
#include <cmath>

#include <QPainter>

#include "app/gui/window/theme.h"

namespace patina {
namespace {

constexpr double kMilli = 1e3, kMicro = 1e6;
constexpr double kFineStep = 0.1e-3;       // of what is drawn along the way [m]
constexpr double kLeastAmplitude = 0.1e-6; // of what is drawn of the spectrum [m]

Graph spectrumOf(const FourierSeries& series, double period) {
  Graph spectrum{ProfilePlot::tr("mm"),
                 ProfilePlot::tr("µm"),
                 true,
                 true,
                 {{ProfilePlot::tr("spectrum"), "accent", {}}}};
  for (std::size_t j = 0; j < series.a.size(); ++j) {
    const double amplitude = std::hypot(series.a[j], series.b[j]);
    if (amplitude < kLeastAmplitude) continue;
    spectrum.curves[0].points << QPointF(kMilli * period / static_cast<double>(j + 1),
                                         kMicro * amplitude);
  }
  return spectrum;
}

} // namespace

void ProfilePlot::setTexture(const FourierTexture* texture) {
  graphs_.clear();
  if (texture != nullptr) {
    Graph heights{tr("mm"), tr("µm"), false, false, {{tr("height over a period"), "accent", {}}}};
    const int steps = std::clamp(8 * harmonics(*texture), 64, 2000);
    for (int i = 0; i <= steps; ++i) {
      const double x = period(*texture) * i / steps;
      heights.curves[0].points << QPointF(kMilli * x, kMicro * patina::height(*texture, x));
    }
    graphs_ = {heights};
    if (texture->kind == TextureKind::line || texture->kind == TextureKind::spectrum)
      graphs_.push_back(spectrumOf(patina::seriesOf(*texture), period(*texture)));
  }
  update();
}

void ProfilePlot::setTexture(const DemoTexture* texture) {
  graphs_.clear();
  if (texture != nullptr) {
    const FittedTexture& fitted = texture->scanned.fitted;
    Graph heights{tr("mm"),
                  tr("µm"),
                  false,
                  false,
                  {{tr("measured"), "quiet", {}}, {tr("harmonics"), "accent", {}}}};
    double last = -1;
    for (const ScanHeight& height : texture->scanned.heights) {
      const double along = height.point.along;
      if (along < last + kFineStep) continue;
      last = along;
      heights.curves[0].points << QPointF(kMilli * along, kMicro * height.point.height);
      heights.curves[1].points << QPointF(kMilli * along,
                                          kMicro * patina::height(fitted.texture, along));
    }
    graphs_ = {heights, spectrumOf(patina::seriesOf(fitted.texture), period(fitted.texture))};
    if (!texture->felt.empty()) {
      Graph felt{tr("mm"),
                 tr("N"),
                 false,
                 false,
                 {{tr("true surface"), "quiet", {}}, {tr("felt"), "accent", {}}}};
      for (std::size_t i = 0; i < texture->felt.size(); i += 3) {
        const FeltPoint& point = texture->felt[i];
        felt.curves[0].points << QPointF(kMilli * point.along, point.truth.dot(point.outward));
        felt.curves[1].points << QPointF(kMilli * point.along, point.felt.dot(point.outward));
      }
      graphs_.push_back(felt);
    }
  }
  update();
}

void ProfilePlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), ink("card"));
  const double wide = width() / std::max<double>(1, static_cast<double>(graphs_.size()));
  for (std::size_t i = 0; i < graphs_.size(); ++i)
    paintGraph(painter, QRectF(wide * static_cast<double>(i), 0, wide, height()), graphs_[i]);
}

} // namespace patina

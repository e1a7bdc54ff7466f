#include "app/gui/servo/stability_job.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace patina {
namespace {

constexpr int kPatience = 300; // [ms]

QString summary(const SurfaceStability& stability, bool device_given) {
  const StabilityMap& map = stability.map;
  const double share =
      100.0 * static_cast<double>(map.buzzing) / static_cast<double>(map.ratio.size());
  QString words =
      map.buzzing == 0
          ? StabilityJob::tr("Buzzes nowhere; least K*/K = %1").arg(map.worst_ratio, 0, 'g', 3)
          : StabilityJob::tr("%1 % of the surface would buzz; least K*/K = %2")
                .arg(share, 0, 'f', share < 10 ? 1 : 0)
                .arg(map.worst_ratio, 0, 'g', 3);
  const auto add = [&](std::size_t count, const QString& what) {
    const double part = 100.0 * static_cast<double>(count) / static_cast<double>(map.ratio.size());
    if (count > 0)
      words += StabilityJob::tr("; %1 % %2").arg(part, 0, 'f', part < 10 ? 1 : 0).arg(what);
  };
  const auto untouched =
      std::count_if(map.least.begin(), map.least.end(), [](float l) { return std::isnan(l); });
  add(map.slipping, StabilityJob::tr("lets the tip slip off (violet, unless it buzzes)"));
  add(map.jumping, StabilityJob::tr("jumps (dark)"));
  add(static_cast<std::size_t>(untouched), StabilityJob::tr("is not touched (grey)"));
  if (!device_given)
    words += StabilityJob::tr(". For a device of 100 g and 0.5 N s/m at 1 kHz: the scene has no "
                              "device numbers.");
  return words;
}

} // namespace

StabilityJob::StabilityJob(QObject* parent) : QObject(parent) {
  timer_.setSingleShot(true);
  timer_.setInterval(kPatience);
  connect(&timer_, &QTimer::timeout, this, &StabilityJob::begin);
  connect(&jobs_, &Background::rested, this, &StabilityJob::rested);
  connect(&jobs_, &Background::progressed, this, [this](double fraction) {
    emit said(tr("Computing stability: %1 %").arg(100 * fraction, 0, 'f', 0));
  });
}

void StabilityJob::cancel() {
  timer_.stop();
  jobs_.silence();
}

void StabilityJob::request(std::shared_ptr<const CompiledScene> scene) {
  cancel();
  scene_ = std::move(scene);
  if (scene_ == nullptr) return emit said({});
  emit said(tr("Computing stability…"));
  timer_.start();
}

void StabilityJob::begin() {
  jobs_.start([this, scene = scene_](Progress& progress, const Background::Deliver& deliver) {
    std::shared_ptr<const SurfaceStability> made;
    QString words;
    try {
      if (auto stability = surfaceStability(*scene, progress)) {
        made = std::make_shared<const SurfaceStability>(std::move(*stability));
        words = summary(*made, scene->scene.device_model.has_value());
      } else {
        words = tr("No point of this surface can be pressed: there is no map");
      }
    } catch (const Cancelled&) {
      return;
    } catch (const std::exception& error) {
      words = QString::fromUtf8(error.what());
    }
    deliver(true, [this, made, words] {
      emit done(made);
      emit said(words);
    });
  });
}

} // namespace patina

#include "app/gui/painting/relief_panel.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/words.h"
#include "authoring/relief/relief_limits.h"

namespace patina {
namespace {

bool sameRelief(const CompiledScene& a, const CompiledScene& b) {
  if (a.scene.relief.height != b.scene.relief.height ||
      a.scene.relief.source != b.scene.relief.source ||
      a.scene.relief.smoothing != b.scene.relief.smoothing ||
      a.scene.device_model != b.scene.device_model ||
      a.scene.objects.size() != b.scene.objects.size())
    return false;
  for (std::size_t i = 0; i < a.scene.objects.size(); ++i) {
    const auto image = [i](const CompiledScene& compiled) {
      return i < compiled.paint.relief.size() ? compiled.paint.relief[i].felt : nullptr;
    };
    if (image(a) != image(b)) return false;
  }
  return true;
}

// Returns the object whose relief is nearest to its limit, or the highest one without a device.
std::optional<ReliefLimit> worstLimit(const CompiledScene& compiled, const Progress& progress) {
  std::optional<ReliefLimit> worst;
  const auto severity = [](const ReliefLimit& limit) {
    return limit.admissible ? limit.highest / std::max(*limit.admissible, 1e-12) : limit.highest;
  };
  const auto& felt = compiled.paint.relief; // Smoothed if the scene requests it.
  for (std::size_t i = 0; i < felt.size(); ++i) {
    progress.throwIfCancelled();
    if (!felt[i].felt) continue;
    const SceneObject& object = compiled.scene.objects[i];
    const ReliefLimit limit =
        reliefLimit(*object.mesh, object.paint->layout, *felt[i].felt, compiled.scene.relief.height,
                    compiled.scene.device_model, compiled.scene.haptics.force_limit);
    if (limit.highest > 0 && (!worst || severity(limit) > severity(*worst))) worst = limit;
  }
  return worst;
}

} // namespace

ReliefPanel::ReliefPanel(QWidget* parent)
    : QGroupBox(tr("Relief"), parent), layout_(layoutIn<QVBoxLayout>(this)),
      note_(addNote(layout_, "relief_note", "")) {}

void ReliefPanel::show(std::shared_ptr<const CompiledScene> scene) {
  if (form_ == nullptr || !(scene->scene.relief == relief_)) {
    relief_ = scene->scene.relief;
    rebuild();
  }
  if (!measured_ || !sameRelief(*measured_, *scene)) measure(std::move(scene));
}

void ReliefPanel::rebuild() {
  takeAway(form_);
  form_ = new Form(this);
  connect(form_, &Form::edited, this, [this] { emit edited(relief_); });
  const double height = std::abs(relief_.height), max_height = std::max(5.0, 4000 * height);
  form_->addRow(
      RowSpec("relief_height", tr("Height of full relief"), QStringLiteral("mm"),
              {0, max_height, max_height / 100, 2},
              tr("Scales all relief: painted heights are fractions of this height"), 1000),
      height, [this](double now) { relief_.height = std::copysign(now, relief_.height); });
  form_->addCheck("relief_inverted", tr("Inverted"), tr("Raised relief becomes engraved"),
                  std::signbit(relief_.height), [this](bool on) {
                    relief_.height = std::copysign(relief_.height, on ? -1.0 : 1.0);
                  });
  const auto add = [this](const char* name, const QString& caption, const QStringList& words,
                          auto& value, auto second, auto first, const QString& tip) {
    form_->addChoice(
        name, caption, words, value == second ? 1 : 0,
        [&value, first, second](int index) { value = index == 0 ? first : second; }, tip);
  };
  add("relief_source", tr("Taken from"), {tr("what is painted"), tr("the colour")}, relief_.source,
      ReliefSource::color, ReliefSource::painted,
      tr("Colour: the grey value is rendered as height, bright is high. Black or unpainted places "
         "have no relief."));
  add("relief_mode", tr("Felt"), {tr("from the image"), tr("baked into the field")}, relief_.mode,
      ReliefMode::baked, ReliefMode::pulled,
      tr("From the image: evaluated at each contact, with the full resolution of the paint. Baked: "
         "moves the field, as in the paper; costs no time in the servo, but loses details below 8 "
         "voxels."));
  add("relief_force", tr("Force"), {tr("conservative"), tr("literal")}, relief_.form,
      ForceForm::literal, ForceForm::conservative,
      tr("Conservative: the force has a potential, and a closed path does no work. Literal: as in "
         "the papers."));
  form_->addRow(RowSpec("relief_smoothing", tr("Smoothing"), QStringLiteral("mm"), {0, 5, 0.05, 2},
                        tr("Smoothing of the rendered relief: standard deviation of a Gaussian "
                           "along the surface"),
                        1000),
                relief_.smoothing);
  layout_->insertWidget(0, form_);
}

void ReliefPanel::measure(std::shared_ptr<const CompiledScene> scene) {
  measured_ = scene;
  if (jobs_.busy()) return; // It starts when this one has ended.
  jobs_.start([this, scene](Progress& progress, const Background::Post& post) {
    std::optional<ReliefLimit> limit;
    try {
      limit = worstLimit(*scene, progress);
    } catch (const std::exception&) { // Cancelled, or too large to be measured: no note.
    }
    post(true, [this, limit, scene] {
      if (measured_ != scene) measure(measured_);
      note_->setVisible(limit.has_value());
      if (!limit) return;
      const bool beyond = limit->admissible && limit->highest > *limit->admissible;
      QString words = tr("Highest: %1.").arg(inWords(limit->highest));
      const QString press = QString::number(scene->scene.haptics.force_limit);
      if (limit->admissible)
        words += beyond ? tr(" Above %1 it may be unstable on this device at %2 N, the force "
                             "limit: lower or smooth it.")
                              .arg(inWords(*limit->admissible), press)
                        : tr(" Up to %1 it is stable on this device at %2 N, the force limit.")
                              .arg(inWords(*limit->admissible), press);
      note_->setText(words);
      note_->setProperty("bad", beyond);
      note_->setProperty("quiet", !beyond);
      applyStyleSheet(*note_,
                      beyond ? QStringLiteral("color: @bad;") : QStringLiteral("color: @quiet;"));
    });
  });
}

} // namespace patina

#include "app/gui/painting/relief_panel.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>

#include "app/gui/panels/value_row.h"
#include "authoring/relief/relief_limits.h"
#include "core/numbers.h"

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

QString inWords(double metres) {
  return QString::fromStdString(formatLength(metres));
}

// The object whose relief is nearest to its limit, or the highest one where there is no device.
std::optional<ReliefLimit> worstLimit(const CompiledScene& compiled, const Progress& progress) {
  std::optional<ReliefLimit> worst;
  const auto severity = [](const ReliefLimit& limit) {
    return limit.admissible ? limit.highest / std::max(*limit.admissible, 1e-12) : limit.highest;
  };
  const auto& felt = compiled.paint.relief; // smoothed if asked for: what a hand has to bear
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
    : QGroupBox(tr("Relief"), parent), layout_(new QVBoxLayout(this)), note_(new QLabel(this)) {
  layout_->setContentsMargins(0, 0, 0, 0);
  note_->setObjectName(QStringLiteral("relief_note"));
  note_->setWordWrap(true);
  note_->hide();
  layout_->addWidget(note_);
  connect(&jobs_, &Background::rested, this, &ReliefPanel::rested);
}

void ReliefPanel::cancel() {
  jobs_.silence();
}

void ReliefPanel::show(std::shared_ptr<const CompiledScene> scene) {
  if (rows_ == nullptr || !(scene->scene.relief == relief_)) {
    relief_ = scene->scene.relief;
    rebuild(std::abs(relief_.height));
  }
  if (!measured_ || !sameRelief(*measured_, *scene)) measure(std::move(scene));
}

void ReliefPanel::rebuild(double height) {
  takeAway(rows_);
  rows_ = new QWidget(this);
  auto* column = new QGridLayout(rows_);
  column->setContentsMargins(0, 0, 0, 0);
  column->setVerticalSpacing(6);
  const double most = std::max(5.0, 4000 * height);
  auto* scale = new ValueRow(tr("Height of full relief"), QStringLiteral("mm"),
                             {0, most, most / 100, 2}, rows_);
  scale->setObjectName(QStringLiteral("relief_height"));
  scale->setToolTip(tr("Scales all of it: painted heights are shares of this one"));
  scale->setValue(1000 * height);
  connect(scale, &ValueRow::edited, this, [this](double value) {
    relief_.height = std::copysign(value / 1000, relief_.height);
    emit edited(relief_);
  });
  column->addWidget(scale, 0, 0, 1, 2);
  auto* turned = new QCheckBox(tr("Inverted: what was raised is engraved"), rows_);
  turned->setObjectName(QStringLiteral("relief_inverted"));
  turned->setChecked(std::signbit(relief_.height));
  connect(turned, &QCheckBox::toggled, this, [this](bool on) {
    relief_.height = std::copysign(relief_.height, on ? -1.0 : 1.0);
    emit edited(relief_);
  });
  column->addWidget(turned, 1, 0, 1, 2);
  const auto combo = [&](int row, const char* name, const QString& caption,
                         const QStringList& words, int now, const QString& tip, auto set) {
    auto* label = new QLabel(caption, rows_);
    label->setProperty("quiet", true);
    auto* box = new QComboBox(rows_);
    box->setObjectName(QString::fromUtf8(name));
    box->addItems(words);
    box->setCurrentIndex(now);
    box->setToolTip(tip);
    column->addWidget(label, row, 0);
    column->addWidget(box, row, 1);
    connect(box, qOverload<int>(&QComboBox::activated), this, [this, set](int index) {
      set(relief_, index);
      emit edited(relief_);
    });
  };
  combo(2, "relief_source", tr("Taken from"), {tr("what is painted as relief"), tr("the colour")},
        relief_.source == ReliefFrom::painted ? 0 : 1,
        tr("The colour: its grey value is felt as height, bright is high, and what is not painted "
           "or black stays as it is."),
        [](ReliefSettings& r, int index) {
          r.source = index == 0 ? ReliefFrom::painted : ReliefFrom::color;
        });
  combo(3, "relief_mode", tr("Felt"), {tr("from the image"), tr("baked into the field")},
        relief_.mode == ReliefMode::pulled ? 0 : 1,
        tr("From the image: read at each contact, as fine as it is painted. Baked: the field is "
           "moved, as in the paper; costs nothing a tick, and loses what is finer than 8 voxels."),
        [](ReliefSettings& r, int index) {
          r.mode = index == 0 ? ReliefMode::pulled : ReliefMode::baked;
        });
  combo(4, "relief_force", tr("Force"), {tr("conservative"), tr("literal")},
        relief_.form == ForceForm::conservative ? 0 : 1,
        tr("Conservative: the force has a potential, no loop does work. Literal: as the papers "
           "have it."),
        [](ReliefSettings& r, int index) {
          r.form = index == 0 ? ForceForm::conservative : ForceForm::literal;
        });
  column->setColumnStretch(1, 1);
  auto* smoothing = new ValueRow(tr("Smoothing"), QStringLiteral("mm"), {0, 5, 0.05, 2}, rows_);
  smoothing->setObjectName(QStringLiteral("relief_smoothing"));
  smoothing->setToolTip(tr("Of what is felt: a Gaussian's standard deviation along the surface"));
  smoothing->setValue(1000 * relief_.smoothing);
  connect(smoothing, &ValueRow::edited, this, [this](double value) {
    relief_.smoothing = value / 1000;
    emit edited(relief_);
  });
  column->addWidget(smoothing, 5, 0, 1, 2);
  layout_->insertWidget(0, rows_);
}

void ReliefPanel::measure(std::shared_ptr<const CompiledScene> scene) {
  measured_ = scene;
  if (jobs_.busy()) return; // its turn comes when this one has ended
  jobs_.start([this, scene](Progress& progress, const Background::Deliver& deliver) {
    std::optional<ReliefLimit> limit;
    try {
      limit = worstLimit(*scene, progress);
    } catch (const std::exception&) { // cancelled, or too large to be measured: nothing is said
    }
    deliver(true, [this, limit, scene] {
      if (measured_ != scene) measure(measured_);
      note_->setVisible(limit.has_value());
      if (!limit) return;
      const bool beyond = limit->admissible && limit->highest > *limit->admissible;
      QString words = tr("Highest: %1.").arg(inWords(limit->highest));
      const QString press = QString::number(scene->scene.haptics.force_limit);
      if (limit->admissible)
        words += beyond
                     ? tr(" Beyond %1 it may buzz on this device when it is pressed with %2 N, the "
                          "force limit: lower it, or smooth it.")
                           .arg(inWords(*limit->admissible), press)
                     : tr(" Up to %1 is calm on this device at %2 N, the force limit.")
                           .arg(inWords(*limit->admissible), press);
      note_->setText(words);
      note_->setProperty("bad", beyond);
      note_->setProperty("quiet", !beyond);
      note_->setStyleSheet(beyond ? QStringLiteral("color: #a12a1a;")
                                  : QStringLiteral("color: #5b6575;"));
    });
  });
}

} // namespace patina

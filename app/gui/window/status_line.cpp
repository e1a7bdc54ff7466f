#include "app/gui/window/status_line.h"

#include <utility>

#include "app/gui/toolkit/history_words.h"
#include "app/gui/toolkit/theme.h"
#include "core/numbers.h"
#include "haptics/law/stabilisers.h"

namespace patina {

StatusLine::StatusLine(QStatusBar* bar) : QObject(bar) {
  bar->setSizeGripEnabled(false);
  applyStyleSheet(*bar,
                  QStringLiteral("QStatusBar::item { border: none; } QLabel { color: @text; }"));
  const auto add = [&](auto* made, const char* name, int stretch = 0) {
    made->setObjectName(QString::fromUtf8(name));
    made->setContentsMargins(7, 1, 7, 1);
    bar->addWidget(made, stretch);
    return made;
  };
  const auto label = [&](const char* name) { return add(new QLabel(bar), name); };
  fault_ = label("fault");
  fault_->setText(tr("force faded: it returns by itself"));
  applyStyleSheet(*fault_, QStringLiteral("background: @bad; color: @card;"));
  fault_->setToolTip(tr("The force would have jumped, so it was faded to zero. It returns when the "
                        "tip has left the surface."));
  showFault(false);
  rate_ = label("rate");
  late_ = label("late");
  missed_ = label("missed");
  policy_ = label("policy");
  stabilisers_ = label("stabilisers");
  applyStyleSheet(*stabilisers_, QStringLiteral("color: @link; font-weight: bold;"));
  bytes_ = label("bytes");
  stages_ = add(new ElidedLabel(bar), "stages");
  picked_ = add(new ElidedLabel(bar), "picked", 1); // Shortened first.
  picked_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  applyStyleSheet(*picked_, QStringLiteral("color: @link; padding-right: 8px;"));
  picked_->setToolTip(
      tr("Values under the pointer: place, distance, gradient of the distance, material"));
  late_->setToolTip(
      tr("Wake-up latency of the servo: 99th percentile over the last 8192 ticks (8 s)"));
  missed_->setToolTip(tr("Ticks more than a period late since the servo started"));
  showTiming({}, false);
  showScene(nullptr);
}

bool StatusLine::showHeldBack(const QString& words) {
  if (words == std::exchange(held_back_, words) || words.isEmpty()) return false;
  rate_->setText(words);
  return true;
}

void StatusLine::showPicked(const QString& words) {
  picked_->setText(words);
  // The stages make room; their tooltip has all of them.
  stages_->setMaximumWidth(words.isEmpty() ? QWIDGETSIZE_MAX : stages_->minimumSizeHint().width());
}

void StatusLine::showTiming(const ServoTiming& timing, bool running) {
  for (QLabel* label : {late_, missed_, policy_}) label->setVisible(running);
  if (!running) {
    rate_->setText(tr("servo stopped"));
    return;
  }
  rate_->setText(!held_back_.isEmpty() ? held_back_
                 : timing.device == DeviceStatus::ok
                     ? tr("%1 Hz").arg(timing.rate_hz, 0, 'f', 0)
                     : tr("no force: the device %1").arg(tr(text(timing.device))));
  late_->setText(tr("p99 late %1 µs").arg(timing.late_p99, 0, 'f', 0));
  missed_->setText(tr("missed %1").arg(timing.missed));
  policy_->setText(timing.realtime ? tr("real time") : tr("no real time"));
  applyStyleSheet(*policy_, timing.realtime ? QString() : QStringLiteral("color: @warn;"));
  policy_->setToolTip(QString::fromStdString(timing.policy));
}

void StatusLine::showScene(const CompiledScene* scene) {
  stabilisers_->clear();
  stabilisers_->hide();
  stages_->setVisible(scene != nullptr);
  bytes_->setVisible(scene != nullptr);
  if (scene == nullptr) return;
  QStringList names, why;
  for (const StageInfo& stage : scene->snapshot->why) {
    names << QString::fromStdString(stage.name);
    why << QStringLiteral("<tr><td><b>%1</b></td><td style='padding-left:8px'>%2</td>"
                          "<td align='right' style='padding-left:8px'>%3</td></tr>")
               .arg(names.back(), wordsOfKeys(QString::fromStdString(stage.why)).toHtmlEscaped(),
                    QString::fromStdString(formatBytes(static_cast<double>(stage.bytes))));
  }
  showStabilisers(*scene);
  stages_->setText(tr("stages: %1").arg(names.join(QStringLiteral(" → "))));
  stages_->setToolTip(QStringLiteral("<table>%1</table>").arg(why.join(QString())));
  bytes_->setText(tr("field %1")
                      .arg(QString::fromStdString(
                          formatBytes(static_cast<double>(scene->built.field->bytes())))));
}

void StatusLine::showStabilisers(const CompiledScene& scene) {
  const StabiliserPlan& plan = scene.snapshot->stabilisers;
  QStringList on, why;
  for (const StageInfo& stage : scene.snapshot->why) {
    if (stage.name != "coupling" && stage.name != "lateral coupling" && stage.name != "passivity")
      continue;
    QString words = QString::fromStdString(stage.name);
    if (stage.name == "coupling" && plan.coupling)
      words += QStringLiteral(" %1 N/m").arg(plan.coupling->stiffness, 0, 'f', 0);
    if (stage.name == "lateral coupling" && plan.lateral)
      words += QStringLiteral(" %1 N/m").arg(plan.lateral->stiffness, 0, 'f', 0);
    on << words;
    why << QStringLiteral("%1: %2").arg(words, QString::fromStdString(stage.why));
  }
  stabilisers_->setText(on.join(QStringLiteral(", ")));
  stabilisers_->setToolTip(why.join(QStringLiteral("\n")));
  stabilisers_->setVisible(!on.isEmpty());
}

} // namespace patina

#include "app/gui/texturing/step_list.h"

#include <cmath>

#include <QGridLayout>
#include <QMenu>
#include <QVBoxLayout>

#include "app/gui/widgets/words.h"

namespace patina {
namespace {

QString valueWords(double value, const std::string& unit) {
  return inWords(figureText(value, unit));
}

// The worst of each figure of a step, over the materials.
QString foundBy(const Demo& demo, const std::string& step, bool& holds) {
  QStringList lines;
  std::vector<DemoFigure> worst;
  for (const DemoFigure& figure : demoFigures(demo)) {
    if (figure.step != step) continue;
    holds = holds && figure.holds();
    const auto same = std::find_if(worst.begin(), worst.end(), [&](const DemoFigure& other) {
      return other.what == figure.what;
    });
    if (same == worst.end())
      worst.push_back(figure);
    else if (figure.value > same->value)
      *same = figure;
  }
  for (const DemoFigure& figure : worst)
    lines << StepList::tr("%1: %2, at most %3")
                 .arg(QString::fromStdString(figure.what), valueWords(figure.value, figure.unit),
                      valueWords(figure.most, figure.unit));
  return lines.join('\n');
}

QString countsOf(const Demo& demo, const std::string& step) {
  std::size_t frames = 0, poses = 0, faces = 0;
  double tip = 0, path = 0;
  for (const DemoScan& scan : demo.scans) {
    frames += scan.frames;
    poses += scan.streams.poses.size();
    tip = std::max(tip, scan.tip_error);
    path = std::max(path, scan.path_error.rms);
  }
  for (const DemoTexture& texture : demo.textures) faces += texture.scanned.laid.faces.size();
  if (step == "scan") return StepList::tr("%1 scans, %2 frames").arg(demo.scans.size()).arg(frames);
  if (step == "track")
    return StepList::tr("%1 poses, tip within %2 (rms)").arg(poses).arg(valueWords(tip, "m"));
  if (step == "filter") return StepList::tr("tip within %1 (rms)").arg(valueWords(path, "m"));
  if (step == "map") return StepList::tr("%1 faces").arg(faces);
  if (step == "paint") return StepList::tr("three colours, and a place that grips");
  return {};
}

} // namespace

StepList::StepList(QWidget* parent)
    : QGroupBox(tr("From a scan to a feel"), parent), next_(new QPushButton(this)),
      all_(new QPushButton(tr("All that is left"), this)),
      feel_(new QPushButton(tr("Feel it"), this)),
      look_(new QPushButton(tr("Look at the frames"), this)) {
  setFocusPolicy(Qt::ClickFocus); // a box without one hands the keys on
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(8);
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(8);
  grid->setVerticalSpacing(2);
  grid->setColumnStretch(1, 1);
  for (const DemoStep& step : demoSteps()) {
    const int line = grid->rowCount();
    Row row{new QLabel(this), new QLabel(QString::fromStdString(step.about), this),
            new QLabel(this)};
    row.mark->setFixedWidth(20);
    row.mark->setAlignment(Qt::AlignTop | Qt::AlignHCenter);
    row.words->setWordWrap(true);
    row.words->setObjectName(QStringLiteral("step_") + QString::fromStdString(step.name));
    row.found->setWordWrap(true);
    row.found->setProperty("quiet", true);
    row.found->setObjectName(QStringLiteral("found_") + QString::fromStdString(step.name));
    grid->addWidget(row.mark, line, 0, Qt::AlignTop);
    grid->addWidget(row.words, line, 1);
    grid->addWidget(row.found, line + 1, 1);
    if (rows_.empty()) grid->addWidget(look_, line + 2, 1, Qt::AlignLeft);
    rows_.push_back(row);
  }
  next_->setObjectName(QStringLiteral("next_step"));
  next_->setDefault(true);
  all_->setObjectName(QStringLiteral("all_steps"));
  all_->setToolTip(tr("The steps that are left, one after another: about a minute in all"));
  feel_->setDefault(true);
  feel_->setObjectName(QStringLiteral("feel_demo"));
  feel_->setToolTip(tr("Opens the workspace that was made, to be touched and painted"));
  for (QPushButton* button : {next_, all_, feel_}) column->addWidget(button);
  column->addLayout(grid);
  look_->setObjectName(QStringLiteral("look_at_scan"));
  look_->setToolTip(tr("Opens a scan of the toy on the desk Scan: frames, markers, path"));
  look_->setMenu(new QMenu(look_));
  connect(next_, &QPushButton::clicked, this, &StepList::nextAsked);
  connect(all_, &QPushButton::clicked, this, &StepList::allAsked);
  connect(feel_, &QPushButton::clicked, this, &StepList::feelAsked);
  show(nullptr, false);
}

void StepList::offerScans(const Demo* demo) {
  look_->menu()->clear();
  if (demo == nullptr || done_ == 0) return;
  for (const DemoScan& scan : demo->scans) {
    const QString name = QString::fromStdString(scan.name);
    look_->menu()->addAction(name, this, [this, name] { emit lookAsked(name); });
  }
}

void StepList::show(const Demo* demo, bool running) {
  if (!running) done_ = demo != nullptr ? demo->seconds.size() : 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    const bool now = running && i == done_;
    row.words->setEnabled(i <= done_);
    if (running) {
      if (now) row.mark->setText(QStringLiteral("…"));
      continue;
    }
    bool holds = true;
    QString found;
    if (i < done_) {
      const std::string& name = demoSteps()[i].name;
      found = foundBy(*demo, name, holds);
      const QString counts = countsOf(*demo, name);
      if (!counts.isEmpty()) found = found.isEmpty() ? counts : counts + '\n' + found;
    }
    row.mark->setText(i >= done_ ? QString::number(i + 1)
                      : holds    ? QStringLiteral("✓")
                                 : QStringLiteral("✗"));
    row.found->setText(found);
    row.found->setVisible(!found.isEmpty());
  }
  // A button that cannot be pressed would give the keys to whatever is next.
  if (running && (next_->hasFocus() || all_->hasFocus())) setFocus();
  const bool ended = done_ == rows_.size();
  next_->setVisible(!ended);
  all_->setVisible(!ended);
  feel_->setVisible(ended);
  look_->setVisible(done_ > 0);
  look_->setEnabled(!running);
  if (!running) offerScans(demo);
  next_->setEnabled(!running);
  all_->setEnabled(!running);
  if (!running && hasFocus()) (ended ? feel_ : next_)->setFocus();
  if (!ended)
    next_->setText(done_ == 0
                       ? tr("Begin with the toy's scan")
                       : tr("Next: %1").arg(QString::fromStdString(demoSteps()[done_].name)));
  if (!ended) next_->setToolTip(QString::fromStdString(demoSteps()[done_].about));
}

} // namespace patina

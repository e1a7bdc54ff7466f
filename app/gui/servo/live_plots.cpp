#include "app/gui/servo/live_plots.h"

#include <QCheckBox>

#include "app/gui/toolkit/card.h"

namespace patina {

void EnergyMeter::add(const ToolSample& sample) {
  if (before_) {
    if (from_each_touch && before_->force.isZero(0) && !sample.force.isZero(0)) ledger = {};
    ledger.add(before_->force, sample.tip - before_->tip, 0, sample.t - before_->t);
  }
  before_ = sample;
}

ForcePlot::ForcePlot(QWidget* parent)
    : StripPlot(QStringLiteral("N"),
                {{QStringLiteral("|F|"), "text", 2.0, true}, // A distinct colour.
                 {QStringLiteral("x"), "series_x"},
                 {QStringLiteral("y"), "series_y"},
                 {QStringLiteral("z"), "series_z"}},
                0.5, parent) {
  setToolTip(tr("Force on the hand over the last five seconds"));
}

void ForcePlot::addSamples(const std::vector<ToolSample>& samples) {
  for (const ToolSample& sample : samples) {
    const Eigen::Vector3f force = sample.force.cast<float>();
    add(sample.t, {force.norm(), force[0], force[1], force[2]});
  }
}

EnergyPlot::EnergyPlot(QWidget* parent)
    : StripPlot(QStringLiteral("mJ"),
                {{QStringLiteral("E"), "series_e", 2.0}, {tr("lowest"), "series_x"}}, 1.0, parent) {
  setToolTip(
      tr("Energy absorbed by the surface. A spring returns it, friction and damping dissipate it. "
         "A clearly negative value means that the surface drives the hand: the loop is unstable."));
  auto* each = named(new QCheckBox(tr("Each touch"), this), "energy_each_touch",
                     tr("Restarts at zero with each contact"));
  connect(each, &QCheckBox::toggled, this, [this](bool on) { meter_.from_each_touch = on; });
  auto* zero = named(new QToolButton(this), "energy_reset", tr("Sets the energy to zero"));
  zero->setText(tr("Zero"));
  connect(zero, &QToolButton::clicked, this, [this] { meter_.ledger = {}; });
  addToCorner(each);
  addToCorner(zero);
}

void EnergyPlot::addSamples(const std::vector<ToolSample>& samples, std::size_t dropped) {
  if (dropped != dropped_) meter_.skip();
  dropped_ = dropped;
  for (const ToolSample& sample : samples) {
    meter_.add(sample);
    add(sample.t, {static_cast<float>(1000 * meter_.ledger.absorbed),
                   static_cast<float>(1000 * meter_.ledger.lowest_absorbed)});
  }
}

void EnergyPlot::restart() {
  meter_.skip();
  meter_.ledger = {};
  clear();
}

} // namespace patina

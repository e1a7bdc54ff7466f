#include "app/gui/servo/live_plots.h"

namespace patina {

ForcePlot::ForcePlot(QWidget* parent)
    : StripPlot(QStringLiteral("N"),
                {{QStringLiteral("|F|"), "text", 2.0, true}, // told apart by any eye
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
  setToolTip(tr("Energy that the surface has taken from the hand. A spring gives back what it "
                "took; friction and damping keep it. Well below zero the surface feeds the hand: "
                "that is what a buzz lives on."));
  auto* each = new QCheckBox(tr("Each touch"), this);
  each->setObjectName(QStringLiteral("energy_each_touch"));
  each->setToolTip(tr("Begin at zero whenever a force begins"));
  connect(each, &QCheckBox::toggled, this, [this](bool on) { meter_.from_each_touch = on; });
  auto* zero = new QToolButton(this);
  zero->setObjectName(QStringLiteral("energy_reset"));
  zero->setText(tr("Zero"));
  zero->setToolTip(tr("Count from now"));
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

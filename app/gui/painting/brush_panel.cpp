#include "app/gui/painting/brush_panel.h"

#include <algorithm>
#include <cmath>

#include <QMenu>
#include <QToolButton>

#include "app/gui/painting/color_choice.h"
#include "app/gui/painting/tool_choice.h"

namespace patina {
namespace {

QString wordsOf(std::string_view utf8) {
  return QString::fromUtf8(utf8.data(), static_cast<int>(utf8.size()));
}

QString titleOf(const Tool& tool) {
  if (tool == Tool::erase) return BrushPanel::tr("Eraser");
  const auto channel = channelOf(tool);
  return BrushPanel::tr("Brush: %1").arg(channel ? wordsOf(rowOf(*channel).tool) : captionOf(tool));
}

} // namespace

BrushPanel::BrushPanel(QWidget* parent) : QGroupBox(parent), layout_(new QVBoxLayout(this)) {
  layout_->setContentsMargins(0, 0, 0, 0);
}

void BrushPanel::show(const Brush& brush, const BrushPresets& presets) {
  brush_ = brush;
  setTitle(titleOf(brush.tool));
  rebuild(presets);
}

void BrushPanel::change() {
  curve_->setBrush(brush_);
  emit edited(brush_);
}

void BrushPanel::rebuild(const BrushPresets& presets) {
  takeAway(form_);
  form_ = new Form(this);
  connect(form_, &Form::edited, this, &BrushPanel::change);
  if (brush_.tool == Tool::color)
    addColor();
  else
    addValue(presets.extent());
  addLayers(presets);
  addSize(presets);
  addShape();
  addChoices();
  layout_->addWidget(form_);
}

void BrushPanel::addColor() {
  auto* choice = new ColorChoice(brush_.color, form_);
  connect(choice, &ColorChoice::chosen, this, [this](const ColorChoice::Color& color) {
    brush_.color = color;
    change();
  });
  form_->addWidget(choice);
}

void BrushPanel::addValue(double extent) {
  if (brush_.tool == Tool::erase) return addErased();
  const double highest = 1000 * std::max(1e-3, std::min(0.05 * extent, 0.05));
  QString caption = tr("Height; below 0 it engraves"), unit = QStringLiteral("mm");
  RowRange range{-highest, highest, highest / 50, 2};
  double per_si = 1000;
  if (const auto channel = channelOf(brush_.tool)) {
    addChannels(*channel);
    const Channel& row = rowOf(*channel);
    const ChannelDial& dial = row.dial;
    caption = wordsOf(row.dial_caption);
    unit = wordsOf(row.reading.unit);
    range = {dial.least, dial.most, dial.step, dial.decimals, dial.logarithmic};
    per_si = row.reading.per_si;
  }
  form_->addRow({"brush_value", caption, unit, range, per_si, tr("What the brush paints")},
                brush_.value);
}

// Which of the channels that share a tool.
void BrushPanel::addChannels(MaterialChannel channel) {
  std::vector<MaterialChannel> shared;
  QStringList words;
  int now = 0;
  for (const Channel& row : kChannels) {
    if (row.tool != rowOf(channel).tool) continue;
    if (row.channel == channel) now = words.size();
    shared.push_back(row.channel);
    words << captionOf(Tool::material(row.channel));
  }
  if (shared.size() == 1) return;
  const std::string name = "which_" + std::string(rowOf(channel).tool);
  form_->addChoice(
      name.c_str(), tr("Paints"), words, now,
      [this, shared](int index) {
        emit toolAsked(Tool::material(shared[static_cast<std::size_t>(index)]));
      },
      tr("Which of the values that share this tool"));
}

void BrushPanel::addErased() {
  QStringList words{captionOf(Tool::erase)};
  std::vector<std::string> names{""};
  for (const Tool& tool : kTools) {
    if (tool == Tool::erase) continue;
    words << captionOf(tool);
    names.emplace_back(name(tool));
  }
  const auto now = std::find(names.begin(), names.end(), brush_.erases) - names.begin();
  form_->addChoice(
      "erases", tr("Erases"), words, static_cast<int>(now),
      [this, names](int index) { brush_.erases = names[static_cast<std::size_t>(index)]; },
      tr("All that was painted, or one kind of it"));
}

void BrushPanel::addLayers(const BrushPresets& presets) {
  if (brush_.tool == Tool::erase) return;
  auto* box = new QToolButton(form_);
  box->setObjectName(QStringLiteral("brush_also"));
  box->setText(tr("Paints also…"));
  box->setToolTip(tr("What the same stroke lays on beside this, each as its own tool is set"));
  box->setPopupMode(QToolButton::InstantPopup);
  box->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  auto* menu = new QMenu(box);
  const auto say = [box, menu] {
    QStringList words;
    for (const QAction* action : menu->actions())
      if (action->isChecked()) words << action->text();
    box->setText(words.isEmpty() ? tr("Paints also…")
                                 : tr("Also: %1").arg(words.join(QStringLiteral(", "))));
  };
  for (const Tool& tool : kTools) {
    if (!canJoin(brush_, tool)) continue;
    QAction* action = menu->addAction(captionOf(tool));
    action->setObjectName(QStringLiteral("also_") +
                          QString::fromUtf8(std::string(name(tool)).c_str()));
    action->setCheckable(true);
    action->setChecked(layerOf(brush_, tool) != nullptr);
    const BrushLayer layer = presets.brush(tool);
    connect(action, &QAction::toggled, this, [this, layer, say](bool on) {
      std::erase_if(brush_.also, [&](const BrushLayer& l) { return l.tool == layer.tool; });
      if (on) brush_.also.push_back(layer);
      say();
      change();
    });
  }
  say();
  box->setMenu(menu);
  form_->addWidget(box);
}

void BrushPanel::addSize(const BrushPresets& presets) {
  const double most = 500 * presets.extent();
  form_->addRow({"brush_radius",
                 tr("Radius"),
                 QStringLiteral("mm"),
                 {most / 500, most, most / 100, 2, true},
                 1000,
                 tr("[ smaller, ] larger")},
                brush_.radius);
  form_->addRow({"brush_grows",
                 tr("Radius from force"),
                 QStringLiteral("mm/N"),
                 {0, most / 10, most / 500, 2},
                 1000,
                 tr("The harder the tool presses, the larger the brush; a pen's pressure is such "
                    "a force")},
                brush_.radius_per_force);
  form_->addRow({"brush_press",
                 tr("Pressing force"),
                 QStringLiteral("N"),
                 {0.1, 3, 0.1, 1},
                 1,
                 tr("How hard the mouse, or a pen at full pressure, presses the tool onto the "
                    "surface")},
                presets.press, [this](double now) { emit pressed(now); });
}

void BrushPanel::addShape() {
  form_->addChoice(
      "brush_shape", tr("Shape"), {tr("power"), tr("cone"), tr("smooth")},
      static_cast<int>(brush_.shape),
      [this](int index) { brush_.shape = static_cast<BrushShape>(index); },
      tr("1 − (d/r)^f, (1 − d/r)^f or (1 − (d/r)²)^f"));
  form_->addRow({"brush_falloff",
                 tr("Fall-off"),
                 {},
                 {0.25, 16, 0.25, 2, true},
                 1,
                 tr("{ less, } more: the exponent f of the shape")},
                brush_.falloff);
  curve_ = new BrushCurve(form_);
  curve_->setBrush(brush_);
  form_->addWidget(curve_);
}

void BrushPanel::addChoices() {
  if (brush_.tool != Tool::erase) {
    QStringList words = {tr("once a stroke"), tr("builds up"), tr("adds"), tr("smooths")};
    std::vector<StrokeMode> modes = {StrokeMode::max, StrokeMode::build_up, StrokeMode::add,
                                     StrokeMode::smooth};
    if (brush_.tool == Tool::color) {
      words.removeAt(2);
      modes.erase(modes.begin() + 2);
    }
    const auto now = std::find(modes.begin(), modes.end(), brush_.mode) - modes.begin();
    form_->addChoice(
        "brush_mode", tr("Lays on"), words, static_cast<int>(now),
        [this, modes](int index) { brush_.mode = modes[static_cast<std::size_t>(index)]; },
        tr("Once a stroke, again with every moment, added to what is there, or made even"));
  }
  form_->addChoice(
      "brush_seed", tr("Starts"), {tr("at the nearest point"), tr("under the tip")},
      static_cast<int>(brush_.seed), [this](int index) { brush_.seed = static_cast<Seed>(index); },
      tr("Under the tip: where the way from the tip goes through the surface, as in "
         "the paper; on thin parts it is the side that is touched"));
  form_->addChoice(
      "brush_symmetry", tr("Mirrored"), {tr("not"), tr("across x"), tr("across y"), tr("across z")},
      static_cast<int>(brush_.symmetry),
      [this](int index) { brush_.symmetry = static_cast<Symmetry>(index); },
      tr("The same across the middle of the object's box"));
  form_->addCheck("front_only", tr("Front faces only"),
                  tr("Leave out what looks away from the place that is touched, such as the far "
                     "side of a thin part"),
                  brush_.front_only, [this](bool on) { brush_.front_only = on; });
}

} // namespace patina

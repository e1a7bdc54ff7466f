#include "app/gui/panels/display_panel.h"

#include <tuple>

#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>

namespace patina {
namespace {

struct Box {
  Layer layer;
  const char *words, *key, *tip;
  bool needs_field = true, shown = false;
};
// In the order of the panel.
constexpr Box kBoxes[] = {
    {Layer::mesh, "Mesh", "M", "The triangles of what is open", false, true},
    {Layer::tip, "Tool and force", "T",
     "The tool where the surface holds it, the hand as a ghost, and the force on it", true, true},
    {Layer::slice, "Slice", "S",
     "A plane through the field, coloured by distance; what stands before it is cut away"},
    {Layer::iso, "Iso-surface", "I", "The surface at a distance: 0 is the object"},
    {Layer::wireframe, "Wireframe", "W", "The edges of the triangles", false},
    {Layer::scale, "Scale bar", "L",
     "A round length, of what is as far away as the middle of the picture", false, true},
    {Layer::nodes, "Nodes at the tip", "N",
     "What contact computes with: warm inside, cool outside"},
    {Layer::extent, "Field extent", "E", "The box of the grid"},
    {Layer::stability, "Stability", "K",
     "Where the surface would buzz: K*(x)/K, what the loop bears over what this place asks of it. "
     "Below 1, warm, a held tip swings up by itself."},
    {Layer::band, "Band", "B",
     "Where the offset or the magnet acts: a shell, and a tint of the slice", true, true}};

} // namespace

DisplayPanel::DisplayPanel(QWidget* parent)
    : QGroupBox(tr("Show"), parent), clip_(new QCheckBox(tr("Clip plane"), this)),
      clip_card_(new QWidget(this)), slice_card_(new QWidget(this)),
      axis_(new QComboBox(slice_card_)),
      position_(
          new ValueRow(tr("Slice position"), QStringLiteral("%"), {0, 100, 1, 1}, slice_card_)),
      stability_note_(new QLabel(this)), iso_card_(new QWidget(this)) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  auto* grid = new QGridLayout;
  grid->setVerticalSpacing(4);
  column->addLayout(grid);
  int index = 0;
  for (const Box& row : kBoxes) {
    const Layer layer = row.layer;
    auto* box = new QCheckBox(tr(row.words), this);
    box->setObjectName(QString::fromUtf8(name(layer).data(), static_cast<int>(name(layer).size())));
    box->setToolTip(
        QStringLiteral("<b>%1</b> (%2)<br>%3<br>In commands: <i>--show %4</i>")
            .arg(tr(row.words), QString::fromUtf8(row.key), tr(row.tip), box->objectName()));
    box->setChecked(row.shown);
    connect(box, &QCheckBox::toggled, this, [this, layer](bool on) {
      arrange();
      emit layerToggled(layer, on);
    });
    grid->addWidget(box, index / 2, index % 2);
    boxes_[layer] = box;
    ++index;
  }

  grid->addWidget(clip_, index / 2, index % 2);
  addClip(*column);

  stability_note_->setObjectName(QStringLiteral("stability_words"));
  stability_note_->setProperty("quiet", true);
  stability_note_->setWordWrap(true);
  stability_note_->hide();
  column->addWidget(stability_note_);

  auto* slice_layout = new QGridLayout(slice_card_);
  slice_layout->setContentsMargins(0, 4, 0, 0);
  auto* label = new QLabel(tr("Slice across"), slice_card_);
  label->setProperty("quiet", true);
  slice_layout->addWidget(label, 0, 0);
  axis_->addItems({QStringLiteral("x"), QStringLiteral("y"), QStringLiteral("z")});
  axis_->setCurrentIndex(slice_.axis);
  axis_->setToolTip(tr("The axis that the slice is across"));
  position_->setToolTip(tr("Where the slice is, from one end of the field to the other"));
  slice_layout->addWidget(axis_, 0, 1);
  slice_layout->addWidget(position_, 1, 0, 1, 2);
  position_->setObjectName(QStringLiteral("slice_position"));
  position_->setValue(100 * slice_.position);
  column->addWidget(slice_card_);
  connect(axis_, qOverload<int>(&QComboBox::currentIndexChanged), this, [this](int axis) {
    slice_.axis = axis;
    emit sliceMoved(slice_);
  });
  connect(position_, &ValueRow::edited, this, [this](double percent) {
    slice_.position = percent / 100;
    emit sliceMoved(slice_);
  });
  (new QVBoxLayout(iso_card_))->setContentsMargins(0, 4, 0, 0);
  column->addWidget(iso_card_);
  setField(nullptr);
}

void DisplayPanel::addClip(QLayout& column) {
  clip_->setObjectName(QStringLiteral("clip"));
  clip_->setToolTip(
      tr("<b>Clip plane</b> (Shift + S)<br>Cuts away what lies ahead of a plane at any "
         "angle. Its ball shifts it, the arrow's head tilts it."));
  connect(clip_, &QCheckBox::toggled, this, &DisplayPanel::arrange);
  auto* line = new QHBoxLayout(clip_card_);
  line->setContentsMargins(0, 4, 0, 0);
  line->setSpacing(4);
  auto* label = new QLabel(tr("Clip across"), clip_card_);
  label->setProperty("quiet", true);
  line->addWidget(label);
  const std::tuple<ClipTurn, const char*, QString, QString> turns[] = {
      {ClipTurn::x, "clip_x", tr("x"), tr("Across the x axis, from the viewer's side")},
      {ClipTurn::y, "clip_y", tr("y"), tr("Across the y axis, from the viewer's side")},
      {ClipTurn::z, "clip_z", tr("z"), tr("Across the z axis, from the viewer's side")},
      {ClipTurn::viewer, "clip_viewer", tr("View"), tr("Facing you")},
      {ClipTurn::flip, "clip_flip", tr("Flip"), tr("The other half is cut away")}};
  for (const auto& [turn, name, words, tip] : turns) {
    auto* button = new QToolButton(clip_card_);
    button->setObjectName(QString::fromUtf8(name));
    button->setText(words);
    button->setToolTip(tip);
    connect(button, &QToolButton::clicked, this, [this, turn = turn] { emit clipTurned(turn); });
    line->addWidget(button);
  }
  line->addStretch(1);
  column.addWidget(clip_card_);
}

void DisplayPanel::setField(const SurfaceField* field) {
  has_field_ = field != nullptr;
  const double kept = iso_ != nullptr ? iso_->value() : 0;
  delete iso_;
  iso_ = nullptr;
  if (has_field_) {
    const double reach = 1000 * field->grid.voxel * (field->band - 1);
    iso_ = new ValueRow(tr("Iso-surface at"), QStringLiteral("mm"),
                        {-reach, reach, reach / 20, reach < 1 ? 3 : 2}, iso_card_);
    iso_->setObjectName(QStringLiteral("iso_value"));
    iso_->setValue(kept);
    iso_->setToolTip(tr("Its distance from the surface; above 0 it lies outside"));
    iso_card_->layout()->addWidget(iso_);
    connect(iso_, &ValueRow::edited, this, [this](double mm) { emit isoMoved(mm / 1000); });
  }
  arrange();
}

void DisplayPanel::arrange() {
  for (const Box& box : kBoxes)
    boxes_[box.layer]->setVisible((has_field_ || !box.needs_field) &&
                                  (has_band_ || box.layer != Layer::band));
  clip_card_->setVisible(clip_->isChecked());
  slice_card_->setVisible(has_field_ && shown(Layer::slice));
  iso_card_->setVisible(has_field_ && shown(Layer::iso));
}

void DisplayPanel::setBand(bool has_band) {
  has_band_ = has_band;
  arrange();
}

void DisplayPanel::setStabilityNote(const QString& words) {
  stability_note_->setText(words);
  stability_note_->setVisible(!words.isEmpty());
}

void DisplayPanel::setShown(Layer layer, bool on) {
  const auto box = boxes_.find(layer);
  if (box != boxes_.end()) box->second->setChecked(on);
}

QString DisplayPanel::caption(Layer layer) const {
  return boxes_.at(layer)->text();
}

bool DisplayPanel::shown(Layer layer) const {
  const auto box = boxes_.find(layer);
  return box != boxes_.end() && box->second->isChecked();
}

} // namespace patina

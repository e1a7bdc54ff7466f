#include "app/gui/panels/display_panel.h"

#include <tuple>

#include <QGridLayout>
#include <QHBoxLayout>
#include <QVBoxLayout>

#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "visualization/layers/slice_layer.h"

namespace patina {
namespace {

struct Box {
  Layer layer;
  const char *words, *key, *tip;
  bool needs_field = true, shown = false;
};
// In the order of the panel.
constexpr Box kBoxes[] = {
    {Layer::mesh, "Mesh", "M", "The triangles of the open scene", false, true},
    {Layer::tip, "Tool and force", "T",
     "The tool at the contact point, the hand position as a ghost, and the force on it", true,
     true},
    {Layer::slice, "Slice", "S",
     "A plane through the field, coloured by distance. The part in front of it is hidden."},
    {Layer::iso, "Iso-surface", "I", "The surface at a distance: 0 is the object"},
    {Layer::wireframe, "Wireframe", "W", "The edges of the triangles", false},
    {Layer::scale, "Scale bar", "L", "A length at the distance of the picture's centre", false,
     true},
    {Layer::nodes, "Nodes at the tip", "N",
     "The field nodes used for contact: warm inside, cool outside"},
    {Layer::extent, "Field extent", "E", "The box of the grid"},
    {Layer::stability, "Stability", "K",
     "Where the haptic loop would be unstable: K*(x)/K, the largest stable stiffness over the "
     "actual one. Below 1 (warm), a held tip starts to vibrate."},
    {Layer::band, "Band", "B",
     "Range of the offset or the magnet: a shell, and a tint of the slice", true, true}};

} // namespace

DisplayPanel::DisplayPanel(QWidget* parent)
    : QGroupBox(tr("Show"), parent), clip_(new QCheckBox(tr("Clip plane"), this)),
      clip_card_(new QWidget(this)), slice_card_(new QWidget(this)),
      direction_(new QLineEdit(slice_card_)), iso_card_(new QWidget(this)) {
  auto* column = layoutIn<QVBoxLayout>(this);
  auto* grid = new QGridLayout;
  grid->setVerticalSpacing(4);
  column->addLayout(grid);
  int index = 0;
  for (const Box& row : kBoxes) {
    const Layer layer = row.layer;
    auto* box = new QCheckBox(tr(row.words), this);
    box->setObjectName(shownText(name(layer)));
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

  stability_note_ = addNote(column, "stability_words");
  addSlice(*column);
  (new QVBoxLayout(iso_card_))->setContentsMargins(0, 4, 0, 0);
  column->addWidget(iso_card_);
  setField(nullptr);
}

void DisplayPanel::addClip(QLayout& column) {
  named(clip_, "clip",
        tr("<b>Clip plane</b> (Shift + S)<br>Hides the part in front of a plane. Its ball shifts "
           "the plane, the head of its arrow tilts it."));
  connect(clip_, &QCheckBox::toggled, this, &DisplayPanel::arrange);
  auto* line = new QHBoxLayout(clip_card_);
  line->setContentsMargins(0, 4, 0, 0);
  line->setSpacing(4);
  line->addWidget(quietLabel(tr("Clip across")));
  const std::tuple<ClipTurn, const char*, QString, QString> turns[] = {
      {ClipTurn::x, "clip_x", tr("x"), tr("Normal to the x axis, seen from the viewer's side")},
      {ClipTurn::y, "clip_y", tr("y"), tr("Normal to the y axis, seen from the viewer's side")},
      {ClipTurn::z, "clip_z", tr("z"), tr("Normal to the z axis, seen from the viewer's side")},
      {ClipTurn::viewer, "clip_viewer", tr("View"), tr("Facing you")},
      {ClipTurn::flip, "clip_flip", tr("Flip"), tr("Hides the other half")}};
  for (const auto& [turn, name, words, tip] : turns)
    addButton<QToolButton>(line, name, words, tip, this,
                           [this, turn = turn] { emit clipTurned(turn); });
  line->addStretch(1);
  column.addWidget(clip_card_);
}

void DisplayPanel::addSlice(QLayout& column) {
  auto* card = new QVBoxLayout(slice_card_);
  card->setContentsMargins(0, 4, 0, 0);
  card->setSpacing(4);
  auto* line = new QHBoxLayout;
  line->setSpacing(4);
  line->addWidget(quietLabel(tr("Slice across")));
  const std::tuple<const char*, QString, QString> axes[] = {
      {"slice_x", tr("x"), tr("Normal to the x axis")},
      {"slice_y", tr("y"), tr("Normal to the y axis")},
      {"slice_z", tr("z"), tr("Normal to the z axis")}};
  for (const auto& [name, words, tip] : axes)
    addButton<QToolButton>(line, name, words, tip, this, [this, axis = words.toStdString()] {
      moveSlice({parseSlice(axis).normal, {}});
    });
  addButton<QToolButton>(line, "slice_viewer", tr("View"), tr("Facing you"), this,
                         &DisplayPanel::sliceFacing);
  line->addStretch(1);
  card->addLayout(line);
  auto* angle = new QHBoxLayout;
  angle->setSpacing(4);
  angle->addWidget(quietLabel(tr("Direction")));
  angle->addWidget(named(direction_, "slice_direction",
                         tr("Direction normal to the slice: x, −y, or three numbers as 0, 1, 1")));
  card->addLayout(angle);
  connect(direction_, &QLineEdit::editingFinished, this, [this] {
    try {
      const Vec3 normal =
          parseSlice(direction_->text().replace(QStringLiteral("−"), "-").toStdString()).normal;
      if (directionText(normal) != directionText(slice_.normal)) moveSlice({normal, {}});
    } catch (const Error&) { // The text returns to the direction that is shown.
    }
    showSlice();
  });
  auto* actions = new QHBoxLayout;
  actions->setSpacing(4);
  auto* handle = addButton<QToolButton>(
      actions, "slice_handle", tr("Handle"),
      tr("Its ball shifts the slice, the head of its arrow tilts it"), this, [this] {
        emit sliceHandled(slice_card_->findChild<QToolButton*>("slice_handle")->isChecked());
      });
  line_profile_ = addButton<QToolButton>(
      actions, "line_profile", tr("Line profile"),
      tr("Then drag a line in the picture: the distance along it as a plot and as a table"));
  for (QToolButton* button : {handle, line_profile_}) button->setCheckable(true);
  addButton<QToolButton>(
      actions, "slice_histogram", tr("Histogram"),
      tr("How often each distance occurs on the slice, as a plot and as a table"), this,
      &DisplayPanel::histogramRequested);
  actions->addStretch(1);
  card->addLayout(actions);
  column.addWidget(slice_card_);
}

void DisplayPanel::moveSlice(const SlicePosition& place) {
  slice_ = place;
  showSlice();
  emit sliceMoved(slice_);
}

void DisplayPanel::setSlice(const SlicePosition& place) {
  slice_ = place;
  showSlice();
}

void DisplayPanel::showSlice() {
  direction_->setText(shownText(directionText(slice_.normal)));
  const auto range = grid_ ? std::optional(rangeOf(*grid_, slice_.normal)) : std::nullopt;
  // The row that reports a change must stay.
  if (range != position_range_) makePositionRow(range);
  if (position_ != nullptr) position_->setValue(1000 * *within(*grid_, slice_).position);
}

void DisplayPanel::makePositionRow(const std::optional<ValueRange>& range) {
  position_range_ = range;
  takeAway(position_);
  position_ = nullptr;
  if (!range) return;
  const double low = 1000 * range->low, high = 1000 * range->high;
  position_ = new ValueRow(tr("Slice position"), QStringLiteral("mm"),
                           {low, high, (high - low) / 100, high - low < 5 ? 3 : 2}, slice_card_);
  named(position_, "slice_position",
        tr("Position of the slice along its direction, in world coordinates"));
  static_cast<QVBoxLayout*>(slice_card_->layout())->insertWidget(2, position_);
  connect(position_, &ValueRow::edited, this, [this](double mm) {
    slice_.position = mm / 1000;
    emit sliceMoved(slice_);
  });
}

void DisplayPanel::setField(const SurfaceField* field) {
  grid_ = field != nullptr ? std::optional(field->grid) : std::nullopt;
  const double kept = iso_ != nullptr ? iso_->value() : 0;
  delete iso_;
  iso_ = nullptr;
  if (grid_) {
    const double reach = 1000 * field->grid.voxel * (field->band - 1);
    iso_ = new ValueRow(tr("Iso-surface at"), QStringLiteral("mm"),
                        {-reach, reach, reach / 20, reach < 1 ? 3 : 2}, iso_card_);
    named(iso_, "iso_value", tr("Distance from the surface, positive outside"));
    iso_->setValue(kept);
    iso_card_->layout()->addWidget(iso_);
    connect(iso_, &ValueRow::edited, this, [this](double mm) { emit isoMoved(mm / 1000); });
  }
  showSlice();
  arrange();
}

void DisplayPanel::arrange() {
  for (const Box& box : kBoxes)
    boxes_[box.layer]->setVisible((grid_ || !box.needs_field) &&
                                  (has_band_ || box.layer != Layer::band));
  clip_card_->setVisible(clip_->isChecked());
  slice_card_->setVisible(grid_ && shown(Layer::slice));
  iso_card_->setVisible(grid_ && shown(Layer::iso));
}

void DisplayPanel::setShown(Layer layer, bool on) {
  const auto box = boxes_.find(layer);
  if (box != boxes_.end()) box->second->setChecked(on);
}

bool DisplayPanel::shown(Layer layer) const {
  const auto box = boxes_.find(layer);
  return box != boxes_.end() && box->second->isChecked();
}

} // namespace patina

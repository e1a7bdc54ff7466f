#include "app/gui/panels/display_panel.h"

#include <algorithm>
#include <iterator>
#include <tuple>

#include <QHBoxLayout>
#include <QScrollBar>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "visualization/layers/slice_layer.h"

namespace patina {
namespace {

struct Row {
  const char *thing, *words, *key, *tip;
  bool needs_field = true, shown = false;
};
// The order is that of the list.
constexpr Row kRows[] = {
    {"mesh", "Mesh", "M", "The triangles of the open scene", false, true},
    {"paint", "Paint", "", "The paint of the objects, of one kind", false, true},
    {"tip", "Tool and force", "T",
     "The tool at the contact point, the hand position as a ghost, and the force on it", true,
     true},
    {"slice", "Slice", "S",
     "A plane through the field, coloured by distance. The part in front of it is hidden."},
    {"slice2", "Slice 2", "", "Another slice: the check mark adds or removes it"},
    {"slice3", "Slice 3", "", "Another slice: the check mark adds or removes it"},
    {"iso", "Iso-surface", "I", "The surface at a distance: 0 is the object"},
    {"clip", "Clip plane", "Shift + S",
     "Hides the part in front of a plane. Its ball shifts the plane, the head of its arrow tilts "
     "it.",
     false},
    {"wireframe", "Wireframe", "W", "The edges of the triangles", false},
    {"nodes", "Nodes at the tip", "N",
     "The field nodes used for contact: warm inside, cool outside"},
    {"extent", "Field extent", "E", "The box of the grid"},
    {"stability", "Stability", "K",
     "Where the haptic loop would be unstable: K*(x)/K, the largest stable stiffness over the "
     "actual one. Below 1 (warm), a held tip starts to vibrate."},
    {"band", "Band", "B", "Range of the offset or the magnet: a shell, and a tint of the slice",
     true, true},
    {"scale", "Scale bar", "L", "A length at the distance of the picture's centre", false, true}};

QString tipOf(const Row& row) {
  const std::vector<Layer>& layers = allLayers();
  const bool is_layer = std::any_of(layers.begin(), layers.end(),
                                    [&](Layer layer) { return name(layer) == row.thing; });
  QString tip = QStringLiteral("<b>%1</b>").arg(tr(row.words));
  if (*row.key != '\0') tip += QStringLiteral(" (%1)").arg(QString::fromUtf8(row.key));
  tip += QStringLiteral("<br>") + tr(row.tip);
  return is_layer ? tip + tr("<br>In commands: <i>--show %1</i>").arg(row.thing) : tip;
}

// Number of a slice's row from 0; nullopt: another thing.
std::optional<std::size_t> sliceOf(const std::string& thing) {
  if (!thing.starts_with("slice")) return std::nullopt;
  return thing == "slice" ? 0 : static_cast<std::size_t>(thing.back() - '1');
}

// A slice that is added is normal to an axis that no other one has at first.
SlicePosition newSlice(std::size_t index) {
  return {index == 1 ? Vec3::UnitX() : index == 2 ? Vec3::UnitZ() : Vec3::UnitY(), {}};
}

} // namespace

DisplayPanel::DisplayPanel(QWidget* parent) : QGroupBox(tr("Show"), parent) {
  auto* column = layoutIn<QVBoxLayout>(this);
  list_ = addList(column, "layers",
                  tr("Checked things are shown; the values of the selected one are below and in "
                     "the card Colours"));
  list_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff); // It is as high as its rows.
  for (const Row& row : kRows) {
    auto* item = new QListWidgetItem(tr(row.words), list_);
    item->setData(Qt::UserRole, QString::fromUtf8(row.thing));
    item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable | Qt::ItemIsUserCheckable);
    item->setCheckState(row.shown ? Qt::Checked : Qt::Unchecked);
    item->setToolTip(tipOf(row));
    rows_[row.thing] = item;
  }
  list_->setCurrentRow(0);
  connect(list_, &QListWidget::itemChanged, this, [this](QListWidgetItem* item) {
    const bool on = item->checkState() == Qt::Checked;
    const std::string thing = item->data(Qt::UserRole).toString().toStdString();
    const std::size_t further = sliceOf(thing).value_or(0);
    if (further > 0) slices_[further] = on ? std::optional(newSlice(further)) : std::nullopt;
    if (on) list_->setCurrentItem(item); // Its values come with it.
    arrange();
    further > 0 ? emit slicesChanged() : emit shownChanged(thing, on);
  });
  connect(list_, &QListWidget::currentItemChanged, this, [this] {
    arrange();
    emit selectionChanged();
  });
  addClip();
  addSlice();
  stability_note_ = addNote(addCard("stability"), "stability_words");
  addCard("iso");
  setField(nullptr);
}

QVBoxLayout* DisplayPanel::addCard(const char* thing) {
  auto* card = new QWidget(this);
  auto* column = layoutIn<QVBoxLayout>(card, 4);
  addValues(thing, card);
  return column;
}

void DisplayPanel::addValues(const std::string& thing, QWidget* values) {
  values_[thing] = values;
  layout()->addWidget(values);
  arrange();
}

void DisplayPanel::addClip() {
  auto* line = new QHBoxLayout;
  addCard("clip")->addLayout(line);
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
}

void DisplayPanel::addSlice() {
  auto* card = addCard("slice");
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
  direction_ = named(new QLineEdit, "slice_direction",
                     tr("Direction normal to the slice: x, −y, or three numbers as 0, 1, 1"));
  angle->addWidget(direction_);
  card->addLayout(angle);
  connect(direction_, &QLineEdit::editingFinished, this, [this] {
    try {
      const Vec3 normal =
          parseSlice(direction_->text().replace(QStringLiteral("−"), "-").toStdString()).normal;
      if (directionText(normal) != directionText(place().normal)) moveSlice({normal, {}});
    } catch (const Error&) { // The text returns to the direction that is shown.
    }
    showSlice();
  });
  auto* actions = new QHBoxLayout;
  actions->setSpacing(4);
  auto* handle = addButton<QToolButton>(
      actions, "slice_handle", tr("Handle"),
      tr("Its ball shifts the slice, the head of its arrow tilts it"), this,
      [this] { emit sliceHandled(findChild<QToolButton*>("slice_handle")->isChecked()); });
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
}

void DisplayPanel::moveSlice(const SlicePosition& place) {
  slices_[slice_] = place;
  showSlice();
  emit slicesChanged();
}

void DisplayPanel::setSlices(const Slices& slices) {
  slices_ = slices;
  const QSignalBlocker quiet(list_);
  for (std::size_t i = 1; i < kMaxSlices; ++i)
    rows_.at("slice" + std::to_string(i + 1))
        ->setCheckState(slices[i] ? Qt::Checked : Qt::Unchecked);
  arrange();
  showSlice();
}

void DisplayPanel::showSlice() {
  direction_->setText(shownText(directionText(place().normal)));
  const auto range = grid_ ? std::optional(rangeOf(*grid_, place().normal)) : std::nullopt;
  // The row that reports a change must stay.
  if (range != position_range_) makePositionRow(range);
  if (position_ != nullptr) position_->setValue(1000 * *within(*grid_, place()).position);
}

void DisplayPanel::makePositionRow(const std::optional<ValueRange>& range) {
  position_range_ = range;
  takeAway(position_);
  position_ = nullptr;
  if (!range) return;
  const double low = 1000 * range->low, high = 1000 * range->high;
  position_ =
      new ValueRow(tr("Slice position"), QStringLiteral("mm"),
                   {low, high, (high - low) / 100, high - low < 5 ? 3 : 2}, values_["slice"]);
  named(position_, "slice_position",
        tr("Position of the slice along its direction, in world coordinates"));
  static_cast<QVBoxLayout*>(values_["slice"]->layout())->insertWidget(2, position_);
  connect(position_, &ValueRow::edited, this, [this](double mm) {
    slices_[slice_] = SlicePosition{place().normal, mm / 1000};
    emit slicesChanged();
  });
}

void DisplayPanel::setField(const SurfaceField* field) {
  grid_ = field != nullptr ? std::optional(field->grid) : std::nullopt;
  const double reach = field != nullptr ? field->grid.voxel * (field->band - 1) : 0;
  if (std::exchange(iso_reach_, reach) != reach && reach > 0) {
    const double kept = iso_ != nullptr ? iso_->value() : 0, mm = 1000 * reach;
    takeAway(iso_);
    iso_ = new ValueRow(tr("Iso-surface at"), QStringLiteral("mm"),
                        {-mm, mm, mm / 20, mm < 1 ? 3 : 2}, values_["iso"]);
    named(iso_, "iso_value", tr("Distance from the surface, positive outside"));
    iso_->setValue(kept);
    values_["iso"]->layout()->addWidget(iso_);
    connect(iso_, &ValueRow::edited, this, [this](double now) { emit isoMoved(now / 1000); });
  }
  showSlice();
  arrange();
}

void DisplayPanel::setPaint(bool has_paint) {
  const bool came = has_paint && !paint_there_;
  setThere(paint_there_, has_paint);
  if (came) select("paint");
}

void DisplayPanel::arrange() {
  int high = 2 * list_->frameWidth();
  for (const Row& row : kRows) {
    QListWidgetItem* item = rows_[row.thing];
    const std::string thing = row.thing;
    item->setHidden((row.needs_field && !grid_) || (thing == "band" && !band_there_) ||
                    (thing == "paint" && !paint_there_) ||
                    (sliceOf(thing).value_or(0) > 0 && !isShown("slice")));
    if (!item->isHidden()) high += list_->sizeHintForRow(list_->row(item));
  }
  if (list_->currentItem()->isHidden()) list_->setCurrentRow(0);
  list_->setFixedHeight(high);
  const std::size_t slice_before = slice_;
  const auto slice = sliceOf(selected());
  if (slice && slices_[*slice]) slice_ = *slice;
  if (!slices_[slice_]) slice_ = 0;
  for (const auto& [thing, values] : values_) {
    values->setVisible(thing == (slice ? "slice" : selected()) && !rows_[thing]->isHidden());
    values->setEnabled(isShown(selected()));
  }
  if (slice_ != slice_before) showSlice(); // Otherwise what is being typed stays.
}

void DisplayPanel::setShown(const std::string& thing, bool on) {
  if (const auto row = rows_.find(thing); row != rows_.end())
    row->second->setCheckState(on ? Qt::Checked : Qt::Unchecked);
}

bool DisplayPanel::isShown(const std::string& thing) const {
  const auto row = rows_.find(thing);
  return row != rows_.end() && row->second->checkState() == Qt::Checked;
}

void DisplayPanel::select(const std::string& thing) {
  if (const auto row = rows_.find(thing); row != rows_.end() && !row->second->isHidden())
    list_->setCurrentItem(row->second);
}

std::string DisplayPanel::selected() const {
  return list_->currentItem()->data(Qt::UserRole).toString().toStdString();
}

} // namespace patina

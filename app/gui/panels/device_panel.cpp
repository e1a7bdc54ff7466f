#include "app/gui/panels/device_panel.h"

#include <cmath>
#include <utility>

#include <QDoubleSpinBox>
#include <QSignalBlocker>

#include "app/gui/panels/value_row.h"
#include "haptics/devices/device_catalog.h"

namespace patina {
namespace {

// In the order of the list that a person chooses from.
const std::optional<Stabilisers> kStabilisers[] = {
    std::nullopt, Stabilisers{false, false}, Stabilisers{true, false}, Stabilisers{false, true},
    Stabilisers{true, true}};

struct Number {
  const char* name;
  QString caption, tip, unit;
  double per_unit; // SI
  double low, high, step;
  int decimals;
  double (*get)(const DeviceModel&);
  void (*set)(DeviceModel&, double);
};

std::vector<Number> numbers() {
  const auto tr = [](const char* words) { return DevicePanel::tr(words); };
  return {{"device_mass", tr("Mass"), tr("Of the part that a hand moves"), QStringLiteral("g"),
           1e-3, 1, 5000, 10, 0, [](const DeviceModel& m) { return m.mass; },
           [](DeviceModel& m, double v) { m.mass = v; }},
          {"device_damping", tr("Damping"), tr("Of the device itself, against its speed"),
           QStringLiteral("N s/m"), 1, 0, 100, 0.1, 2,
           [](const DeviceModel& m) { return m.damping; },
           [](DeviceModel& m, double v) { m.damping = v; }},
          {"device_coulomb", tr("Dry friction"), tr("Of the device itself, whatever its speed"),
           QStringLiteral("N"), 1, 0, 10, 0.05, 2, [](const DeviceModel& m) { return m.coulomb; },
           [](DeviceModel& m, double v) { m.coulomb = v; }},
          {"device_encoder", tr("Encoder step"), tr("The smallest step that it reports"),
           QStringLiteral("µm"), 1e-6, 0, 1000, 5, 1,
           [](const DeviceModel& m) { return m.encoder_step; },
           [](DeviceModel& m, double v) { m.encoder_step = v; }},
          {"device_rate", tr("Rate"), tr("How often a second it is served"), QStringLiteral("Hz"),
           1, 100, 10000, 100, 0, [](const DeviceModel& m) { return m.rate; },
           [](DeviceModel& m, double v) { m.rate = v; }},
          {"device_delay", tr("Delay"), tr("How many samples late a force acts"), tr("samples"), 1,
           0, 20, 1, 0, [](const DeviceModel& m) { return static_cast<double>(m.delay); },
           [](DeviceModel& m, double v) { m.delay = static_cast<int>(std::lround(v)); }}};
}

QString newtonsPerMetre(double value) {
  return QStringLiteral("%1 N/m").arg(value, 0, value < 1e5 ? 'f' : 'g', value < 1e5 ? 0 : 3);
}

QString wordsFor(const StabiliserPlan& plan) {
  QString words;
  if (plan.predicted_limit)
    words = DevicePanel::tr("A plain wall is stable up to %1 on this device.")
                .arg(newtonsPerMetre(*plan.predicted_limit));
  if (plan.coupling)
    words += DevicePanel::tr(" Coupling: %1, %2 N s/m.")
                 .arg(newtonsPerMetre(plan.coupling->stiffness))
                 .arg(plan.coupling->damping, 0, 'g', 2);
  if (plan.lateral)
    words += DevicePanel::tr(" Along the texture: %1, %2 N s/m.")
                 .arg(newtonsPerMetre(plan.lateral->stiffness))
                 .arg(plan.lateral->damping, 0, 'g', 2);
  return words.trimmed();
}

} // namespace

DeviceChoice deviceChoice(const Scene& scene) {
  return {scene.device, scene.device_model, scene.stabilisers};
}

DevicePanel::DevicePanel(QWidget* parent)
    : QGroupBox(tr("Device"), parent), device_(new QComboBox(this)),
      stabiliser_(new QComboBox(this)), layout_(new QVBoxLayout(this)), note_(new QLabel(this)),
      attached_(new AttachedDevices(this)) {
  layout_->setContentsMargins(0, 0, 0, 0);
  layout_->setSpacing(6);
  auto* grid = new QGridLayout;
  grid->setColumnStretch(1, 1);
  const auto caption = [&](const QString& words, int row) {
    auto* label = new QLabel(words, this);
    label->setProperty("quiet", true);
    grid->addWidget(label, row, 0);
  };
  caption(tr("Felt with"), 0);
  device_->setObjectName(QStringLiteral("device"));
  QStringList notes;
  for (const DeviceEntry& entry : deviceCatalog()) {
    if (!entry.in_scenes) continue;
    device_->addItem(tr(entry.caption), QString::fromUtf8(entry.name));
    notes << tr(entry.caption) + QStringLiteral(": ") + tr(entry.note);
  }
  device_->setToolTip(notes.join(QLatin1Char('\n')));
  grid->addWidget(device_, 0, 1);
  caption(tr("Stabiliser"), 1);
  stabiliser_->setObjectName(QStringLiteral("stabiliser"));
  stabiliser_->addItems(
      {tr("Automatic"), tr("None"), tr("Coupling"), tr("Passivity"), tr("Coupling and passivity")});
  stabiliser_->setToolTip(
      tr("Coupling: a spring and damper between tip and contact point, stable for any stiffness, "
         "felt as a softer surface. Passivity: brakes when the surface has given more energy than "
         "it took. Automatic: chosen from the device's numbers, nothing where none is needed."));
  grid->addWidget(stabiliser_, 1, 1);
  layout_->addLayout(grid);
  note_->setObjectName(QStringLiteral("stability_note"));
  note_->setProperty("quiet", true);
  note_->setWordWrap(true);
  note_->hide();
  layout_->addWidget(note_);
  layout_->addWidget(attached_);
  connect(attached_, &AttachedDevices::pluginsFound, this,
          [this](const std::vector<PluginFound>& plugins) {
            for (const PluginFound& plugin : plugins)
              if (plugin.problem.empty())
                addDevice(QString::fromStdString(plugin.caption), "plugin:" + plugin.name);
          });
  connect(attached_, &AttachedDevices::useAsked, this, [this](const std::string& device) {
    device_->setCurrentIndex(device_->findData(QString::fromStdString(device)));
  });
  connect(device_, qOverload<int>(&QComboBox::currentIndexChanged), this, [this](int index) {
    choice_.device = device_->itemData(index).toString().toStdString();
    rebuild();
    emit edited();
  });
  connect(stabiliser_, qOverload<int>(&QComboBox::currentIndexChanged), this, [this](int index) {
    choice_.stabilisers = kStabilisers[index];
    emit edited();
  });
}

void DevicePanel::setValues(const DeviceChoice& choice) {
  choice_ = choice;
  const QSignalBlocker quiet(device_), quiet_too(stabiliser_);
  if (isPlugin(choice.device)) addDevice(QString::fromStdString(choice.device), choice.device);
  device_->setCurrentIndex(device_->findData(QString::fromStdString(choice.device)));
  for (int i = 0; i < 5; ++i)
    if (kStabilisers[i] == choice.stabilisers) stabiliser_->setCurrentIndex(i);
  rebuild();
}

void DevicePanel::addDevice(const QString& caption, const std::string& device) {
  const QString name = QString::fromStdString(device);
  const QSignalBlocker quiet(device_);
  if (device_->findData(name) < 0) device_->addItem(caption, name);
}

void DevicePanel::showPlan(const StabiliserPlan& plan) {
  const QString words = wordsFor(plan);
  note_->setText(words);
  note_->setVisible(!words.isEmpty());
}

void DevicePanel::rebuild() {
  takeAway(std::exchange(numbers_, nullptr));
  if (!choice_.model && !deviceNamed(choice_.device).takes_numbers) return;
  numbers_ = new QWidget(this);
  auto* column = new QVBoxLayout(numbers_);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  if (choice_.model) addNumbers(column);
  auto* button = new QToolButton(numbers_);
  button->setObjectName(QStringLiteral("device_numbers"));
  button->setText(choice_.model ? tr("✕ Forget the numbers") : tr("+ Device numbers"));
  button->setToolTip(tr("Mass, damping, encoder, rate and delay say how stiff a surface may be"));
  connect(button, &QToolButton::clicked, this, [this] {
    if (choice_.model)
      choice_.model.reset();
    else
      choice_.model.emplace();
    rebuild();
    emit edited();
  });
  column->addWidget(button);
  layout_->insertWidget(1, numbers_);
}

void DevicePanel::addNumbers(QVBoxLayout* column) {
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(8);
  grid->setVerticalSpacing(2);
  int index = 0;
  for (const Number& number : numbers()) {
    auto* label = new QLabel(number.caption, numbers_);
    label->setProperty("quiet", true);
    auto* box = new QDoubleSpinBox(numbers_);
    box->setObjectName(QString::fromUtf8(number.name));
    box->setAccessibleName(number.caption);
    box->setToolTip(number.tip);
    box->setDecimals(number.decimals);
    box->setRange(number.low, number.high);
    box->setSingleStep(number.step);
    box->setSuffix(QStringLiteral(" ") + number.unit);
    box->setKeyboardTracking(false);
    box->setValue(number.get(*choice_.model) / number.per_unit);
    connect(box, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
            [this, set = number.set, per_unit = number.per_unit](double value) {
              set(*choice_.model, per_unit * value);
              emit edited();
            });
    const int row = 2 * (index / 2), side = index % 2;
    grid->addWidget(label, row, side);
    grid->addWidget(box, row + 1, side);
    ++index;
  }
  column->addLayout(grid);
}

} // namespace patina

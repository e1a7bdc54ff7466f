#include "app/gui/panels/device_panel.h"

#include <cmath>
#include <utility>

#include <QApplication>
#include <QClipboard>
#include <QHBoxLayout>
#include <QProcess>
#include <QSignalBlocker>
#include <QStandardPaths>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/value_row.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "core/loaded_library.h"
#include "haptics/catalog/device_catalog.h"

namespace patina {
namespace {

QString buttonFor(Remedy remedy) {
  switch (remedy) {
  case Remedy::use:
    return tr("Use it");
  case Remedy::allow:
    return tr("Allow…");
  case Remedy::look_again:
    return tr("Look again");
  case Remedy::none:
    break;
  }
  return {};
}

AttachedRow rowFor(const UsbCheck& check) {
  const UsbDevice& device = check.device;
  AttachedRow row{shownText(device.name + ": " + stateText(check)), shownText(device.name)};
  if (check.refusal) {
    row.remedy = check.refusal == UsbAccessError::permission ? Remedy::allow : Remedy::look_again;
    row.tip = shownText(usbAdvice(*check.refusal, device.vendor, device.product));
    return row;
  }
  const Percentiles us = percentiles(check.round_trips);
  row.tip = tr("%1 Mbit/s, answers within %2 µs, 99 of 100 times within %3 µs")
                .arg(device.megabits)
                .arg(us.p50, 0, 'f', 0)
                .arg(us.p99, 0, 'f', 0);
  for (const DeviceEntry& driver : deviceCatalog()) {
    if (driver.usb != device.haptic) continue;
    row.remedy = Remedy::use;
    row.device = driver.name;
  }
  if (device.haptic == kProbeName) row.words += tr(", for the Record card: usb:");
  return row;
}

// Names, ordered as in the list.
const std::optional<Stabilisers> kStabilisers[] = {
    std::nullopt, Stabilisers{false, false}, Stabilisers{true, false}, Stabilisers{false, true},
    Stabilisers{true, true}};

struct Number {
  const char* name;
  QString caption, tip, unit;
  double per_unit; // SI
  RowRange range;
  double DeviceModel::*value; // nullptr: the delay, which is a whole number.
};

std::vector<Number> numbers() {
  return {{"device_mass",
           tr("Mass"),
           tr("Mass of the part that the hand moves"),
           QStringLiteral("g"),
           1e-3,
           {1, 5000, 10, 0},
           &DeviceModel::mass},
          {"device_damping",
           tr("Damping"),
           tr("Viscous damping of the device itself"),
           QStringLiteral("N s/m"),
           1,
           {0, 100, 0.1, 2},
           &DeviceModel::damping},
          {"device_coulomb",
           tr("Dry friction"),
           tr("Coulomb friction of the device itself"),
           QStringLiteral("N"),
           1,
           {0, 10, 0.05, 2},
           &DeviceModel::coulomb},
          {"device_encoder",
           tr("Encoder step"),
           tr("Resolution of the device's position"),
           QStringLiteral("µm"),
           1e-6,
           {0, 1000, 5, 1},
           &DeviceModel::encoder_step},
          {"device_rate",
           tr("Rate"),
           tr("Update rate of the device"),
           QStringLiteral("Hz"),
           1,
           {100, 10000, 100, 0},
           &DeviceModel::rate},
          {"device_delay",
           tr("Delay"),
           tr("Delay of the force"),
           tr("samples"),
           1,
           {0, 20, 1, 0},
           nullptr}};
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

AttachedFindings lookForDevices() {
  AttachedFindings found;
  try {
    for (const UsbDevice& device : listUsbDevices())
      if (!device.haptic.empty()) found.usb.push_back(checkUsb(device));
  } catch (const DeviceError& error) {
    found.problem = error.what();
  }
  found.serial = listSerialProbes();
  found.plugins = installedPlugins();
  return found;
}

std::vector<AttachedRow> attachedRows(const AttachedFindings& findings) {
  std::vector<AttachedRow> rows;
  for (const UsbCheck& check : findings.usb) rows.push_back(rowFor(check));
  for (const SerialProbe& probe : findings.serial)
    rows.push_back({shownText(probe.path + ": " + probe.name +
                              (probe.openable ? ", ready" : ", no permission")),
                    probe.openable ? tr("For the Record card: serial: before its path")
                                   : tr("A udev rule or the group dialout gives the permission"),
                    probe.openable ? Remedy::none : Remedy::allow});
  for (const PluginFound& plugin : findings.plugins)
    if (!plugin.problem.empty())
      rows.push_back({shownText("plugin:" + plugin.name + tr(" cannot be used").toStdString()),
                      shownText(plugin.problem), Remedy::look_again});
  if (!findings.problem.empty())
    rows.push_back({tr("USB cannot be read"), shownText(findings.problem), Remedy::look_again});
  else if (findings.usb.empty())
    rows.push_back({tr("No haptic device is attached"), tr("Plug one in, and look again"),
                    Remedy::look_again});
  return rows;
}

AttachedDevices::AttachedDevices(QWidget* parent)
    : QWidget(parent), column_(layoutIn<QVBoxLayout>(this)) {
  setObjectName(QStringLiteral("attached"));
}

void AttachedDevices::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  if (!std::exchange(looked_, true)) look();
  if (watch_) return;
  watch_ = watchUsb([this] {
    QMetaObject::invokeMethod(this, [this] { isVisible() ? look() : void(looked_ = false); });
  });
}

void AttachedDevices::look() {
  setRows({{tr("Looking for devices…"), {}}});
  background_.start([this](Progress&, const Background::Post& post) {
    post(true, [this, found = lookForDevices()] { show(found); });
  });
}

void AttachedDevices::show(const AttachedFindings& findings) {
  setRows(attachedRows(findings));
  emit pluginsFound(findings.plugins);
}

void AttachedDevices::setRows(const std::vector<AttachedRow>& rows) {
  takeAway(std::exchange(rows_, new QWidget(this)));
  auto* list = layoutIn<QVBoxLayout>(rows_, 2);
  for (const AttachedRow& row : rows) {
    auto* line = new QHBoxLayout;
    QLabel* label = quietLabel(row.words);
    label->setWordWrap(true);
    label->setToolTip(row.tip);
    line->addWidget(label, 1);
    if (row.remedy != Remedy::none) {
      auto* button = new QPushButton(buttonFor(row.remedy), rows_);
      button->setToolTip(row.tip);
      connect(button, &QPushButton::clicked, this, [this, row] {
        if (row.remedy == Remedy::use)
          emit useRequested(row.device);
        else if (row.remedy == Remedy::allow)
          allow();
        else
          look();
      });
      line->addWidget(button);
    }
    list->addLayout(line);
  }
  column_->addWidget(rows_);
}

// Installs the udev rule as this user, or with the system's password dialog, or shows the command.
void AttachedDevices::allow() {
  const QString next = tr("Unplug the device and plug it in again");
  try {
    installUdevRules(kUdevFolder);
    QProcess::execute(QStringLiteral("udevadm"),
                      {QStringLiteral("control"), QStringLiteral("--reload")});
    return setRows({{next, {}, Remedy::look_again}});
  } catch (const Error&) { // The user is not root.
  }
  std::filesystem::path helper;
  for (const std::filesystem::path& folder : libraryFolders())
    if (std::filesystem::exists(helper = folder / "patina-udev")) break;
  const QString program = QString::fromStdString(helper.string());
  const QString pkexec = QStandardPaths::findExecutable(QStringLiteral("pkexec"));
  if (!pkexec.isEmpty() && QProcess::startDetached(pkexec, {program}))
    return setRows({{next, {}, Remedy::look_again}});
  const QString command = QStringLiteral("sudo '%1'").arg(program);
  QApplication::clipboard()->setText(command);
  setRows({{tr("Only root can give the permission. The command is on the clipboard: run it in a "
               "terminal, and plug the device in again"),
            command, Remedy::look_again}});
}

DeviceChoice deviceChoice(const Scene& scene) {
  return {scene.device, scene.device_model, scene.stabilisers};
}

DevicePanel::DevicePanel(QWidget* parent)
    : QGroupBox(tr("Device"), parent), device_(new QComboBox(this)),
      stabiliser_(new QComboBox(this)), layout_(layoutIn<QVBoxLayout>(this)),
      attached_(new AttachedDevices(this)) {
  auto* grid = new QGridLayout;
  grid->setColumnStretch(1, 1);
  grid->addWidget(quietLabel(tr("Felt with")), 0, 0);
  QStringList notes;
  for (const DeviceEntry& entry : deviceCatalog()) {
    if (!entry.selectable) continue;
    device_->addItem(tr(entry.caption), QString::fromUtf8(entry.name));
    notes << tr(entry.caption) + QStringLiteral(": ") + tr(entry.note);
  }
  grid->addWidget(named(device_, "device", notes.join(QLatin1Char('\n'))), 0, 1);
  grid->addWidget(quietLabel(tr("Stabiliser")), 1, 0);
  stabiliser_->addItems(
      {tr("Automatic"), tr("None"), tr("Coupling"), tr("Passivity"), tr("Coupling and passivity")});
  named(stabiliser_, "stabiliser",
        tr("Coupling: a spring and damper between tip and contact point (virtual coupling). Stable "
           "at any stiffness, but the surface feels softer. Passivity: adds damping when the "
           "surface generates energy. Automatic: chosen from the device's parameters, and off if "
           "not needed."));
  grid->addWidget(stabiliser_, 1, 1);
  layout_->addLayout(grid);
  note_ = addNote(layout_, "stability_note");
  layout_->addWidget(attached_);
  connect(attached_, &AttachedDevices::pluginsFound, this,
          [this](const std::vector<PluginFound>& plugins) {
            for (const PluginFound& plugin : plugins)
              if (plugin.problem.empty())
                addDevice(shownText(plugin.caption), "plugin:" + plugin.name);
          });
  connect(attached_, &AttachedDevices::useRequested, this, [this](const std::string& device) {
    device_->setCurrentIndex(device_->findData(shownText(device)));
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
  if (isPlugin(choice.device)) addDevice(shownText(choice.device), choice.device);
  device_->setCurrentIndex(device_->findData(shownText(choice.device)));
  for (int i = 0; i < 5; ++i)
    if (kStabilisers[i] == choice.stabilisers) stabiliser_->setCurrentIndex(i);
  rebuild();
}

void DevicePanel::addDevice(const QString& caption, const std::string& device) {
  const QString name = shownText(device);
  const QSignalBlocker quiet(device_);
  if (device_->findData(name) < 0) device_->addItem(caption, name);
}

void DevicePanel::showPlan(const StabiliserPlan& plan) {
  say(note_, wordsFor(plan));
}

void DevicePanel::rebuild() {
  takeAway(std::exchange(numbers_, nullptr));
  if (!choice_.model && !deviceNamed(choice_.device).uses_device_model) return;
  numbers_ = new QWidget(this);
  auto* column = layoutIn<QVBoxLayout>(numbers_, 4);
  if (choice_.model) addNumbers(column);
  addButton<QToolButton>(
      column, "device_numbers", choice_.model ? tr("✕ Forget the numbers") : tr("+ Device numbers"),
      tr("Mass, damping, encoder, rate and delay determine the largest stable stiffness"), this,
      [this] {
        choice_.model = choice_.model ? std::nullopt : std::optional(DeviceModel{});
        rebuild();
        emit edited();
      });
  layout_->insertWidget(1, numbers_);
}

void DevicePanel::addNumbers(QVBoxLayout* column) {
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(8);
  grid->setVerticalSpacing(2);
  int index = 0;
  for (const Number& number : numbers()) {
    auto* box = named(numberBox(number.caption, number.unit, number.range, numbers_), number.name,
                      number.tip);
    box->setValue((number.value ? (*choice_.model).*number.value : choice_.model->delay) /
                  number.per_unit);
    connect(box, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
            [this, at = number.value, per_unit = number.per_unit](double value) {
              if (at)
                (*choice_.model).*at = per_unit * value;
              else
                choice_.model->delay = static_cast<int>(std::lround(value));
              emit edited();
            });
    const int row = 2 * (index / 2), side = index % 2;
    grid->addWidget(quietLabel(number.caption), row, side);
    grid->addWidget(box, row + 1, side);
    ++index;
  }
  column->addLayout(grid);
}

} // namespace patina

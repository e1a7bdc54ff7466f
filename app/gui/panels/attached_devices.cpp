#include "app/gui/panels/attached_devices.h"

#include <QApplication>
#include <QClipboard>
#include <QHBoxLayout>
#include <QLabel>
#include <QProcess>
#include <QPushButton>
#include <QStandardPaths>
#include <utility>

#include "app/gui/panels/value_row.h"
#include "core/error.h"
#include "core/file.h"

namespace patina {
namespace {

QString caption(const char* words) {
  return AttachedDevices::tr(words);
}

QString shownText(const std::string& text) {
  return QString::fromStdString(text);
}

QString buttonFor(Remedy remedy) {
  switch (remedy) {
  case Remedy::use:
    return caption("Use it");
  case Remedy::allow:
    return caption("Allow…");
  case Remedy::look_again:
    return caption("Look again");
  case Remedy::none:
    break;
  }
  return {};
}

AttachedRow rowFor(const UsbCheck& check) {
  const UsbDevice& device = check.device;
  AttachedRow row{shownText(device.name + ": " + stateText(check)), shownText(device.name)};
  if (check.refusal) {
    row.remedy = check.refusal == UsbRefusal::permission ? Remedy::allow : Remedy::look_again;
    row.tip = shownText(usbAdvice(*check.refusal, device.vendor, device.product));
    return row;
  }
  const Percentiles us = percentiles(check.round_trips);
  row.tip = caption("%1 Mbit/s, answers within %2 µs, 99 of 100 times within %3 µs")
                .arg(device.megabits)
                .arg(us.p50, 0, 'f', 0)
                .arg(us.p99, 0, 'f', 0);
  for (const DeviceEntry& driver : deviceCatalog()) {
    if (driver.usb != device.haptic) continue;
    row.remedy = Remedy::use;
    row.device = driver.name;
  }
  if (device.haptic == kProbeName) row.words += caption(", for the Record card: usb:");
  return row;
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
                    probe.openable ? caption("For the Record card: serial: before its path")
                                   : caption("A rule of udev, or the group dialout, allows it"),
                    probe.openable ? Remedy::none : Remedy::allow});
  for (const PluginFound& plugin : findings.plugins)
    if (!plugin.problem.empty())
      rows.push_back({shownText("plugin:" + plugin.name + caption(" cannot be used").toStdString()),
                      shownText(plugin.problem), Remedy::look_again});
  if (!findings.problem.empty())
    rows.push_back(
        {caption("USB cannot be read"), shownText(findings.problem), Remedy::look_again});
  else if (findings.usb.empty())
    rows.push_back({caption("No haptic device is attached"), caption("Plug one in, and look again"),
                    Remedy::look_again});
  return rows;
}

AttachedDevices::AttachedDevices(QWidget* parent)
    : QWidget(parent), column_(new QVBoxLayout(this)) {
  setObjectName(QStringLiteral("attached"));
  column_->setContentsMargins(0, 0, 0, 0);
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
  background_.start([this](Progress&, const Background::Deliver& deliver) {
    deliver(true, [this, found = lookForDevices()] { show(found); });
  });
}

void AttachedDevices::show(const AttachedFindings& findings) {
  setRows(attachedRows(findings));
  emit pluginsFound(findings.plugins);
}

void AttachedDevices::setRows(const std::vector<AttachedRow>& rows) {
  takeAway(std::exchange(rows_, new QWidget(this)));
  auto* list = new QVBoxLayout(rows_);
  list->setContentsMargins(0, 0, 0, 0);
  list->setSpacing(2);
  for (const AttachedRow& row : rows) {
    auto* line = new QHBoxLayout;
    auto* label = new QLabel(row.words, rows_);
    label->setProperty("quiet", true);
    label->setWordWrap(true);
    label->setToolTip(row.tip);
    line->addWidget(label, 1);
    if (row.remedy != Remedy::none) {
      auto* button = new QPushButton(buttonFor(row.remedy), rows_);
      button->setToolTip(row.tip);
      connect(button, &QPushButton::clicked, this, [this, row] {
        if (row.remedy == Remedy::use)
          emit useAsked(row.device);
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

// As this user where that may be, else with the system's question for the password, else by hand.
void AttachedDevices::allow() {
  const QString next = tr("Unplug the device and plug it in again");
  try {
    writeFileAtomically(std::filesystem::path("/etc/udev/rules.d") / kUdevFile, udevRules());
    QProcess::execute(QStringLiteral("udevadm"),
                      {QStringLiteral("control"), QStringLiteral("--reload")});
    return setRows({{next, {}, Remedy::look_again}});
  } catch (const Error&) { // not root
  }
  const QString program = QApplication::applicationDirPath() + QStringLiteral("/patina");
  const QStringList words{program, QStringLiteral("devices"), QStringLiteral("--install-udev")};
  const QString asks = QStandardPaths::findExecutable(QStringLiteral("pkexec"));
  if (!asks.isEmpty() && QProcess::startDetached(asks, words))
    return setRows({{next, {}, Remedy::look_again}});
  const QString command = QStringLiteral("sudo ") + words.join(QLatin1Char(' '));
  QApplication::clipboard()->setText(command);
  setRows({{tr("Only root may allow it. The command is on the clipboard; run it in a terminal, and "
               "plug the device in again"),
            command, Remedy::look_again}});
}

} // namespace patina

// What is attached, what forbids it, and one button that mends it.
#pragma once

#include <QVBoxLayout>
#include <QWidget>

#include "app/gui/window/background.h"
#include "haptics/devices/plugin/plugin_library.h"
#include "usb/usb_check.h"

namespace patina {

// What a look finds; slow, any thread.
struct AttachedFindings {
  std::vector<UsbCheck> usb{}; // haptic devices and probes
  std::vector<SerialProbe> serial{};
  std::vector<PluginFound> plugins{};
  std::string problem{}; // why the bus cannot be read
};
AttachedFindings lookForDevices();

enum class Remedy { none, use, allow, look_again };
struct AttachedRow {
  QString words, tip;
  Remedy remedy = Remedy::none;
  std::string device{}; // of the scene, to use
};
std::vector<AttachedRow> attachedRows(const AttachedFindings& findings);

// Looks when it is first shown, when something was plugged in or out, and when asked to.
class AttachedDevices : public QWidget {
  Q_OBJECT
 public:
  explicit AttachedDevices(QWidget* parent);
  void show(const AttachedFindings& findings);

 signals:
  void pluginsFound(const std::vector<PluginFound>& plugins);
  void useAsked(const std::string& device);

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  void look();
  void allow();
  void setRows(const std::vector<AttachedRow>& rows);

  Background background_{this};
  QVBoxLayout* column_;
  QWidget* rows_ = nullptr;
  bool looked_ = false;
  std::shared_ptr<void> watch_; // of the bus
};

} // namespace patina

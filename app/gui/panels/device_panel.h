// The haptic device, its parameters, and the stabilisers of the loop.
#pragma once

#include <optional>
#include <string>

#include <QComboBox>
#include <QGridLayout>
#include <QGroupBox>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWidget>

#include "app/gui/toolkit/background.h"
#include "haptics/law/stabilisers.h"
#include "haptics/plugin/plugin_library.h"
#include "scene/scene.h"
#include "usb/usb_check.h"

namespace patina {

// Lists the attached devices and why they cannot be used, with a button for the remedy.

// Result of a search, which is slow and can run on any thread.
struct AttachedFindings {
  std::vector<UsbCheck> usb{}; // Haptic devices and probes.
  std::vector<SerialProbe> serial{};
  std::vector<PluginFound> plugins{};
  std::string problem{}; // Why the bus cannot be read.
};
AttachedFindings lookForDevices();

enum class Remedy { none, use, allow, look_again };
struct AttachedRow {
  QString words, tip;
  Remedy remedy = Remedy::none;
  std::string device{}; // Name of the device in the scene.
};
std::vector<AttachedRow> attachedRows(const AttachedFindings& findings);

// Searches when first shown, when a device was plugged in or out, and on request.
class AttachedDevices : public QWidget {
  Q_OBJECT
 public:
  explicit AttachedDevices(QWidget* parent);
  void show(const AttachedFindings& findings);

 signals:
  void pluginsFound(const std::vector<PluginFound>& plugins);
  void useRequested(const std::string& device);

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
  std::shared_ptr<void> watch_;
};

// The part of a scene that this panel edits.
struct DeviceChoice {
  std::string device = "mouse";
  std::optional<DeviceModel> model;
  std::optional<Stabilisers> stabilisers; // nullopt: automatic.
  bool operator==(const DeviceChoice&) const = default;
};
DeviceChoice deviceChoice(const Scene& scene);

class DevicePanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit DevicePanel(QWidget* parent = nullptr);

  void setValues(const DeviceChoice& choice); // Sends no signal.
  const DeviceChoice& values() const { return choice_; }
  void showPlan(const StabiliserPlan& plan);

 signals:
  void edited();

 private:
  void rebuild();
  void addNumbers(QVBoxLayout* column);
  void addDevice(const QString& caption, const std::string& device);

  DeviceChoice choice_;
  QComboBox* device_;
  QComboBox* stabiliser_;
  QVBoxLayout* layout_;
  QWidget* numbers_ = nullptr;
  QLabel* note_;
  AttachedDevices* attached_;
};

} // namespace patina

// The settings that the program keeps between sessions and that belong to no panel.
#pragma once

#include <functional>

#include <QDialog>

namespace patina {

// Every change is kept at once. `keys` shows the list of keys.
class PreferencesDialog : public QDialog {
  Q_OBJECT
 public:
  PreferencesDialog(QWidget* window, const std::function<void()>& keys);
};

} // namespace patina

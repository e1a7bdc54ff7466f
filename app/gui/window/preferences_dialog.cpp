#include "app/gui/window/preferences_dialog.h"

#include <algorithm>
#include <utility>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QPushButton>

#include "app/gui/loading/up_choice.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/elided_label.h"
#include "app/gui/toolkit/system_theme.h"

namespace patina {

PreferencesDialog::PreferencesDialog(QWidget* window, const std::function<void()>& keys)
    : QDialog(window) {
  setObjectName(QStringLiteral("preferences_dialog"));
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("Preferences"));
  auto* form = new QFormLayout(this);

  auto* theme = named(new QComboBox, "theme", tr("Colours of the window and of its pictures"));
  const std::pair<QString, const char*> themes[] = {
      {tr("as the desktop"), ""}, {tr("light"), "light"}, {tr("dark"), "dark"}};
  for (const auto& [words, key] : themes) theme->addItem(words, QString::fromUtf8(key));
  theme->setCurrentIndex(std::max(0, theme->findData(keptTheme())));
  connect(theme, qOverload<int>(&QComboBox::activated), this,
          [theme] { keepTheme(theme->currentData().toString()); });
  form->addRow(tr("Theme"), theme);

  auto* up = named(new QCheckBox(tr("y points upwards, not z")), "y_up",
                   tr("Turns meshes that you open from now on"));
  up->setChecked(rememberedUp() == UpAxis::y);
  connect(up, &QCheckBox::toggled, this, [](bool on) { rememberUp(on ? UpAxis::y : UpAxis::z); });
  form->addRow(tr("Mesh files"), up);

  auto* folder = named(new ElidedLabel, "first_folder");
  folder->setText(lastFolder());
  auto* line = new QHBoxLayout;
  line->addWidget(folder, 1);
  addButton<QPushButton>(line, "choose_folder", tr("Choose…"),
                         tr("File dialogs begin there; afterwards where one last was"), this,
                         [this, folder] {
                           askForPath(this, tr("Folder of file dialogs"), QFileDialog::Directory,
                                      {}, [folder](const QString& path) {
                                        rememberFolder(path + QStringLiteral("/any"));
                                        folder->setText(lastFolder());
                                      });
                         });
  form->addRow(tr("Dialogs begin in"), line);

  auto* list = named(new QPushButton(tr("Mouse and keys…")), "show_keys");
  connect(list, &QPushButton::clicked, this, keys);
  form->addRow(tr("Keys"), list);

  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  form->addRow(buttons);
}

} // namespace patina

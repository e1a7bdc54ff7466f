// Menus, tool bar and the dialogs behind them.
#include <QActionGroup>
#include <QApplication>
#include <QFileDialog>
#include <QMenuBar>
#include <QMessageBox>
#include <QPixmap>
#include <QToolBar>

#include "app/gui/load_dialogs.h"
#include "app/gui/main_window.h"
#include "core/error.h"

namespace patina {
namespace {

QString shortcutsText() {
  return MainWindow::tr(
      "<table cellspacing='6'>"
      "<tr><td><b>Left drag</b></td><td>move the tip in the plane you look at</td></tr>"
      "<tr><td><b>Wheel</b></td><td>move the tip away from you, and back</td></tr>"
      "<tr><td><b>Double click</b></td><td>set the tip onto the surface there</td></tr>"
      "<tr><td><b>Shift + left drag</b></td><td>turn the camera</td></tr>"
      "<tr><td><b>Middle drag</b></td><td>shift the camera</td></tr>"
      "<tr><td><b>Right drag, Ctrl + wheel</b></td><td>zoom</td></tr>"
      "<tr><td><b>Space</b></td><td>feel or navigate with the left button</td></tr>"
      "<tr><td><b>F</b></td><td>fit the scene into the view</td></tr>"
      "<tr><td><b>1 … 7</b></td><td>camera from +x, −x, +y, −y, +z, −z, at an angle</td></tr>"
      "<tr><td><b>M T S I W N B E K</b></td><td>mesh, tool, slice, iso-surface, wireframe, nodes, "
      "band, field extent, stability</td></tr>"
      "<tr><td><b>R</b></td><td>record the forces, and save them</td></tr></table>");
}

QString signed_(ViewPreset preset) {
  QString words = QString::fromUtf8(name(preset).data(), static_cast<int>(name(preset).size()));
  return words == QStringLiteral("iso") ? MainWindow::tr("At an angle")
                                        : words.replace('-', QStringLiteral("−"));
}

} // namespace

void MainWindow::buildMenus() {
  QMenu* file = menuBar()->addMenu(tr("&File"));
  QAction* open_action = file->addAction(
      tr("&Open…"), this, [this] { openDialog(false); }, QKeySequence::Open);
  QAction* add_action = file->addAction(
      tr("&Add object…"), this, [this] { openDialog(true); }, Qt::CTRL | Qt::SHIFT | Qt::Key_O);
  add_action->setToolTip(tr("A mesh or volume that is felt together with what is open"));
  recent_ = new RecentFiles(file->addMenu(tr("Open &recent")));
  connect(recent_, &RecentFiles::chosen, this, [this](const QString& path) {
    LoadRequest request;
    request.path = path.toStdString();
    openAsked(request);
  });
  file->addAction(tr("Open the toy &dinosaur"), this, [this] { openAsked({}); });
  file->addSeparator();
  save_action_ =
      file->addAction(tr("&Save workspace…"), this, &MainWindow::saveDialog, QKeySequence::Save);
  file->addAction(tr("&Export picture…"), this, &MainWindow::exportDialog);
  record_action_ = file->addAction(tr("&Record forces"));
  record_action_->setCheckable(true);
  record_action_->setShortcut(Qt::Key_R);
  record_action_->setToolTip(tr("Record every tick, then save a CSV table"));
  connect(record_action_, &QAction::triggered, this, &MainWindow::recordDialog);
  file->addSeparator();
  file->addAction(tr("&Quit"), this, &QWidget::close, QKeySequence::Quit);

  QMenu* view_menu = menuBar()->addMenu(tr("&View"));
  auto* modes = new QActionGroup(this);
  feel_action_ = modes->addAction(tr("Feel"));
  feel_action_->setToolTip(tr("Left drag moves the tip, the wheel moves it in depth (Space)"));
  navigate_action_ = modes->addAction(tr("Navigate"));
  navigate_action_->setToolTip(tr("Left drag turns the camera, the wheel zooms (Space)"));
  for (QAction* action : {feel_action_, navigate_action_}) action->setCheckable(true);
  feel_action_->setChecked(true);
  connect(feel_action_, &QAction::triggered, this, [this] { setMode(SceneWidget::Mode::feel); });
  connect(navigate_action_, &QAction::triggered, this,
          [this] { setMode(SceneWidget::Mode::navigate); });
  view_menu->addActions(modes->actions());
  view_menu->addAction(
      tr("Feel or navigate"), this,
      [this] {
        setMode(view_->mode() == SceneWidget::Mode::feel ? SceneWidget::Mode::navigate
                                                         : SceneWidget::Mode::feel);
      },
      Qt::Key_Space);
  view_menu->addSeparator();
  QAction* fit_action = view_menu->addAction(
      tr("&Fit"), this, [this] { view_->view().fit(); }, Qt::Key_F);
  QMenu* camera_menu = view_menu->addMenu(tr("&Camera"));
  int digit = Qt::Key_1;
  QList<QAction*> presets;
  for (const ViewPreset preset : allViews())
    presets << camera_menu->addAction(
        signed_(preset), this, [this, preset] { view_->view().setView(preset); }, digit++);
  view_menu->addSeparator();
  const std::pair<Layer, int> keys[] = {
      {Layer::mesh, Qt::Key_M}, {Layer::tip, Qt::Key_T},       {Layer::slice, Qt::Key_S},
      {Layer::iso, Qt::Key_I},  {Layer::wireframe, Qt::Key_W}, {Layer::nodes, Qt::Key_N},
      {Layer::band, Qt::Key_B}, {Layer::extent, Qt::Key_E},    {Layer::stability, Qt::Key_K}};
  for (const auto& [layer, key] : keys) {
    const auto words = name(layer);
    QAction* action = view_menu->addAction(
        tr("Show %1").arg(QString::fromUtf8(words.data(), static_cast<int>(words.size()))));
    action->setCheckable(true);
    action->setChecked(display_->shown(layer));
    action->setShortcut(key);
    const Layer which = layer;
    connect(action, &QAction::toggled, this,
            [this, which](bool on) { display_->setShown(which, on); });
    connect(display_, &DisplayPanel::layerToggled, action, [action, which](Layer toggled, bool on) {
      if (toggled == which) action->setChecked(on);
    });
  }

  view_menu->addSeparator();
  view_menu->addActions(panels_);

  QMenu* help = menuBar()->addMenu(tr("&Help"));
  const auto tell = [this](const QString& title, const QString& words) {
    auto* box = new QMessageBox(QMessageBox::NoIcon, title, words, QMessageBox::Ok, this);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->open();
  };
  help->addAction(
      tr("&Mouse and keys"), this, [tell] { tell(tr("Mouse and keys"), shortcutsText()); },
      Qt::Key_F1);
  help->addAction(tr("&About Patina"), this, [tell] {
    tell(tr("About Patina"),
         tr("<h3>Patina %1</h3><p>A mesh becomes a sampled implicit surface, and a 1 kHz servo "
            "feels it.</p><p>BSD-3-Clause. Built on VTK, Qt, Eigen, OpenMesh and TBB.</p>")
             .arg(QStringLiteral(PATINA_VERSION)));
  });

  QToolBar* bar = addToolBar(tr("Tools"));
  bar->setObjectName(QStringLiteral("tools"));
  bar->setMovable(false);
  bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
  bar->setStyleSheet(QStringLiteral(
      "QToolBar { border: none; border-bottom: 1px solid #d5dae2; padding: 3px 6px; spacing: 3px; }"
      "QToolButton { padding: 3px 8px; border: 1px solid transparent; border-radius: 4px; }"
      "QToolButton:hover { background: #e0e6ee; }"
      "QToolButton:checked { background: #2b6cb0; color: white; }"));
  bar->addAction(open_action);
  bar->addSeparator();
  bar->addActions(modes->actions());
  bar->addSeparator();
  bar->addAction(fit_action);
  bar->addActions(presets);
  bar->addSeparator();
  bar->addAction(record_action_);
}

void MainWindow::openDialog(bool adds) {
  auto* dialog = new QFileDialog(this, adds ? tr("Add a mesh, volume or workspace to the scene")
                                            : tr("Open a mesh, volume or workspace"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::ExistingFile);
  dialog->setNameFilters({tr("Meshes, volumes and workspaces (*.obj *.ply *.stl *.vti *.OBJ *.PLY "
                             "*.STL *.VTI workspace.json)"),
                          tr("All files (*)")});
  connect(dialog, &QFileDialog::fileSelected, this, [this, adds](const QString& path) {
    LoadRequest request;
    request.path = path.toStdString();
    if (adds) request.onto = current_;
    // Of a workspace, which is a folder, people see the file in it.
    if (request.path.filename() == "workspace.json") request.path = request.path.parent_path();
    if (adds)
      open(request);
    else
      openAsked(request);
  });
  dialog->open();
}

bool MainWindow::saveDialog() {
  const QString folder = QFileDialog::getSaveFileName(
      this, tr("Save the workspace as a folder"), QStringLiteral("scene.patina"), {}, nullptr,
      QFileDialog::DontConfirmOverwrite | QFileDialog::HideNameFilterDetails);
  if (folder.isEmpty()) return false;
  try {
    saveWorkspaceTo(folder);
    statusBar()->showMessage(tr("Saved %1").arg(folder), 4000);
    return true;
  } catch (const std::exception& error) {
    showProblem(this, tr("The workspace cannot be saved"), QString::fromStdString(error.what()),
                tr("Choose a folder that you may write to."));
    return false;
  }
}

bool MainWindow::settleEdits() {
  while (isWindowModified()) {
    QMessageBox box(QMessageBox::Question, tr("The edits are not saved"),
                    tr("The scene's values were edited and are in no workspace yet."),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
    box.setObjectName(QStringLiteral("unsaved_edits"));
    const int answer = box.exec();
    if (answer == QMessageBox::Discard) return true;
    if (answer != QMessageBox::Save) return false;
    saveDialog();
  }
  return true;
}

void MainWindow::openAsked(const LoadRequest& request) {
  if (!asks_ || settleEdits()) open(request);
}

void MainWindow::exportDialog() {
  const QString path = QFileDialog::getSaveFileName(
      this, tr("Export the picture"), QStringLiteral("patina.png"), tr("PNG pictures (*.png)"));
  if (path.isEmpty()) return;
  if (!view_->grabFramebuffer().save(path, "PNG"))
    showProblem(this, tr("The picture cannot be saved"), path,
                tr("Choose a folder that you may write to, and a name that ends in .png."));
}

void MainWindow::recordDialog(bool on) {
  if (on) return startRecording();
  collect();
  recording_.pause();
  if (saveRecordingDialog() || settleRecording()) return;
  recording_.resume();
  record_action_->setChecked(true);
}

bool MainWindow::saveRecordingDialog() {
  const QString path = QFileDialog::getSaveFileName(
      this, tr("Save the recorded forces"), QStringLiteral("feel.csv"), tr("Tables (*.csv)"));
  if (path.isEmpty()) return false;
  const std::size_t count = recording_.samples().size(), lost = recording_.lost();
  try {
    recording_.save(path.toStdString());
  } catch (const std::exception& error) {
    showProblem(this, tr("The recording cannot be saved"), QString::fromStdString(error.what()),
                tr("Choose a folder that you may write to. The recording is kept."));
    return false;
  }
  record_action_->setChecked(false);
  QString words = tr("Saved %1 ticks to %2").arg(count).arg(path);
  if (lost > 0) words += tr("; %1 ticks came too fast to be kept").arg(lost);
  statusBar()->showMessage(words, lost > 0 ? 0 : 4000);
  return true;
}

bool MainWindow::settleRecording() {
  collect();
  while (!recording_.samples().empty()) {
    QMessageBox box(QMessageBox::Question, tr("The recording is not saved"),
                    tr("%1 recorded ticks are in no file yet.").arg(recording_.samples().size()),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
    box.setObjectName(QStringLiteral("unsaved_recording"));
    const int answer = box.exec();
    if (answer == QMessageBox::Discard) {
      recording_.clear();
      record_action_->setChecked(false);
    } else if (answer != QMessageBox::Save) {
      return false;
    } else {
      saveRecordingDialog();
    }
  }
  return true;
}

} // namespace patina

// Menus and the bar below them.
#include <QMenuBar>
#include <QMessageBox>
#include <QToolBar>

#include "app/gui/window/main_window.h"

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
      "<tr><td><b>Space</b></td><td>navigate with the left button, and back to the tool</td></tr>"
      "<tr><td><b>F</b></td><td>fit the scene into the view</td></tr>"
      "<tr><td><b>1 … 7</b></td><td>camera from +x, −x, +y, −y, +z, −z, at an angle</td></tr>"
      "<tr><td><b>M T S I W N B E K</b></td><td>mesh, tool, slice, iso-surface, wireframe, nodes, "
      "band, field extent, stability</td></tr>"
      "<tr><td><b>V P H D G X</b></td><td>feel, paint, relief, stiffness, friction, erase</td></tr>"
      "<tr><td><b>[ ]</b></td><td>brush smaller, larger; with Shift its fall-off</td></tr>"
      "<tr><td><b>C, Alt + click</b></td><td>take what is painted there into the brush</td></tr>"
      "<tr><td><b>Ctrl + Z, Ctrl + Shift + Z</b></td><td>undo, redo</td></tr>"
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
  save_action_ = file->addAction(tr("&Save"), this, &MainWindow::save, QKeySequence::Save);
  save_action_->setToolTip(tr("Into the workspace that is open, or into a new one"));
  save_as_action_ = file->addAction(tr("Save workspace &as…"), this, &MainWindow::saveDialog,
                                    Qt::CTRL | Qt::SHIFT | Qt::Key_S);
  file->addAction(tr("&Export picture…"), this, &MainWindow::exportDialog);
  record_action_ = file->addAction(tr("&Record forces"));
  record_action_->setCheckable(true);
  record_action_->setShortcut(Qt::Key_R);
  record_action_->setToolTip(tr("Record every tick, then save a CSV table"));
  connect(record_action_, &QAction::triggered, this, &MainWindow::recordDialog);
  file->addSeparator();
  file->addAction(tr("&Quit"), this, &QWidget::close, QKeySequence::Quit);
  buildEditMenu();
  buildViewMenu();
  buildHelpMenu();

  QToolBar* bar = addToolBar(tr("View"));
  bar->setObjectName(QStringLiteral("tools"));
  bar->setMovable(false);
  bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
  bar->setStyleSheet(QStringLiteral(
      "QToolBar { border: none; border-bottom: 1px solid #d5dae2; padding: 3px 6px; spacing: 3px; }"
      "QToolButton { padding: 3px 8px; border: 1px solid transparent; border-radius: 4px; }"
      "QToolButton:hover { background: #e0e6ee; }"
      "QToolButton:checked { background: #2b6cb0; color: white; }"));
  bar->addAction(open_action);
  bar->addAction(save_action_);
  bar->addSeparator();
  bar->addAction(undo_action_);
  bar->addAction(redo_action_);
  bar->addSeparator();
  bar->addActions(views_);
  bar->addSeparator();
  bar->addAction(record_action_);
}

void MainWindow::buildEditMenu() {
  QMenu* edit = menuBar()->addMenu(tr("&Edit"));
  undo_action_ = edit->addAction(
      tr("&Undo"), this, [this] { edits_->undo(); }, QKeySequence::Undo);
  redo_action_ = edit->addAction(tr("&Redo"), this, [this] { edits_->redo(); });
  redo_action_->setShortcuts({QKeySequence("Ctrl+Shift+Z"), QKeySequence("Ctrl+Y")});
  edit->addSeparator();
  edit->addActions(tools_->actionsOfTools());
  edit->addSeparator();
  const auto add = [&](const QString& words, const QList<QKeySequence>& keys, auto act) {
    QAction* action = edit->addAction(words, this, act);
    action->setShortcuts(keys);
  };
  // On keyboards where Shift makes a brace of a bracket the key is the brace.
  add(tr("Smaller brush"), {Qt::Key_BracketLeft}, [this] { desk_->resizeBrush(1 / 1.15); });
  add(tr("Larger brush"), {Qt::Key_BracketRight}, [this] { desk_->resizeBrush(1.15); });
  add(tr("Softer brush"), {QKeySequence("Shift+["), Qt::Key_BraceLeft},
      [this] { desk_->softenBrush(1 / 1.15); });
  add(tr("Harder brush"), {QKeySequence("Shift+]"), Qt::Key_BraceRight},
      [this] { desk_->softenBrush(1.15); });
}

void MainWindow::buildViewMenu() {
  QMenu* view_menu = menuBar()->addMenu(tr("&View"));
  view_menu->addAction(
      tr("Navigate, or back to the tool"), this,
      [this] {
        const ToolChoice now = tools_->choice();
        if (now.handling == Handling::navigate) return tools_->choose(before_navigating_);
        before_navigating_ = now;
        tools_->choose({Handling::navigate, {}});
      },
      Qt::Key_Space);
  view_menu->addSeparator();
  views_ << view_menu->addAction(
      tr("&Fit"), this, [this] { view_->view().fit(); }, Qt::Key_F);
  QMenu* camera_menu = view_menu->addMenu(tr("&Camera"));
  int digit = Qt::Key_1;
  for (const ViewPreset preset : allViews())
    views_ << camera_menu->addAction(
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
  view_menu->addAction(history_dock_->toggleViewAction());
}

void MainWindow::buildHelpMenu() {
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
}

} // namespace patina

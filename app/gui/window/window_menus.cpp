// The menus of the window.
#include <algorithm>

#include <QDialog>
#include <QDialogButtonBox>
#include <QFile>
#include <QLineEdit>
#include <QMenuBar>
#include <QMessageBox>
#include <QRegularExpression>
#include <QShortcut>
#include <QTextBrowser>
#include <QToolBar>
#include <QVBoxLayout>

#include "app/gui/aligning/align_desk.h"
#include "app/gui/scanning/scan_desk.h"
#include "app/gui/texturing/texture_desk.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/words.h"
#include "app/gui/window/action_search.h"
#include "app/gui/window/main_window.h"
#include "app/gui/window/preferences_dialog.h"
#include "core/version.h"
#include "visualization/values/camera.h"

void initGuideResource() {
  Q_INIT_RESOURCE(user_guide);
}

namespace patina {
namespace {

// Shows docs/user_guide.md, as of the build.
class GuideWindow final : public QWidget {
 public:
  explicit GuideWindow(QWidget& over) : QWidget(&over, Qt::Window) {
    setObjectName(QStringLiteral("user_guide"));
    setWindowTitle(tr("User guide"));
    setAttribute(Qt::WA_DeleteOnClose);
    resize(760, 640);
    auto* find = named(new QLineEdit(this), "guide_find");
    find->setPlaceholderText(tr("Find in the guide; Return finds the next"));
    auto* text = named(new QTextBrowser(this), "guide_text");
    text->setOpenLinks(false); // Links lead to other files of the project.
    initGuideResource();
    QFile file(QStringLiteral(":/user_guide.md"));
    if (file.open(QIODevice::ReadOnly)) {
      static const QRegularExpression kImageLink(QStringLiteral(R"(!\[[^\]]*\]\([^)]*\))"));
      text->setMarkdown(QString::fromUtf8(file.readAll()).remove(kImageLink));
    }
    connect(new QShortcut(Qt::Key_Escape, this), &QShortcut::activated, this, &QWidget::close);
    auto* column = new QVBoxLayout(this);
    column->addWidget(find);
    column->addWidget(text);
    connect(find, &QLineEdit::returnPressed, text, [find, text] {
      if (text->find(find->text())) return;
      text->moveCursor(QTextCursor::Start); // The search wraps around.
      text->find(find->text());
    });
  }
};

// Raises the window if it is open.
void showGuide(QWidget& over) {
  auto* guide = over.findChild<QWidget*>(QStringLiteral("user_guide"));
  if (!guide) guide = new GuideWindow(over);
  guide->show();
  guide->raise();
  guide->activateWindow();
}

QString shortcutsText() {
  return QMainWindow::tr(
      "<table cellspacing='6'>"
      "<tr><td><b>Left drag</b></td><td>move the tip in the plane you look at</td></tr>"
      "<tr><td><b>Wheel</b></td><td>move the tip away from you, and back</td></tr>"
      "<tr><td><b>Double click</b></td><td>set the tip onto the surface there</td></tr>"
      "<tr><td><b>Q</b></td><td>press on the surface under the pointer; the wheel sets the "
      "force</td></tr>"
      "<tr><td><b>Shift + left drag</b></td><td>turn the camera</td></tr>"
      "<tr><td><b>The cube in the corner</b></td><td>a click looks from that side, a drag "
      "turns</td></tr>"
      "<tr><td><b>Middle drag</b></td><td>shift the camera</td></tr>"
      "<tr><td><b>Right drag, Ctrl + wheel</b></td><td>zoom</td></tr>"
      "<tr><td><b>Space</b></td><td>navigate with the left button, and back to the tool</td></tr>"
      "<tr><td><b>F</b></td><td>fit the scene into the view</td></tr>"
      "<tr><td><b>1 … 7</b></td><td>camera from +x, −x, +y, −y, +z, −z, at an angle</td></tr>"
      "<tr><td><b>O</b></td><td>without perspective, and with it</td></tr>"
      "<tr><td><b>M T S I W N B E K</b></td><td>mesh, tool, slice, iso-surface, wireframe, nodes, "
      "band, field extent, stability</td></tr>"
      "<tr><td><b>Shift + S</b></td><td>clip plane: hides the part in front of it</td></tr>"
      "<tr><td><b>V A P H D G J U X</b></td><td>feel, navigate, paint, relief, stiffness, "
      "friction, "
      "damping, roughness, erase</td></tr>"
      "<tr><td><b>Y Z</b></td><td>measure, pin</td></tr>"
      "<tr><td><b>Ctrl + 1 … 6</b></td><td>the desks Scan, Align, Texture, Feel, Paint, "
      "Analyse</td></tr>"
      "<tr><td><b>← →, Page up, down</b></td><td>one frame of a scan back or on, ten</td></tr>"
      "<tr><td><b>F4</b></td><td>switch the force off, and on again</td></tr>"
      "<tr><td><b>F8, F9</b></td><td>fold the side panel, the bottom panel</td></tr>"
      "<tr><td><b>[ ]</b></td><td>brush smaller, larger; with Shift its fall-off</td></tr>"
      "<tr><td><b>C, Alt + click</b></td><td>copy the paint at that point to the brush</td></tr>"
      "<tr><td><b>Esc</b></td><td>cancel the stroke</td></tr>"
      "<tr><td><b>Ctrl + Z, Ctrl + Shift + Z</b></td><td>undo, redo</td></tr>"
      "<tr><td><b>Ctrl + Shift + P</b></td><td>search the actions</td></tr>"
      "<tr><td><b>Ctrl + E</b></td><td>export or copy a picture</td></tr>"
      "<tr><td><b>Ctrl + R</b></td><td>record the forces, and save them</td></tr></table>");
}

// Scrolls, because the list is higher than a small screen.
void showShortcuts(QMainWindow* window) {
  auto* dialog = new QDialog(window);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Mouse and keys"));
  auto* text = new QTextBrowser;
  text->setHtml(shortcutsText());
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok);
  QObject::connect(buttons, &QDialogButtonBox::accepted, dialog, &QDialog::accept);
  auto* column = new QVBoxLayout(dialog);
  column->addWidget(text);
  column->addWidget(buttons);
  dialog->resize(QSize(640, 600).boundedTo(window->size()));
  dialog->open();
}

QString signed_(ViewPreset preset) {
  QString words = shownText(name(preset));
  return words == QStringLiteral("iso") ? QMainWindow::tr("At an angle")
                                        : words.replace('-', QStringLiteral("−"));
}

// Sets the tooltip: name, key and explanation.
void describe(QAction& action) {
  const QString words_only = withoutMarks(action.text());
  const QString key = action.shortcut().toString(QKeySequence::NativeText);
  QString words = QStringLiteral("<b>%1</b>").arg(words_only);
  if (!key.isEmpty()) words += QStringLiteral(" (%1)").arg(key);
  if (action.toolTip() != words_only) words += QStringLiteral("<br>") + action.toolTip();
  if (!words_only.isEmpty()) action.setToolTip(words);
}

QAction* addCheckable(QMenu& menu, const char* name, const QString& words,
                      const QKeySequence& key = {}, const QString& tip = {}) {
  QAction* action = named(menu.addAction(words), name, tip);
  action->setCheckable(true);
  action->setShortcut(key);
  return action;
}

void addFileMenu(QMainWindow& window, WindowParts& parts, const Controllers& at, QToolBar& bar) {
  QMenu* file = window.menuBar()->addMenu(tr("&File"));
  DocumentController* documents = &at.documents;
  QAction* open = file->addAction(
      tr("&Open…"), documents, [=] { documents->openDialog(false); }, QKeySequence::Open);
  open->setToolTip(tr("A mesh, a volume or a workspace"));
  bar.addAction(open);
  QAction* add = file->addAction(
      tr("&Add object…"), documents, [=] { documents->openDialog(true); },
      Qt::CTRL | Qt::SHIFT | Qt::Key_O);
  add->setToolTip(tr("Adds a mesh or volume to the open scene"));
  file->addAction(tr("Open s&can…"), parts.scan, &ScanDesk::openDialog)
      ->setToolTip(tr("A folder of a camera's frames, poses and a probe's stream"));
  file->addMenu(parts.recent);
  file->addAction(tr("Open the toy &dinosaur"), documents, [=] { documents->openRequested({}); });
  file->addSeparator();
  QAction* save =
      file->addAction(tr("&Save"), &at.saving, &SaveController::save, QKeySequence::Save);
  save->setToolTip(tr("Saves to the open workspace, or to a new one"));
  parts.commands[Command::save] = save;
  parts.commands[Command::save_as] =
      file->addAction(tr("Save workspace &as…"), &at.saving, &SaveController::saveDialog,
                      Qt::CTRL | Qt::SHIFT | Qt::Key_S);
  QAction* exported =
      file->addAction(tr("Export for &ParaView…"), &at.saving, &SaveController::exportDialog);
  exported->setToolTip(tr("Mesh, surface, field, paint and images, and scene.vtm that opens them"));
  parts.commands[Command::export_scene] = exported;
  SaveController* saving = &at.saving;
  QAction* mesh =
      file->addAction(tr("Export &mesh…"), saving, [=] { saving->exportMeshDialog(false); });
  named(mesh, "export_mesh", tr("The triangles as they were read, as .ply, .obj or .stl in mm"));
  parts.commands[Command::export_mesh] = mesh;
  QAction* embossed = file->addAction(tr("Export mesh with relief…"), saving,
                                      [=] { saving->exportMeshDialog(true); });
  named(embossed, "export_relief",
        tr("The surface with its painted relief as a new mesh, as patina emboss"));
  parts.commands[Command::export_relief] = embossed;
  file->addAction(tr("&Export picture…"), &at.view, &ViewController::exportPicture,
                  QKeySequence("Ctrl+E"))
      ->setToolTip(
          tr("PNG, TIFF, SVG or PDF at any size and resolution, with any background; or a copy"));
  QAction* video = file->addAction(tr("Export &video…"), &at.view, &ViewController::exportVideo);
  named(video, "export_video", tr("Replays a recording over the open scene, as an .ogv file"));
  parts.commands[Command::export_video] = video;
  QAction* record = addCheckable(*file, "record", tr("&Record forces"), QKeySequence("Ctrl+R"),
                                 tr("Records every tick, then saves a CSV table"));
  QObject::connect(record, &QAction::triggered, &at.feel, &FeelController::toggleRecording);
  parts.commands[Command::record] = record;
  FeelController* feel = &at.feel;
  QAction* none = addCheckable(
      *file, "no_force", tr("&No force"), Qt::Key_F4,
      tr("Switches the device's force off until you clear this option. The tool still follows the "
         "hand."));
  QObject::connect(none, &QAction::toggled, feel, [feel](bool on) { feel->setForce(!on); });
  QObject::connect(feel, &FeelController::forceSet, none,
                   [none](bool on) { none->setChecked(!on); });
  QAction* held =
      addCheckable(*file, "force_by_button", tr("Force only while a &button is held"), {},
                   tr("For devices with buttons: releasing the handle switches the force off"));
  QObject::connect(held, &QAction::toggled, feel, &FeelController::setNeedsButton);
  file->addSeparator();
  file->addAction(tr("&Quit"), &window, &QWidget::close, QKeySequence::Quit);
  bar.addAction(save);
  bar.addSeparator();
}

void addEditMenu(QMainWindow& window, WindowParts& parts, const Controllers& at, QToolBar& bar) {
  QMenu* edit = window.menuBar()->addMenu(tr("&Edit"));
  EditController* edits = &at.edits;
  // Each desk has its own history; on Align that of the pose.
  const auto there = [desks = &at.desks, align = parts.align] {
    return desks->desk() == Desk::align ? align : nullptr;
  };
  QAction* undo = edit->addAction(
      tr("&Undo"), edits,
      [=] {
        if (AlignDesk* align = there()) return align->undo();
        edits->undo();
      },
      QKeySequence::Undo);
  QAction* redo = edit->addAction(tr("&Redo"), edits, [=] {
    if (AlignDesk* align = there()) return align->redo();
    edits->thread().redo();
  });
  redo->setShortcuts({QKeySequence("Ctrl+Shift+Z"), QKeySequence("Ctrl+Y")});
  parts.commands[Command::undo] = undo;
  parts.commands[Command::redo] = redo;
  edit->addSeparator();
  edit->addActions(parts.tools->actionsOfTools());
  edit->addSeparator();
  PaintController* paint = &at.paint;
  const auto add = [&](const QString& words, const QList<QKeySequence>& keys, auto act) {
    edit->addAction(words, paint, act)->setShortcuts(keys);
  };
  // Some keyboards send a brace for Shift and a bracket.
  add(tr("Smaller brush"), {Qt::Key_BracketLeft}, [=] { paint->resizeBrush(1 / 1.15); });
  add(tr("Larger brush"), {Qt::Key_BracketRight}, [=] { paint->resizeBrush(1.15); });
  add(tr("Softer brush"), {QKeySequence("Shift+["), Qt::Key_BraceLeft},
      [=] { paint->softenBrush(1 / 1.15); });
  add(tr("Harder brush"), {QKeySequence("Shift+]"), Qt::Key_BraceRight},
      [=] { paint->softenBrush(1.15); });
  edit->addSeparator();
  QMainWindow* owner = &window;
  edit->addAction(
          tr("&Preferences…"), owner,
          [owner] { (new PreferencesDialog(owner, [owner] { showShortcuts(owner); }))->open(); },
          QKeySequence("Ctrl+,"))
      ->setToolTip(tr("Theme, upper axis of mesh files, folder of file dialogs, keys"));
  bar.addActions({undo, redo});
  bar.addSeparator();
}

void addThings(QMenu& menu, DisplayPanel* display) {
  const std::pair<const char*, QKeySequence> keys[] = {{"mesh", Qt::Key_M},
                                                       {"tip", Qt::Key_T},
                                                       {"slice", Qt::Key_S},
                                                       {"iso", Qt::Key_I},
                                                       {"wireframe", Qt::Key_W},
                                                       {"nodes", Qt::Key_N},
                                                       {"band", Qt::Key_B},
                                                       {"extent", Qt::Key_E},
                                                       {"stability", Qt::Key_K},
                                                       {"scale", Qt::Key_L},
                                                       {"clip", QKeySequence("Shift+S")}};
  for (const auto& [thing, key] : keys) {
    QAction* action = addCheckable(menu, (std::string("show_") + thing).c_str(),
                                   tr("Show %1").arg(display->caption(thing).toLower()), key);
    action->setChecked(display->isShown(thing));
    QObject::connect(
        action, &QAction::toggled, display,
        [display, thing = std::string(thing)](bool on) { display->setShown(thing, on); });
    QObject::connect(display, &DisplayPanel::shownChanged, action,
                     [action, thing = std::string(thing)](const std::string& changed, bool on) {
                       if (changed == thing) action->setChecked(on);
                     });
  }
}

void addViewMenu(QMainWindow& window, WindowParts& parts, const Controllers& at, QToolBar& bar) {
  QMenu* menu = window.menuBar()->addMenu(tr("&View"));
  menu->addAction(tr("Navigate, or back to the tool"), parts.tools, &ToolBar::toggleNavigation,
                  Qt::Key_Space);
  menu->addSeparator();
  ViewController* view = &at.view;
  ScanCentralViews* scan = parts.scan->centralViews();
  TextureDesk* texture = parts.texture;
  const auto fit = [=, align = parts.align->centralViews()] {
    view->view().fit();
    scan->fit();
    texture->fit();
    align->fit();
  };
  bar.addAction(menu->addAction(tr("&Fit"), view, fit, Qt::Key_F));
  QMenu* camera = menu->addMenu(tr("&Camera"));
  int digit = Qt::Key_1;
  for (const ViewPreset preset : allViews()) {
    const auto turn = [=] {
      view->view().setView(preset);
      scan->setView(preset);
      texture->setView(preset);
    };
    camera->addAction(signed_(preset), view, turn, digit++)
        ->setObjectName(QStringLiteral("view_") + shownText(name(preset)));
  }
  camera->addSeparator();
  QAction* parallel = addCheckable(*camera, "orthographic", tr("Orthographic"), Qt::Key_O,
                                   tr("Parallel projection: size does not depend on distance"));
  QObject::connect(parallel, &QAction::toggled, view, [view](bool on) {
    setParallel(*view->view().renderer().GetActiveCamera(), on);
  });
  QAction* hand = addCheckable(
      *camera, "camera_hand", tr("Moved by a SpaceMouse"), {},
      tr("The scene follows the cap of a SpaceMouse, whichever device gives the force"));
  QObject::connect(hand, &QAction::toggled, view, [view](bool on) {
    view->setCameraHand(on ? std::make_unique<CameraHand>() : nullptr);
  });
  camera->menuAction()->setToolTip(tr("Look from a side: keys 1 to 7"));
  menu->addSeparator();
  addThings(*menu, parts.display);
  menu->addSeparator();
  menu->addActions(at.desks.actions());
  QAction* guide =
      addCheckable(*menu, "guide", tr("Guide from a scan to a feel"), {},
                   tr("A line over Scan, Align and Texture: finished steps, and the next one"));
  guide->setChecked(parts.guide->isOpen());
  QObject::connect(guide, &QAction::toggled, parts.guide, &GuideStrip::setOpen);
  QObject::connect(parts.guide, &GuideStrip::openChanged, guide, &QAction::setChecked);
  DeskController* desks = &at.desks;
  FoldingTabs *column = parts.side_panel, *bottom_panel = parts.bottom_panel;
  menu->addAction(
      tr("Folds or opens the side panel"), desks, [=] { desks->foldSidePanel(!column->folded()); },
      Qt::Key_F8);
  menu->addAction(
      tr("Folds or opens the bottom panel"), desks,
      [=] { desks->foldBottomPanel(!bottom_panel->folded()); }, Qt::Key_F9);
  bar.addSeparator();
  bar.addAction(parts.commands[Command::record]);
  bar.widgetForAction(parts.commands[Command::record])
      ->setObjectName(QStringLiteral("record_button"));
}

void addHelpMenu(QMainWindow* window, const std::function<void()>& search) {
  QMenu* help = window->menuBar()->addMenu(tr("&Help"));
  const auto tell = [window](const QString& title, const QString& words) {
    auto* box = new QMessageBox(QMessageBox::NoIcon, title, words, QMessageBox::Ok, window);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->open();
  };
  help->addAction(tr("&User guide"), window, [window] { showGuide(*window); })
      ->setToolTip(tr("Describes each desk"));
  help->addAction(tr("&Search actions…"), window, search, Qt::CTRL | Qt::SHIFT | Qt::Key_P);
  help->addAction(
      tr("&Mouse and keys"), window, [window] { showShortcuts(window); }, Qt::Key_F1);
  help->addAction(tr("&About Patina"), window, [tell] {
    tell(tr("About Patina"),
         tr("<h3>Patina %1</h3><p>A mesh becomes a sampled implicit surface, and a 1 kHz servo "
            "feels it.</p><p>BSD-3-Clause. Built on VTK, Qt, Eigen, OpenMesh and TBB.</p>")
             .arg(QString::fromStdString(versionText())));
  });
}

} // namespace

void MainWindow::searchActions() {
  std::vector<ActionSearch::Settings> panels;
  for (const auto& [panel, widget] : parts_.panels) {
    const bool is_there =
        std::any_of(deskRows().begin(), deskRows().end(), [&, panel = panel](const DeskRow& row) {
          WindowState there = state();
          there.desk = row.desk;
          return isThere(panel, there);
        });
    if (tabOf(panel)) panels.push_back({panel, widget, is_there});
  }
  (new ActionSearch(*this, panels, [this](Panel panel) { desks_.show(panel); }))->open();
}

void MainWindow::addMenus() {
  QToolBar* bar = addToolBar(tr("View"));
  bar->setObjectName(QStringLiteral("tools"));
  bar->setMovable(false);
  bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
  applyStyleSheet(
      *bar,
      QStringLiteral(
          "QToolBar { border: none; border-bottom: 1px solid @line; padding: 1px 6px; spacing: "
          "2px; }"
          "QToolButton { padding: 3px 8px; border: 1px solid transparent; border-radius: 4px; }"
          "QToolButton:hover { background: @hover; }"
          "QToolButton:checked { background: @strong; color: white; }"
          "QToolButton#record_button:checked { background: @recording; }"
          "QToolButton::menu-indicator { subcontrol-position: bottom right; }"));
  bar->addActions(desks_.actions());
  bar->addSeparator();
  addFileMenu(*this, parts_, controllers(), *bar);
  addEditMenu(*this, parts_, controllers(), *bar);
  addViewMenu(*this, parts_, controllers(), *bar);
  addHelpMenu(this, [this] { searchActions(); });
  for (QAction* action : findChildren<QAction*>()) describe(*action);
}

} // namespace patina

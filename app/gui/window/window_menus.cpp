#include "app/gui/window/window_menus.h"

#include <QDialogButtonBox>
#include <QMenuBar>
#include <QMessageBox>
#include <QTextBrowser>
#include <QToolBar>
#include <QVBoxLayout>

#include "app/gui/control/desk_controller.h"
#include "app/gui/control/document_controller.h"
#include "app/gui/control/edit_controller.h"
#include "app/gui/control/feel_controller.h"
#include "app/gui/control/view_controller.h"
#include "app/gui/loading/up_choice.h"
#include "app/gui/painting/paint_controller.h"
#include "app/gui/widgets/words.h"
#include "app/gui/window/action_search.h"
#include "app/gui/window/theme.h"
#include "app/gui/window/user_guide.h"
#include "core/version.h"
#include "visualization/view/camera.h"
#ifdef PATINA_HAS_ACQUISITION
#include "app/gui/aligning/align_desk.h"
#include "app/gui/scanning/scan_desk.h"
#include "app/gui/texturing/texture_desk.h"
#endif

namespace patina {
namespace {

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
      "<tr><td><b>Shift + S</b></td><td>clip plane: cuts away what lies ahead of it</td></tr>"
      "<tr><td><b>V A P H D G J U X</b></td><td>feel, navigate, paint, relief, stiffness, "
      "friction, "
      "damping, roughness, erase</td></tr>"
      "<tr><td><b>Ctrl + 0, 8, 9, 1, 2, 3</b></td><td>the desks Scan, Align, Texture, Feel, Paint, "
      "Analyse</td></tr>"
      "<tr><td><b>← →, Page up, down</b></td><td>one frame of a scan back or on, ten</td></tr>"
      "<tr><td><b>F4</b></td><td>no force, until it is pressed again</td></tr>"
      "<tr><td><b>F8, F9</b></td><td>fold the column, the drawer</td></tr>"
      "<tr><td><b>[ ]</b></td><td>brush smaller, larger; with Shift its fall-off</td></tr>"
      "<tr><td><b>C, Alt + click</b></td><td>take what is painted there into the brush</td></tr>"
      "<tr><td><b>Esc</b></td><td>take back the stroke that is being painted</td></tr>"
      "<tr><td><b>Ctrl + Z, Ctrl + Shift + Z</b></td><td>undo, redo</td></tr>"
      "<tr><td><b>Ctrl + Shift + P</b></td><td>search in all that can be done</td></tr>"
      "<tr><td><b>R</b></td><td>record the forces, and save them</td></tr></table>");
}

QString signed_(ViewPreset preset) {
  QString words = QString::fromUtf8(name(preset).data(), static_cast<int>(name(preset).size()));
  return words == QStringLiteral("iso") ? QMainWindow::tr("At an angle")
                                        : words.replace('-', QStringLiteral("−"));
}

// What it is called, its key, and what there is to say.
void describe(QAction& action) {
  const QString plain = action.text().remove('&').remove(QStringLiteral("…"));
  const QString key = action.shortcut().toString(QKeySequence::NativeText);
  QString words = QStringLiteral("<b>%1</b>").arg(plain);
  if (!key.isEmpty()) words += QStringLiteral(" (%1)").arg(key);
  if (action.toolTip() != plain) words += QStringLiteral("<br>") + action.toolTip();
  if (!plain.isEmpty()) action.setToolTip(words);
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
  add->setToolTip(tr("A mesh or volume that is felt together with what is open"));
#ifdef PATINA_HAS_ACQUISITION
  file->addAction(tr("Open s&can…"), parts.scan, &ScanDesk::openDialog)
      ->setToolTip(tr("A folder of a camera's frames, poses and a probe's stream"));
#endif
  file->addMenu(parts.recent);
  file->addAction(tr("Open the toy &dinosaur"), documents, [=] { documents->openAsked({}); });
  QAction* y_up = file->addAction(tr("&Y is up in mesh files"));
  y_up->setObjectName(QStringLiteral("y_up"));
  y_up->setToolTip(tr("Meshes that are opened from now on are turned so that their y is up"));
  y_up->setCheckable(true);
  y_up->setChecked(rememberedUp() == UpAxis::y);
  QObject::connect(y_up, &QAction::toggled, documents,
                   [](bool on) { rememberUp(on ? UpAxis::y : UpAxis::z); });
  QObject::connect(documents, &DocumentController::changed, y_up,
                   [=] { y_up->setChecked(rememberedUp() == UpAxis::y); });
  file->addSeparator();
  QAction* save =
      file->addAction(tr("&Save"), &at.saving, &SaveController::save, QKeySequence::Save);
  save->setToolTip(tr("Into the workspace that is open, or into a new one"));
  parts.commands[Command::save] = save;
  parts.commands[Command::save_as] =
      file->addAction(tr("Save workspace &as…"), &at.saving, &SaveController::saveDialog,
                      Qt::CTRL | Qt::SHIFT | Qt::Key_S);
  QAction* exported =
      file->addAction(tr("Export for &ParaView…"), &at.saving, &SaveController::exportDialog);
  exported->setToolTip(tr("Mesh, surface, field, paint and images, and scene.vtm that opens them"));
  parts.commands[Command::export_scene] = exported;
  file->addAction(tr("&Export picture…"), &at.view, &ViewController::exportPicture);
  QAction* record = file->addAction(tr("&Record forces"));
  record->setObjectName(QStringLiteral("record"));
  record->setCheckable(true);
  record->setShortcut(Qt::Key_R);
  record->setToolTip(tr("Record every tick, then save a CSV table"));
  QObject::connect(record, &QAction::triggered, &at.feel, &FeelController::toggleRecording);
  parts.commands[Command::record] = record;
  FeelController* feel = &at.feel;
  QAction* none = file->addAction(tr("&No force"));
  none->setObjectName(QStringLiteral("no_force"));
  none->setCheckable(true);
  none->setShortcut(Qt::Key_F4);
  none->setToolTip(tr("The device gives none until this is taken back; the tip follows"));
  QObject::connect(none, &QAction::toggled, feel, [feel](bool on) { feel->setForce(!on); });
  QAction* held = file->addAction(tr("Force only while a &button is held"));
  held->setObjectName(QStringLiteral("force_by_button"));
  held->setCheckable(true);
  held->setToolTip(tr("Of a device with buttons: a handle that is let go gives none"));
  QObject::connect(held, &QAction::toggled, feel, &FeelController::setNeedsButton);
  file->addSeparator();
  file->addAction(tr("&Quit"), &window, &QWidget::close, QKeySequence::Quit);
  bar.addAction(save);
  bar.addSeparator();
}

void addEditMenu(QMainWindow& window, WindowParts& parts, const Controllers& at, QToolBar& bar) {
  QMenu* edit = window.menuBar()->addMenu(tr("&Edit"));
  EditController* edits = &at.edits;
#ifdef PATINA_HAS_ACQUISITION
  // Each desk's own history: on Align that of the path's place.
  const auto there = [desks = &at.desks, align = parts.align] {
    return desks->desk() == Desk::align ? align : nullptr;
  };
#endif
  QAction* undo = edit->addAction(
      tr("&Undo"), edits,
      [=] {
#ifdef PATINA_HAS_ACQUISITION
        if (AlignDesk* align = there()) return align->undo();
#endif
        edits->thread().undo();
      },
      QKeySequence::Undo);
  QAction* redo = edit->addAction(tr("&Redo"), edits, [=] {
#ifdef PATINA_HAS_ACQUISITION
    if (AlignDesk* align = there()) return align->redo();
#endif
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
  // On keyboards where Shift makes a brace of a bracket the key is the brace.
  add(tr("Smaller brush"), {Qt::Key_BracketLeft}, [=] { paint->resizeBrush(1 / 1.15); });
  add(tr("Larger brush"), {Qt::Key_BracketRight}, [=] { paint->resizeBrush(1.15); });
  add(tr("Softer brush"), {QKeySequence("Shift+["), Qt::Key_BraceLeft},
      [=] { paint->softenBrush(1 / 1.15); });
  add(tr("Harder brush"), {QKeySequence("Shift+]"), Qt::Key_BraceRight},
      [=] { paint->softenBrush(1.15); });
  bar.addActions({undo, redo});
  bar.addSeparator();
}

void addLayers(QMenu& menu, DisplayPanel* display) {
  const std::pair<Layer, int> keys[] = {{Layer::mesh, Qt::Key_M},      {Layer::tip, Qt::Key_T},
                                        {Layer::slice, Qt::Key_S},     {Layer::iso, Qt::Key_I},
                                        {Layer::wireframe, Qt::Key_W}, {Layer::nodes, Qt::Key_N},
                                        {Layer::band, Qt::Key_B},      {Layer::extent, Qt::Key_E},
                                        {Layer::stability, Qt::Key_K}, {Layer::scale, Qt::Key_L}};
  for (const auto& [layer, key] : keys) {
    QAction* action = menu.addAction(tr("Show %1").arg(display->caption(layer).toLower()));
    action->setCheckable(true);
    action->setChecked(display->shown(layer));
    action->setShortcut(key);
    QObject::connect(action, &QAction::toggled, display,
                     [display, layer = layer](bool on) { display->setShown(layer, on); });
    QObject::connect(display, &DisplayPanel::layerToggled, action,
                     [action, layer = layer](Layer toggled, bool on) {
                       if (toggled == layer) action->setChecked(on);
                     });
  }
}

void addClip(QMenu& menu, QCheckBox& box) {
  QAction* clip = menu.addAction(QMainWindow::tr("Show clip plane"));
  clip->setObjectName(QStringLiteral("show_clip"));
  clip->setCheckable(true);
  clip->setShortcut(QKeySequence("Shift+S"));
  QObject::connect(clip, &QAction::toggled, &box, &QCheckBox::setChecked);
  QObject::connect(&box, &QCheckBox::toggled, clip, &QAction::setChecked);
}

void addViewMenu(QMainWindow& window, WindowParts& parts, const Controllers& at, QToolBar& bar) {
  QMenu* menu = window.menuBar()->addMenu(tr("&View"));
  menu->addAction(tr("Navigate, or back to the tool"), parts.tools, &ToolBar::toggleNavigation,
                  Qt::Key_Space);
  menu->addSeparator();
  ViewController* view = &at.view;
  bar.addAction(menu->addAction(
      tr("&Fit"), view, [=] { view->view().fit(); }, Qt::Key_F));
#ifdef PATINA_HAS_ACQUISITION
  QObject::connect(menu->actions().back(), &QAction::triggered, parts.scan->cells(),
                   &ScanCells::fit);
  QObject::connect(menu->actions().back(), &QAction::triggered, parts.texture, &TextureDesk::fit);
  QObject::connect(menu->actions().back(), &QAction::triggered, parts.align->cells(),
                   &AlignCells::fit);
#endif
  QMenu* camera = menu->addMenu(tr("&Camera"));
  int digit = Qt::Key_1;
  for (const ViewPreset preset : allViews())
    camera
        ->addAction(
            signed_(preset), view, [=] { view->view().setView(preset); }, digit++)
        ->setObjectName(QStringLiteral("view_") +
                        QString::fromStdString(std::string(name(preset))));
#ifdef PATINA_HAS_ACQUISITION
  for (const ViewPreset preset : allViews())
    QObject::connect(camera->actions()[static_cast<int>(preset)], &QAction::triggered, parts.scan,
                     [scan = parts.scan, texture = parts.texture, preset] {
                       scan->cells()->setView(preset);
                       texture->setView(preset);
                     });
#endif
  camera->addSeparator();
  QAction* parallel = camera->addAction(tr("Orthographic"));
  parallel->setObjectName(QStringLiteral("orthographic"));
  parallel->setCheckable(true);
  parallel->setShortcut(Qt::Key_O);
  parallel->setToolTip(tr("Without perspective: what is far is as large as what is near"));
  QObject::connect(parallel, &QAction::toggled, view, [view](bool on) {
    setParallel(*view->view().renderer().GetActiveCamera(), on);
  });
  QAction* hand = camera->addAction(tr("Moved by a SpaceMouse"));
  hand->setObjectName(QStringLiteral("camera_hand"));
  hand->setCheckable(true);
  hand->setToolTip(tr("What you look at goes with its cap, whatever else feels"));
  QObject::connect(hand, &QAction::toggled, view, [view](bool on) {
    view->setCameraHand(on ? std::make_unique<CameraHand>() : nullptr);
  });
  camera->menuAction()->setToolTip(tr("Look from a side: keys 1 to 7"));
  menu->addSeparator();
  addLayers(*menu, parts.display);
  addClip(*menu, parts.display->clip());
  menu->addSeparator();
  menu->addActions(at.desks.actions());
#ifdef PATINA_HAS_ACQUISITION
  QAction* guide = menu->addAction(tr("Guide from a scan to a feel"));
  guide->setObjectName(QStringLiteral("guide"));
  guide->setToolTip(tr("A line over Scan, Align and Texture: what is done, and what is next"));
  guide->setCheckable(true);
  guide->setChecked(parts.guide->isOpen());
  QObject::connect(guide, &QAction::toggled, parts.guide, &GuideStrip::setOpen);
  QObject::connect(parts.guide, &GuideStrip::openChanged, guide, &QAction::setChecked);
#endif
  DeskController* desks = &at.desks;
  FoldingTabs *column = parts.column, *drawer = parts.drawer;
  menu->addAction(
      tr("Fold the column, or open it"), desks, [=] { desks->foldColumn(!column->folded()); },
      Qt::Key_F8);
  menu->addAction(
      tr("Fold the drawer, or open it"), desks, [=] { desks->foldDrawer(!drawer->folded()); },
      Qt::Key_F9);
  bar.addSeparator();
  bar.addAction(parts.commands[Command::record]);
  bar.widgetForAction(parts.commands[Command::record])
      ->setObjectName(QStringLiteral("record_button"));
}

// Longer than a small screen is high: it is scrolled.
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

void addHelpMenu(QMainWindow* window) {
  QMenu* help = window->menuBar()->addMenu(tr("&Help"));
  const auto tell = [window](const QString& title, const QString& words) {
    auto* box = new QMessageBox(QMessageBox::NoIcon, title, words, QMessageBox::Ok, window);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->open();
  };
  help->addAction(tr("&User guide"), window, [window] { showGuide(*window); })
      ->setToolTip(tr("What each desk does, and how"));
  help->addAction(
      tr("&Search actions…"), window, [window] { searchActions(*window); },
      Qt::CTRL | Qt::SHIFT | Qt::Key_P);
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

void addMenus(QMainWindow& window, WindowParts& parts, const Controllers& controllers) {
  QToolBar* bar = window.addToolBar(tr("View"));
  bar->setObjectName(QStringLiteral("tools"));
  bar->setMovable(false);
  bar->setToolButtonStyle(Qt::ToolButtonTextOnly);
  dress(*bar,
        QStringLiteral(
            "QToolBar { border: none; border-bottom: 1px solid @line; padding: 1px 6px; spacing: "
            "2px; }"
            "QToolButton { padding: 3px 8px; border: 1px solid transparent; border-radius: 4px; }"
            "QToolButton:hover { background: @hover; }"
            "QToolButton:checked { background: @strong; color: white; }"
            "QToolButton#record_button:checked { background: @recording; }"
            "QToolButton::menu-indicator { subcontrol-position: bottom right; }"));
  bar->addActions(controllers.desks.actions());
  bar->addSeparator();
  addFileMenu(window, parts, controllers, *bar);
  addEditMenu(window, parts, controllers, *bar);
  addViewMenu(window, parts, controllers, *bar);
  addHelpMenu(&window);
  for (QAction* action : window.findChildren<QAction*>()) describe(*action);
}

} // namespace patina

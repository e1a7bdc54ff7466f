#include "app/gui/control/document_controller.h"

#include <QDragEnterEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QMimeData>
#include <QSettings>
#include <QUrl>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/loading/presets.h"
#include "app/gui/loading/up_choice.h"
#include "app/gui/loading/workspace_file_dialog.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "geometry/io/mesh_io.h"
#include "session/open/mesh_export.h"
#include "session/open/scene_export.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

constexpr int kKept = 8;
const QString kKey = QStringLiteral("recent_files");

QString fileNameOf(const std::filesystem::path& path) {
  return QString::fromStdString(path.filename().string());
}

QString wordsFor(const LoadRequest& request) {
  return !request.place.empty() ? DocumentController::tr("the recovered scene")
         : request.path.empty() ? presetOf(request).words
                                : fileNameOf(request.path);
}

LoadRequest requestFor(const QString& path) {
  LoadRequest request;
  request.path = path.toStdString();
  request.options.up = rememberedUp();
  return request;
}

bool opensElsewhere(const DocumentController::Parts& at, RecentFiles& recent,
                    const LoadRequest& request) {
  if (request.path.empty() || !at.open_other || !at.open_other(request.path)) return false;
  recent.add(QString::fromStdString(request.path.string()));
  return true;
}

} // namespace

QString SaveController::name() const {
  const auto& folder = edits_.status().folder;
  return folder ? QString::fromStdString(folder->filename().string()) : name_;
}

bool SaveController::trySaving(const std::function<void()>& save, const QString& where,
                               const QString& advice) {
  try {
    save();
    emit notified({tr("Saved %1").arg(where)});
    return true;
  } catch (const Cancelled&) {
    return false;
  } catch (const std::exception& error) {
    showProblem(&window_, tr("The workspace cannot be saved"), QString::fromStdString(error.what()),
                advice);
    return false;
  }
}

void SaveController::saveTo(const QString& folder) {
  if (!edits_.scene()) throw Error("there is no scene to save");
  edits_.previewValues(); // Includes changes since the last tick.
  edits_.waitFor([&](EditThread::Done done) {
    edits_.thread().saveAs(folder.toStdString(), std::move(done));
  });
  emit saved(folder);
}

bool SaveController::save() {
  if (!edits_.scene()) return false;
  if (!edits_.status().folder) return saveDialog();
  const auto save = [this] {
    edits_.previewValues();
    edits_.waitFor([this](EditThread::Done done) { edits_.thread().save(std::move(done)); });
  };
  const auto folder = std::filesystem::absolute(*edits_.status().folder);
  return trySaving(save, QString::fromStdString(folder.string()),
                   tr("Nothing is lost. Free some disk space, or save to another folder."));
}

bool SaveController::saveDialog() {
  WorkspaceFileDialog dialog(&window_, tr("Save the workspace as a folder"),
                             WorkspaceFileDialog::For::saving);
  // The dialog starts next to the open workspace, not in it.
  if (const auto& own = edits_.status().folder)
    dialog.setDirectory(QString::fromStdString(std::filesystem::absolute(*own).parent_path()));
  dialog.selectFile(freeName(dialog.directory().path().toStdString(), name()));
  QString folder;
  connect(&dialog, &WorkspaceFileDialog::chosen, this, [&](const QString& path) { folder = path; });
  dialog.exec();
  if (folder.isEmpty()) return false;
  if (const auto around = workspaceAround(folder.toStdString()); !around.empty()) {
    showProblem(&window_, tr("The workspace cannot be saved there"),
                tr("%1 is a workspace itself.").arg(QString::fromStdString(around.string())),
                tr("Choose a folder outside of it."));
    return false;
  }
  return trySaving([&] { saveTo(folder); }, folder, tr("Choose a folder with write permission."));
}

void SaveController::exportDialog() {
  if (!edits_.scene()) return;
  QFileDialog dialog(&window_, tr("Export into a folder, for ParaView"));
  dialog.setObjectName(QStringLiteral("export_dialog"));
  dialog.setOption(QFileDialog::DontUseNativeDialog);
  dialog.setOption(QFileDialog::DontConfirmOverwrite);
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setFileMode(QFileDialog::AnyFile);
  beginInLastFolder(dialog);
  dialog.selectFile(name().section('.', 0, 0) + QStringLiteral("-paraview"));
  if (dialog.exec() == QDialog::Accepted) exportTo(dialog.selectedFiles().front());
}

void SaveController::exportTo(const QString& folder) {
  const auto run = [folder, scene = edits_.scene()](Progress& progress) -> Message {
    std::string noted;
    const auto files = patina::exportScene(
        *scene, folder.toStdString(),
        {.warn = [&](const std::string& line) { noted += "; " + line; }}, progress);
    return {tr("Exported %1 files to %2; open scene.vtm%3")
                .arg(files.size())
                .arg(folder, QString::fromStdString(noted)),
            !noted.empty(), folder};
  };
  queueExport(folder, tr("Choose a new folder, inside one with write permission."), run);
}

void SaveController::exportMeshDialog(bool with_relief) {
  if (!edits_.scene()) return;
  const auto write = [this, with_relief](const QString& path) {
    const auto run = [path, with_relief, scene = edits_.scene()](Progress& progress) -> Message {
      const TriangleMesh mesh =
          with_relief ? embossedMesh(scene->scene, progress).mesh : worldMesh(scene->scene);
      progress.throwIfCancelled();
      writeMeshIn(path.toStdString(), mesh, MeshUnit::mm);
      return {tr("Exported %1 triangles in mm to %2")
                  .arg(shownText(formatCount(mesh.triangles.size())), path),
              false, path};
    };
    queueExport(path,
                tr("Choose a folder with write permission, and a name that ends in .ply, .obj or "
                   ".stl."),
                run);
  };
  auto* dialog = patina::saveDialog(
      &window_, with_relief ? tr("Export the mesh with relief") : tr("Export the mesh"),
      tr("Meshes (*.ply *.obj *.stl)"), name().section('.', 0, 0) + QStringLiteral(".ply"), write);
  dialog->setObjectName(QStringLiteral("mesh_file"));
  dialog->open();
}

void SaveController::queueExport(const QString& where, const QString& advice, Export run) {
  waiting_.push_back({where, advice, std::move(run)});
  if (exports_.busy())
    emit notified({tr("The export to %1 starts after the running one").arg(where)});
  exportNext();
}

void SaveController::exportNext() {
  if (waiting_.empty() || exports_.busy()) return;
  const WaitingExport next = std::move(waiting_.front());
  waiting_.pop_front();
  emit notified({tr("Exporting to %1 …").arg(next.where)});
  exports_.start([this, next](Progress& progress, const Background::Post& post) {
    try {
      post(true, [this, message = next.run(progress)] {
        emit notified(message);
        exportNext();
      });
    } catch (const std::exception& error) {
      post(true, [this, words = QString::fromStdString(error.what()), advice = next.advice] {
        showProblem(&window_, tr("The scene cannot be exported"), words, advice);
        exportNext();
      });
    }
  });
}

bool SaveController::confirmEdits() {
  edits_.waitForEdits(); // An edit that saves the other state may be running.
  if (!unsaved_guard_.confirm()) return false;
  edits_.waitForEdits(); // A stroke may not be in the history yet.
  while (edits_.unsaved()) {
    const int answer = askToSave(&window_, "unsaved_edits", tr("The edits are not saved"),
                                 (edits_.status().folder ? tr("%1 has changed since it was saved.")
                                                         : tr("%1 is in no workspace yet."))
                                     .arg(name()));
    if (answer == QMessageBox::Save) {
      save();
      continue;
    }
    if (answer == QMessageBox::Discard) discard();
    return answer == QMessageBox::Discard;
  }
  return true;
}

void SaveController::discard() {
  if (!edits_.status().folder) return;
  try {
    edits_.waitFor([this](EditThread::Done done) { edits_.thread().discard(std::move(done)); });
  } catch (const Cancelled&) { // The edits stay, as the user has cancelled.
  } catch (const std::exception& error) {
    showProblem(&window_, tr("The edits stay in the workspace"),
                QString::fromStdString(error.what()), tr("They can be undone later."));
  }
}

QStringList RecentFiles::paths() const {
  return QSettings().value(kKey).toStringList();
}

void RecentFiles::add(const QString& path) {
  const QString absolute = QFileInfo(path).absoluteFilePath();
  QStringList list = paths();
  list.removeAll(absolute);
  list.prepend(absolute);
  while (list.size() > kKept) list.removeLast();
  QSettings().setValue(kKey, list);
  rebuild();
}

void RecentFiles::rebuild() {
  menu_.clear();
  for (const QString& path : paths()) {
    QAction* action = menu_.addAction(QFileInfo(path).fileName());
    action->setToolTip(path);
    connect(action, &QAction::triggered, this, [this, path] { emit chosen(path); });
  }
  menu_.setToolTipsVisible(true);
  menu_.setEnabled(!menu_.isEmpty());
}

// Accepts files that are dropped on a widget; the widget owns this object.
class FileDrop : public QObject {
  Q_OBJECT
 public:
  explicit FileDrop(QWidget& on) : QObject(&on) {
    on.setAcceptDrops(true);
    on.installEventFilter(this);
  }

 signals:
  void dropped(const QString& path); // Sent when the other program has continued.

 protected:
  bool eventFilter(QObject*, QEvent* event) override {
    if (event->type() == QEvent::DragEnter) {
      auto* drag = static_cast<QDragEnterEvent*>(event);
      const QMimeData& data = *drag->mimeData();
      if (data.hasUrls() && data.urls().front().isLocalFile()) drag->acceptProposedAction();
      return true;
    }
    if (event->type() != QEvent::Drop) return false;
    const QString path = static_cast<QDropEvent*>(event)->mimeData()->urls().front().toLocalFile();
    // A dialog must not block the program from which the file is dragged.
    QMetaObject::invokeMethod(
        this, [this, path] { emit dropped(path); }, Qt::QueuedConnection);
    return true;
  }
};

DocumentController::DocumentController(const Parts& parts, QObject* parent)
    : QObject(parent), at_(parts), loader_(parts.edits.thread().listener(), this),
      recent_(parts.recent, this) {
  connect(this, &DocumentController::abandoned, this, [this] { work_.reset(); });
  connectLoader();
  connect(&recent_, &RecentFiles::chosen, this, [this](const QString& path) { openFile(path); });
  connect(&at_.saving, &SaveController::saved, &recent_, &RecentFiles::add);
  connect(new FileDrop(at_.window), &FileDrop::dropped, this,
          [this](const QString& path) { openFile(path); });
}

void DocumentController::openFile(const QString& path) {
  openRequested(requestFor(path));
}

void DocumentController::connectLoader() {
  connect(&loader_, &SceneLoader::meshReady, this, &DocumentController::previewed);
  connect(&loader_, &SceneLoader::progressed, this, [this](double fraction, const QString& what) {
    if (!work_) return;
    work_->words = QStringLiteral("%1: %2").arg(wordsFor(loader_.request()), what);
    work_->fraction = fraction;
    emit changed();
  });
  connect(&loader_, &SceneLoader::ready, this,
          [this](std::shared_ptr<OpenedEditor> opened) { take(*opened); });
  connect(&loader_, &SceneLoader::readable, this, [this] {
    LoadRequest request = loader_.request();
    request.check_only = false;
    emit abandoned(); // Restores the window, because a question comes first.
    if (at_.saving.confirmEdits()) open(request);
  });
  connect(&loader_, &SceneLoader::read, this,
          [this](std::shared_ptr<OpenedScene> opened) { add(*opened); });
  connect(&loader_, &SceneLoader::failed, this, &DocumentController::fail);
  connect(&loader_, &SceneLoader::cancelled, this, [this] {
    if (closing_) return;
    emit abandoned();
    emit cancelled();
  });
  connect(&loader_, &SceneLoader::needsUnit, this, [this](double longest) {
    emit abandoned();
    const LoadRequest asked = loader_.request();
    askUnit(&at_.window, wordsFor(asked), longest, asked.options.up,
            [this, asked](MeshUnit unit, UpAxis up) {
              LoadRequest request = asked;
              request.options.unit = unit;
              request.options.up = up;
              request.unit_chosen = true;
              rememberUp(up);
              open(request);
            });
  });
  connect(&loader_, &SceneLoader::needsIso, this, [this](double low, double high) {
    emit abandoned();
    askIso(&at_.window, wordsFor(loader_.request()), low, high, [this](double iso) {
      LoadRequest request = loader_.request();
      request.options.iso = iso;
      open(request);
    });
  });
}

QString DocumentController::storageProblem() const {
  const EditStatus& status = at_.edits.status();
  if (!status.folder_problem.empty())
    return tr("The last step was not kept: %1").arg(QString::fromStdString(status.folder_problem));
  return status.folder ? QString() : read_only_;
}

QString DocumentController::nameUnderWay() const {
  const LoadRequest& request = loader_.request();
  return !request.unsaved_name.isEmpty() ? request.unsaved_name
         : !request.place.empty()        ? tr("Recovered scene")
         : request.path.empty()          ? presetOf(request).words
                                         : fileNameOf(request.path);
}

void DocumentController::open(const LoadRequest& request) {
  if (opensElsewhere(at_, recent_, request)) return;
  std::error_code code;
  const auto& folder = at_.edits.status().folder;
  const bool is_open = !request.adds && !request.recover && folder &&
                       std::filesystem::equivalent(request.path, *folder, code);
  if (is_open && request.check_only && !at_.saving.confirmEdits()) return;
  if (is_open) { // Only this window writes the journal, so the folder contains nothing new.
    emit opening();
    QMetaObject::invokeMethod(this, &DocumentController::alreadyOpen, Qt::QueuedConnection);
    return;
  }
  const QString words = (request.adds ? tr("Adding %1") : tr("Opening %1")).arg(wordsFor(request));
  work_ = TaskProgress{words, words};
  loader_.start(request);
  if (!request.adds && !request.check_only) emit opening();
  emit changed();
}

void DocumentController::openRequested(const LoadRequest& request) {
  LoadRequest asked = request;
  asked.check_only = interactive_ && at_.saving.hasUnsaved();
  open(asked);
}

void DocumentController::openDialog(bool adds) {
  auto* dialog = new WorkspaceFileDialog(&at_.window,
                                         adds ? tr("Add a mesh, volume or workspace to the scene")
                                              : tr("Open a mesh, volume, workspace or scan"),
                                         WorkspaceFileDialog::For::opening);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setNameFilters({tr("Meshes, volumes and workspaces (*.obj *.ply *.stl *.vti *.OBJ *.PLY "
                             "*.STL *.VTI)"),
                          tr("All files (*)")});
  connect(dialog, &WorkspaceFileDialog::chosen, this, [this, adds, dialog](const QString& path) {
    LoadRequest request = requestFor(path);
    request.options.up = dialog->up();
    request.unit_chosen = request.options.unit_chosen = dialog->unit().has_value();
    request.options.unit = dialog->unit().value_or(MeshUnit::mm);
    request.adds = adds && at_.edits.scene() != nullptr;
    if (request.adds)
      open(request);
    else
      openRequested(request);
  });
  dialog->open();
}

void DocumentController::layPictureDialog(std::size_t object) {
  const auto asked = [this, object](const QString& path) {
    const auto& scene = at_.edits.scene();
    if (!scene || object >= scene->scene.objects.size()) return;
    const SceneObject& laid_on = scene->scene.objects[object];
    const bool mapped = usualProjection(*laid_on.mesh) == Projection::mapped;
    const auto lay = [this, path, name = laid_on.name](PictureTarget target,
                                                       Projection projection) {
      at_.edits.layPicture(path.toStdString(), name, {0, target, projection},
                           [this, path](const EditOutcome& outcome) {
                             if (outcome.problem.empty()) return;
                             showProblem(&at_.window, tr("The picture cannot be laid"),
                                         QString::fromStdString(outcome.problem),
                                         tr("Choose another picture, or another way to lay it."));
                           });
    };
    askPicture(&at_.window, QFileInfo(path).fileName(), mapped, lay);
  };
  askForPath(&at_.window, tr("Lay a picture on the object"), QFileDialog::ExistingFile,
             tr("Pictures (*.png *.jpg *.jpeg *.tif *.tiff *.bmp *.exr *.hdr *.webp);;All files "
                "(*)"),
             asked);
}

void DocumentController::unitDialog(std::size_t object) {
  const auto& scene = at_.edits.scene();
  if (!scene || object >= scene->scene.objects.size()) return;
  const SceneObject& shown = scene->scene.objects[object];
  const Box3 box = bounds(*shown.mesh);
  const double longest = box.isEmpty() ? 0 : box.sizes().maxCoeff();
  askReread(&at_.window, shownText(shown.name), longest,
            [this, name = shown.name, mesh = shown.mesh](MeshUnit was, MeshUnit now, UpAxis up) {
              at_.edits.rereadObject(name, mesh, was, now, up, [this](const EditOutcome& outcome) {
                if (outcome.problem.empty()) return;
                showProblem(&at_.window, tr("The object keeps its size"),
                            QString::fromStdString(outcome.problem),
                            tr("Choose another unit, or open the file again."));
              });
            });
}

void DocumentController::take(OpenedEditor& opened) {
  const LoadRequest request = loader_.request();
  // Emitted before the task ends, because the choice of the desk depends on it.
  emit loadFinished();
  at_.saving.setName(nameUnderWay());
  const bool unsaved = !request.unsaved_name.isEmpty();
  if (!request.path.empty() && !unsaved) recent_.add(QString::fromStdString(request.path.string()));
  work_.reset();
  read_only_ = opened.read_only;
  at_.edits.thread().adopt(std::move(opened.editor), std::move(opened.autosave), unsaved);
  for (const QString& line : opened.warnings) emit notified({line, true});
  if (request.then) request.then();
  emit changed();
}

void DocumentController::add(const OpenedScene& opened) {
  work_.reset();
  at_.edits.addObjects(opened.scene.objects,
                       [this, lines = opened.warnings](const EditOutcome& outcome) {
                         if (outcome.cancelled) return emit cancelled();
                         if (!outcome.problem.empty())
                           return fail(QString::fromStdString(outcome.problem));
                         for (const std::string& line : lines)
                           emit notified({QString::fromStdString(line), true});
                       });
}

void DocumentController::fail(const QString& message) {
  const LoadRequest request = loader_.request();
  emit abandoned();
  const QString name = request.path.empty() ? tr("The scene") : fileNameOf(request.path);
  const bool damaged = !request.adds && !request.recover && isWorkspace(request.path) &&
                       !message.contains(QStringLiteral("no object"));
  if (damaged)
    askRecover(&at_.window, name, message, [this, request] {
      LoadRequest again = request;
      again.recover = true;
      open(again);
    });
  else
    showProblem(&at_.window, tr("%1 cannot be opened").arg(name), message, adviceFor(message));
  emit failed(message);
}

void DocumentController::cancel() {
  if (loader_.busy()) return loader_.cancel();
  at_.edits.thread().cancel();
}

} // namespace patina

#include "document_controller.moc"

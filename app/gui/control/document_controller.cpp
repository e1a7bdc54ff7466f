#include "app/gui/control/document_controller.h"

#include <utility>

#include "app/gui/loading/file_drop.h"
#include "app/gui/loading/file_question.h"
#include "app/gui/loading/load_dialogs.h"
#include "app/gui/loading/presets.h"
#include "app/gui/loading/up_choice.h"
#include "core/error.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

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
  if (request.path.empty() || !at.elsewhere || !at.elsewhere(request.path)) return false;
  recent.add(QString::fromStdString(request.path.string()));
  return true;
}

} // namespace

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
  openAsked(requestFor(path));
}

void DocumentController::connectLoader() {
  connect(&loader_, &SceneLoader::rested, this, &DocumentController::rested);
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
    request.asks = false;
    emit abandoned(); // a question stands before it, and the window is as it was
    if (at_.saving.settleEdits()) open(request);
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
  if (is_open && request.asks && !at_.saving.settleEdits()) return;
  if (is_open) { // its journal is ours: there is nothing in the folder that is not in the window
    emit opening();
    QMetaObject::invokeMethod(this, &DocumentController::openAlready, Qt::QueuedConnection);
    return;
  }
  const QString words = (request.adds ? tr("Adding %1") : tr("Opening %1")).arg(wordsFor(request));
  work_ = Work{words, words};
  loader_.start(request);
  if (!request.adds && !request.asks) emit opening();
  emit changed();
}

void DocumentController::openAsked(const LoadRequest& request) {
  LoadRequest asked = request;
  asked.asks = asks_ && at_.saving.hasUnsaved();
  open(asked);
}

void DocumentController::openDialog(bool adds) {
  auto* dialog = new FileQuestion(&at_.window,
                                  adds ? tr("Add a mesh, volume or workspace to the scene")
                                       : tr("Open a mesh, volume, workspace or scan"),
                                  FileQuestion::For::opening);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setNameFilters({tr("Meshes, volumes and workspaces (*.obj *.ply *.stl *.vti *.OBJ *.PLY "
                             "*.STL *.VTI)"),
                          tr("All files (*)")});
  connect(dialog, &FileQuestion::chosen, this, [this, adds](const QString& path) {
    LoadRequest request = requestFor(path);
    request.adds = adds && at_.edits.scene() != nullptr;
    if (request.adds)
      open(request);
    else
      openAsked(request);
  });
  dialog->open();
}

void DocumentController::take(OpenedEditor& opened) {
  const LoadRequest request = loader_.request();
  emit openedNow(); // before the work is over: what is seen depends on it
  at_.saving.setName(nameUnderWay());
  const bool unsaved = !request.unsaved_name.isEmpty();
  if (!request.path.empty() && !unsaved) recent_.add(QString::fromStdString(request.path.string()));
  work_.reset();
  at_.edits.thread().adopt(std::move(opened.editor), std::move(opened.autosave), unsaved);
  for (const QString& line : opened.warnings) emit said({line, true});
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
                           emit said({QString::fromStdString(line), true});
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

bool DocumentController::close() {
  closing_ = true;
  loader_.cancel();
  if (loader_.resting()) return true;
  // A reader cannot be stopped within a file: the window says so and goes when it is done.
  const QString words = tr("Closing when the file that is being read is done…");
  work_ = Work{words, words, -1};
  emit changed();
  return false;
}

} // namespace patina

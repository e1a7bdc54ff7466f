#include "app/gui/loading/scene_loader.h"

#include <new>
#include <utility>

#include <QMetaObject>

#include "app/gui/loading/presets.h"
#include "core/error.h"
#include "session/compile/compile_warnings.h"
#include "session/store/journal_fold.h"
#include "visualization/files/field_io.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

// Returns true unless the size is likely for a mesh in millimetres.
bool oddSize(double metres) {
  return metres < 1e-3 || metres > 2;
}

// Throws Error if a workspace cannot be opened although its files can be read.
void checkOpens(const std::filesystem::path& folder, const Scene& saved) {
  const OpenedWorkspace history = openHistory(folder);
  const FoldedJournal fold = folded(history.journal, history.journal_file.string());
  if (saved.objects.empty() && fold.steps.empty())
    throw FileError(folder.string(), 0, "the scene has no object");
}

QStringList lines(const std::vector<std::string>& warnings) {
  QStringList list;
  for (const std::string& line : warnings) list << QString::fromStdString(line);
  return list;
}

} // namespace

const Preset& presetOf(const LoadRequest& request) {
  return request.preset.empty() ? presets().front() : presetNamed(request.preset);
}

SceneLoader::SceneLoader(Editor::Listener listener, QObject* parent)
    : QObject(parent), listener_(std::move(listener)) {
  connect(&jobs_, &Background::progressed, this, &SceneLoader::progressed);
}

void SceneLoader::cancel() {
  if (!jobs_.busy()) return;
  jobs_.discardResult();
  QMetaObject::invokeMethod(
      this,
      [this] {
        if (!jobs_.busy()) emit cancelled();
      },
      Qt::QueuedConnection);
}

void SceneLoader::start(const LoadRequest& request) {
  request_ = request;
  jobs_.start([this, request](Progress& progress, const Background::Post& post) {
    run(request, progress, post);
  });
}

bool SceneLoader::readFile(const LoadRequest& request, const Background::Post& post,
                           OpenedScene& opened) {
  if (request.path.empty()) {
    opened.scene = presetScene(presetOf(request).name);
    return true;
  }
  const bool volume = isVolumeFile(request.path);
  if (volume && !request.options.iso && !isField(request.path)) {
    const VolumeRange range = scalarRange(request.path);
    post(true, [this, range] { emit needsIso(range.low, range.high); });
    return false;
  }
  opened = openScene(request.path, request.options);
  if (!request.unit_chosen && !std::filesystem::is_directory(request.path) &&
      !(volume && isField(request.path))) {
    const Box3 box = bounds(worldMesh(opened.scene));
    const double longest = box.isEmpty() ? 0 : box.sizes().maxCoeff();
    if (oddSize(longest)) {
      post(true, [this, longest] { emit needsUnit(1000 * longest); });
      return false;
    }
  }
  return true;
}

void SceneLoader::openEditor(const LoadRequest& request, OpenedScene opened, OpenedEditor& made,
                             Progress& progress) const {
  if (!std::filesystem::is_directory(request.path)) {
    made.editor = std::make_unique<Editor>(std::move(opened.scene), progress, listener_);
    return;
  }
  Editor::OpenSpec spec;
  spec.recover = request.recover;
  spec.own = request.own && request.unsaved_name.isEmpty();
  try {
    made.editor = Editor::open(request.path, spec, progress, listener_);
  } catch (const FileError& error) {
    // A workspace that another program has open, or without write permission, is read-only.
    spec.own = false;
    try {
      made.editor = Editor::open(request.path, spec, progress, listener_);
    } catch (const FileError&) {
      throw error;
    }
    made.read_only = tr("Edits are not saved in this folder: %1").arg(error.what());
    made.warnings << made.read_only;
  }
  made.warnings << lines(made.editor->notes());
  const Scene& scene = made.editor->scene();
  const bool chosen =
      scene.field.sides != OpenSides::automatic || scene.haptics.tip_radius.value_or(0) > 0;
  for (const auto& object : made.editor->compiled()->objects) {
    const QString name = QString::fromStdString(object->object.name);
    for (const std::string& line : meshWarnings(object->mesh_report))
      made.warnings << QStringLiteral("%1: %2").arg(name, QString::fromStdString(line));
    const auto thin = thinSheetWarning(object->mesh_report);
    if (thin && !chosen)
      made.warnings << QStringLiteral("%1: %2").arg(name, QString::fromStdString(*thin));
    if (const auto layout = layoutWarning(object->object))
      made.warnings << QStringLiteral("%1: %2").arg(name, QString::fromStdString(*layout));
  }
}

void SceneLoader::run(const LoadRequest& asked, Progress& progress, const Background::Post& post) {
  try {
    auto made = std::make_shared<OpenedEditor>();
    LoadRequest request = asked;
    if (request.check_only && request.path.empty()) // A preset, or a scene after a crash.
      return post(true, [this] { emit readable(); });
    if (!request.place.empty()) {
      made->autosave = Autosave::adopt(request.place);
      request.path = made->autosave->workspace();
      request.recover = true; // It may be incomplete.
    }
    OpenedScene opened;
    const bool folder = std::filesystem::is_directory(request.path);
    if (folder && !request.adds) {
      // Shows the saved scene at once, without later edits of the journal.
      if (!request.recover) opened.scene = loadWorkspace(request.path);
      if (!request.recover && request.check_only) checkOpens(request.path, opened.scene);
    } else if (!readFile(request, post, opened)) {
      return;
    }
    progress.throwIfCancelled();
    if (request.check_only) return post(true, [this] { emit readable(); });
    made->warnings = lines(opened.warnings);
    if (request.adds) {
      auto objects = std::make_shared<OpenedScene>(std::move(opened));
      return post(true, [this, objects] { emit read(objects); });
    }
    if (!opened.scene.objects.empty()) {
      const QString name = request.path.empty()
                               ? QString::fromStdString(presetOf(request).name)
                               : QString::fromStdString(request.path.filename().string());
      const auto mesh = std::make_shared<const TriangleMesh>(worldMesh(opened.scene));
      post(false, [this, mesh, name] { emit meshReady(mesh, name); });
    }
    openEditor(request, std::move(opened), *made, progress);
    // Warnings about a preset are useless, because the user cannot repair it.
    const bool preset = request.path.empty() && request.place.empty();
    if (!preset) made->warnings << lines(compileWarnings(*made->editor->compiled()));
    if (folder && made->editor->unsaved() && !made->autosave) // Must be last to be visible.
      made->warnings << tr("Edits made after the last save are restored; they are not saved yet.");
    post(true, [this, made] { emit ready(made); });
  } catch (const Cancelled&) {
    post(true, [this] { emit cancelled(); });
  } catch (const std::bad_alloc&) {
    post(true, [this] {
      emit failed(tr("There is not enough memory for this scene: choose a smaller resolution."));
    });
  } catch (const std::exception& error) {
    const QString message = QString::fromStdString(error.what());
    post(true, [this, message] { emit failed(message); });
  }
}

} // namespace patina

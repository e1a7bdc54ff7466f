#include "app/gui/loading/scene_loader.h"

#include <new>
#include <utility>

#include <QMetaObject>

#include "app/gui/loading/presets.h"
#include "core/error.h"
#include "session/build/compile_warnings.h"
#include "session/store/journal_fold.h"
#include "visualization/export/field_io.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

// The range in which a mesh in millimetres is taken for what it is.
bool oddSize(double metres) {
  return metres < 1e-3 || metres > 2;
}

// Throws Error where a workspace cannot be opened though its files can be read.
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
  connect(&jobs_, &Background::rested, this, &SceneLoader::rested);
}

void SceneLoader::cancel() {
  if (!jobs_.busy()) return;
  jobs_.silence();
  QMetaObject::invokeMethod(
      this,
      [this] {
        if (!jobs_.busy()) emit cancelled();
      },
      Qt::QueuedConnection);
}

void SceneLoader::start(const LoadRequest& request) {
  request_ = request;
  jobs_.start([this, request](Progress& progress, const Background::Deliver& deliver) {
    run(request, progress, deliver);
  });
}

bool SceneLoader::readFile(const LoadRequest& request, const Background::Deliver& deliver,
                           OpenedScene& opened) {
  if (request.path.empty()) {
    opened.scene = presetScene(presetOf(request).name);
    return true;
  }
  const bool volume = isVolumeFile(request.path);
  if (volume && !request.options.iso && !isField(request.path)) {
    const VolumeRange range = scalarRange(request.path);
    deliver(true, [this, range] { emit needsIso(range.low, range.high); });
    return false;
  }
  opened = openScene(request.path, request.options);
  if (!request.unit_chosen && !std::filesystem::is_directory(request.path) &&
      !(volume && isField(request.path))) {
    const Box3 box = bounds(worldMesh(opened.scene));
    const double longest = box.isEmpty() ? 0 : box.sizes().maxCoeff();
    if (oddSize(longest)) {
      deliver(true, [this, longest] { emit needsUnit(1000 * longest); });
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
    // Another program has it open, or nobody may write there: it can still be looked at.
    spec.own = false;
    try {
      made.editor = Editor::open(request.path, spec, progress, listener_);
    } catch (const FileError&) {
      throw error;
    }
    made.warnings << tr("Edits are not kept in this folder: %1").arg(error.what());
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

void SceneLoader::run(const LoadRequest& asked, Progress& progress,
                      const Background::Deliver& deliver) {
  try {
    auto made = std::make_shared<OpenedEditor>();
    LoadRequest request = asked;
    if (request.asks && request.path.empty()) // a preset, or what a crash left
      return deliver(true, [this] { emit readable(); });
    if (!request.place.empty()) {
      made->autosave = Autosave::adopt(request.place);
      request.path = made->autosave->workspace();
      request.recover = true; // what a crash left is taken as it is
    }
    OpenedScene opened;
    const bool folder = std::filesystem::is_directory(request.path);
    if (folder && !request.adds) {
      // To be seen at once: as it was saved, without what the journal says beyond.
      if (!request.recover) opened.scene = loadWorkspace(request.path);
      if (!request.recover && request.asks) checkOpens(request.path, opened.scene);
    } else if (!readFile(request, deliver, opened)) {
      return;
    }
    progress.throwIfCancelled();
    if (request.asks) return deliver(true, [this] { emit readable(); });
    made->warnings = lines(opened.warnings);
    if (request.adds) {
      auto objects = std::make_shared<OpenedScene>(std::move(opened));
      return deliver(true, [this, objects] { emit read(objects); });
    }
    if (!opened.scene.objects.empty()) {
      const QString name = request.path.empty()
                               ? QString::fromStdString(presetOf(request).name)
                               : QString::fromStdString(request.path.filename().string());
      const auto mesh = std::make_shared<const TriangleMesh>(worldMesh(opened.scene));
      deliver(false, [this, mesh, name] { emit meshReady(mesh, name); });
    }
    openEditor(request, std::move(opened), *made, progress);
    // What is known of a preset is no news: nobody has made it, and nobody has to mend it.
    const bool preset = request.path.empty() && request.place.empty();
    if (!preset) made->warnings << lines(compileWarnings(*made->editor->compiled()));
    if (folder && made->editor->unsaved() && !made->autosave) // last, for it is what is seen
      made->warnings << tr("Edits that were made after the last save are here again; they are not "
                           "saved yet.");
    deliver(true, [this, made] { emit ready(made); });
  } catch (const Cancelled&) {
    deliver(true, [this] { emit cancelled(); });
  } catch (const std::bad_alloc&) {
    deliver(true, [this] {
      emit failed(tr("There is not enough memory for this scene: choose a smaller resolution."));
    });
  } catch (const std::exception& error) {
    const QString message = QString::fromStdString(error.what());
    deliver(true, [this, message] { emit failed(message); });
  }
}

} // namespace patina

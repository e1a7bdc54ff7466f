#include "app/gui/scene_loader.h"

#include <algorithm>
#include <new>
#include <utility>

#include <QMetaObject>

#include "app/compile_warnings.h"
#include "field/models.h"
#include "visualization/field_io.h"

namespace patina {
namespace {

// The range in which a mesh in millimetres is taken for what it is.
bool oddSize(double metres) {
  return metres < 1e-3 || metres > 2;
}

// "cup", "cup-2", "cup-3": a name that the scene does not have.
std::string freeName(const Scene& scene, const std::string& name) {
  std::string free = name;
  const auto taken = [&] {
    return std::any_of(scene.objects.begin(), scene.objects.end(),
                       [&](const SceneObject& object) { return object.name == free; });
  };
  for (int number = 2; taken(); ++number) free = name + "-" + std::to_string(number);
  return free;
}

QStringList lines(const std::vector<std::string>& warnings) {
  QStringList list;
  for (const std::string& line : warnings) list << QString::fromStdString(line);
  return list;
}

} // namespace

SceneLoader::SceneLoader(QObject* parent) : QObject(parent) {
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

template <typename Work, typename Failed>
void SceneLoader::guarded(const Background::Deliver& deliver, Work work, Failed failed) {
  try {
    work();
  } catch (const Cancelled&) {
    deliver(true, [this] { emit cancelled(); });
  } catch (const std::bad_alloc&) {
    deliver(true, [failed] {
      failed(tr("There is not enough memory for this scene: choose a smaller resolution."));
    });
  } catch (const std::exception& error) {
    const QString message = QString::fromStdString(error.what());
    deliver(true, [failed, message] { failed(message); });
  }
}

void SceneLoader::rebuild(std::shared_ptr<const CompiledScene> from, Scene scene) {
  jobs_.start([this, from = std::move(from),
               scene = std::move(scene)](Progress& progress, const Background::Deliver& deliver) {
    guarded(
        deliver,
        [&] {
          const auto compiled = recompile(*from, scene, progress);
          deliver(true, [this, compiled] { emit rebuilt(compiled, {}); });
        },
        [this](const QString& message) { emit rebuildFailed(message); });
  });
}

bool SceneLoader::read(const LoadRequest& request, const Background::Deliver& deliver,
                       OpenedScene& opened) {
  if (request.path.empty()) {
    opened.scene = sceneOf(dinosaur(), "dinosaur");
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

void SceneLoader::run(const LoadRequest& request, Progress& progress,
                      const Background::Deliver& deliver) {
  guarded(
      deliver,
      [&] {
        OpenedScene opened;
        if (!read(request, deliver, opened)) return;
        progress.throwIfCancelled();
        const QStringList warnings = lines(opened.warnings);
        if (request.onto) {
          Scene scene = request.onto->scene;
          for (SceneObject& object : opened.scene.objects) {
            object.name = freeName(scene, object.name);
            scene.objects.push_back(std::move(object));
          }
          const auto compiled = recompile(*request.onto, std::move(scene), progress);
          const QStringList all = warnings + lines(compileWarnings(*compiled));
          return deliver(true, [this, compiled, all] { emit rebuilt(compiled, all); });
        }
        const QString name = request.path.empty()
                                 ? QStringLiteral("dinosaur")
                                 : QString::fromStdString(request.path.filename().string());
        const auto mesh = std::make_shared<const TriangleMesh>(worldMesh(opened.scene));
        deliver(false, [this, mesh, name] { emit meshReady(mesh, name); });
        const auto compiled = compile(std::move(opened.scene), progress);
        const QStringList all = warnings + lines(compileWarnings(*compiled));
        deliver(true, [this, compiled, all] { emit ready(compiled, all); });
      },
      [this](const QString& message) { emit failed(message); });
}

} // namespace patina

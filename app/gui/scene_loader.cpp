#include "app/gui/scene_loader.h"

#include <algorithm>
#include <cctype>
#include <new>

#include <QMetaObject>
#include <QStringList>

#include "field/models.h"
#include "visualization/field_io.h"

namespace patina {
namespace {

std::string extensionOf(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The range in which a mesh in millimetres is taken for what it is.
bool oddSize(double metres) {
  return metres < 1e-3 || metres > 2;
}

} // namespace

SceneLoader::SceneLoader(QObject* parent) : QObject(parent) {}

SceneLoader::~SceneLoader() {
  silence();
  for (Job& job : jobs_) job.thread.join();
}

void SceneLoader::silence() {
  for (Job& job : jobs_) job.progress->cancel();
  ++load_;
  busy_ = false;
}

void SceneLoader::cancel() {
  if (!busy_) return;
  silence();
  deliver(load_, true, [this] { emit cancelled(); });
}

void SceneLoader::reap() {
  const std::size_t before = jobs_.size();
  jobs_.remove_if([](Job& job) {
    if (!job.done) return false;
    job.thread.join();
    return true;
  });
  if (before > 0 && jobs_.empty()) emit rested();
}

// Runs `work` in this object's thread, unless another load has begun by then.
template <typename Work> void SceneLoader::deliver(std::uint64_t load, bool last, Work work) {
  QMetaObject::invokeMethod(
      this,
      [this, load, last, work = std::move(work)] {
        if (load != load_) return;
        if (last) busy_ = false;
        work();
      },
      Qt::QueuedConnection);
}

void SceneLoader::start(const LoadRequest& request) {
  silence();
  request_ = request;
  busy_ = true;
  const std::uint64_t load = load_;
  // Workers report every few microseconds; the bar wants a hundred steps.
  auto shown = std::make_shared<std::pair<double, std::string>>(-1, "");
  Job& job = jobs_.emplace_back();
  job.progress = std::make_unique<Progress>([=, this](double fraction, std::string_view what) {
    if (what == shown->second && fraction < shown->first + 0.01 && fraction >= shown->first) return;
    *shown = {fraction, std::string(what)};
    const QString words = QString::fromUtf8(what.data(), static_cast<int>(what.size()));
    deliver(load, false, [this, fraction, words] { emit progressed(fraction, words); });
  });
  job.thread = std::thread([this, &job, request, load] {
    run(request, *job.progress, load);
    job.done = true;
    QMetaObject::invokeMethod(
        this, [this] { reap(); }, Qt::QueuedConnection);
  });
}

void SceneLoader::run(const LoadRequest& request, Progress& progress, std::uint64_t load) {
  try {
    OpenedScene opened;
    QString name = QStringLiteral("dinosaur");
    if (request.path.empty()) {
      opened.scene = sceneOf(dinosaur(), "dinosaur");
    } else {
      name = QString::fromStdString(request.path.filename().string());
      const bool volume = extensionOf(request.path) == ".vti";
      if (volume && !request.options.iso && !isField(request.path)) {
        const VolumeRange range = scalarRange(request.path);
        return deliver(load, true, [this, range] { emit needsIso(range.low, range.high); });
      }
      opened = openScene(request.path, request.options);
      if (!request.unit_chosen && !std::filesystem::is_directory(request.path) &&
          !(volume && isField(request.path))) {
        const Box3 box = bounds(worldMesh(opened.scene));
        const double longest = box.isEmpty() ? 0 : box.sizes().maxCoeff();
        if (oddSize(longest))
          return deliver(load, true, [this, longest] { emit needsUnit(1000 * longest); });
      }
    }
    progress.throwIfCancelled();
    const auto mesh = std::make_shared<const TriangleMesh>(worldMesh(opened.scene));
    deliver(load, false, [this, mesh, name] { emit meshReady(mesh, name); });
    const auto compiled = compile(std::move(opened.scene), progress);
    QStringList warnings;
    for (const std::string& line : opened.warnings) warnings << QString::fromStdString(line);
    deliver(load, true, [this, compiled, warnings] { emit ready(compiled, warnings); });
  } catch (const Cancelled&) {
    deliver(load, true, [this] { emit cancelled(); });
  } catch (const std::bad_alloc&) {
    deliver(load, true, [this] {
      emit failed(tr("There is not enough memory for this scene: choose a smaller resolution."));
    });
  } catch (const std::exception& error) {
    const QString message = QString::fromStdString(error.what());
    deliver(load, true, [this, message] { emit failed(message); });
  }
}

} // namespace patina

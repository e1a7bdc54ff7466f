#include "app/gui/control/save_controller.h"

#include <QFileDialog>
#include <QMessageBox>

#include "app/gui/loading/file_question.h"
#include "app/gui/loading/load_dialogs.h"
#include "core/error.h"
#include "session/store/scene_export.h"
#include "workspace/workspace.h"

namespace patina {

SaveController::SaveController(QWidget& window, EditController& edits, QObject* parent)
    : QObject(parent), window_(window), edits_(edits) {}

QString SaveController::name() const {
  const auto& folder = edits_.status().folder;
  return folder ? QString::fromStdString(folder->filename().string()) : name_;
}

bool SaveController::trySaving(const std::function<void()>& save, const QString& where,
                               const QString& advice) {
  try {
    save();
    emit said({tr("Saved %1").arg(where)});
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
  edits_.tryValues(); // what this tick's timer has not asked for yet
  edits_.waitFor([&](EditThread::Done done) {
    edits_.thread().saveAs(folder.toStdString(), std::move(done));
  });
  emit saved(folder);
}

bool SaveController::save() {
  if (!edits_.scene()) return false;
  if (!edits_.status().folder) return saveDialog();
  const auto save = [this] {
    edits_.tryValues();
    edits_.waitFor([this](EditThread::Done done) { edits_.thread().save(std::move(done)); });
  };
  const auto folder = std::filesystem::absolute(*edits_.status().folder);
  return trySaving(save, QString::fromStdString(folder.string()),
                   tr("Nothing is lost: make room, or save to another folder."));
}

bool SaveController::saveDialog() {
  FileQuestion dialog(&window_, tr("Save the workspace as a folder"), FileQuestion::For::saving);
  // Beside the workspace that is open, never in it.
  if (const auto& own = edits_.status().folder)
    dialog.setDirectory(QString::fromStdString(std::filesystem::absolute(*own).parent_path()));
  dialog.selectFile(freeName(dialog.directory().path().toStdString(), name()));
  QString folder;
  connect(&dialog, &FileQuestion::chosen, this, [&](const QString& path) { folder = path; });
  dialog.exec();
  if (folder.isEmpty()) return false;
  if (const auto around = workspaceAround(folder.toStdString()); !around.empty()) {
    showProblem(&window_, tr("The workspace cannot be saved there"),
                tr("%1 is a workspace itself.").arg(QString::fromStdString(around.string())),
                tr("Choose a place beside it."));
    return false;
  }
  return trySaving([&] { saveTo(folder); }, folder, tr("Choose a folder that you may write to."));
}

void SaveController::exportDialog() {
  if (!edits_.scene()) return;
  QFileDialog dialog(&window_, tr("Export into a folder, for ParaView"));
  dialog.setObjectName(QStringLiteral("export_dialog"));
  dialog.setOption(QFileDialog::DontUseNativeDialog);
  dialog.setOption(QFileDialog::DontConfirmOverwrite); // a folder of something else is refused
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setFileMode(QFileDialog::AnyFile);
  dialog.selectFile(name().section('.', 0, 0) + QStringLiteral("-paraview"));
  if (dialog.exec() == QDialog::Accepted) exportTo(dialog.selectedFiles().front());
}

void SaveController::exportTo(const QString& folder) {
  waiting_.emplace_back(folder, edits_.scene());
  if (exports_.busy())
    emit said({tr("The export to %1 begins when the one before it is done").arg(folder)});
  exportNext();
}

void SaveController::exportNext() {
  if (waiting_.empty() || exports_.busy()) return;
  const auto [folder, scene] = waiting_.front();
  waiting_.pop_front();
  emit said({tr("Exporting to %1 …").arg(folder)});
  exports_.start([this, folder = folder, scene = scene](Progress& progress,
                                                        const Background::Deliver& deliver) {
    try {
      std::string noted;
      const auto files = patina::exportScene(
          *scene, folder.toStdString(),
          {.warn = [&](const std::string& line) { noted += "; " + line; }}, progress);
      const QString words = tr("Exported %1 files to %2; open scene.vtm%3")
                                .arg(files.size())
                                .arg(folder, QString::fromStdString(noted));
      deliver(true, [this, words, warns = !noted.empty()] {
        emit said({words, warns});
        exportNext();
      });
    } catch (const std::exception& error) {
      deliver(true, [this, words = QString::fromStdString(error.what())] {
        showProblem(&window_, tr("The scene cannot be exported"), words,
                    tr("Choose a new folder, in one that you may write to."));
        exportNext();
      });
    }
  });
}

bool SaveController::hasUnsaved() const {
  return edits_.unsaved() || edits_.thread().busy() || !beside_.is_kept();
}

bool SaveController::settleEdits() {
  edits_.settle(); // what keeps the rest may be under way
  if (!beside_.settle()) return false;
  edits_.settle(); // a stroke that was just painted may not be in the history yet
  while (edits_.unsaved()) {
    const bool has_folder = edits_.status().folder.has_value();
    QMessageBox box(QMessageBox::Question, tr("The edits are not saved"),
                    has_folder ? tr("%1 was edited since it was saved.").arg(name())
                               : tr("%1 is in no workspace yet.").arg(name()),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, &window_);
    box.setObjectName(QStringLiteral("unsaved_edits"));
    const int answer = box.exec();
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
  } catch (const Cancelled&) { // they stay, as was asked for
  } catch (const std::exception& error) {
    showProblem(&window_, tr("The edits stay in the workspace"),
                QString::fromStdString(error.what()), tr("They can be undone later."));
  }
}

} // namespace patina

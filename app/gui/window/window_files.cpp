// Opening, saving and closing, with the questions that belong to them.
#include <QCloseEvent>
#include <QFileDialog>
#include <QMessageBox>
#include <QStatusBar>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/window/main_window.h"
#include "core/error.h"
#include "workspace/workspace.h"

namespace patina {

void MainWindow::offerRecovery() {
  recover_->offer(leftBehind(stateFolder()));
}

void MainWindow::loadProblem(const QString& message) {
  const LoadRequest request = loader_->request();
  restore();
  const QString name = request.path.empty()
                           ? tr("The scene")
                           : QString::fromStdString(request.path.filename().string());
  const bool damaged = !request.adds && !request.recover && isWorkspace(request.path) &&
                       !message.contains(QStringLiteral("no object"));
  if (damaged)
    askRecover(this, name, message, [this, request] {
      LoadRequest again = request;
      again.recover = true;
      open(again);
    });
  else
    showProblem(this, tr("%1 cannot be opened").arg(name), message, adviceFor(message));
  emit loadFailed(message);
}

void MainWindow::openDialog(bool adds) {
  auto* dialog = new QFileDialog(this, adds ? tr("Add a mesh, volume or workspace to the scene")
                                            : tr("Open a mesh, volume or workspace"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::ExistingFile);
  dialog->setNameFilters({tr("Meshes, volumes and workspaces (*.obj *.ply *.stl *.vti *.OBJ *.PLY "
                             "*.STL *.VTI workspace.json)"),
                          tr("All files (*)")});
  connect(dialog, &QFileDialog::fileSelected, this, [this, adds](const QString& path) {
    LoadRequest request;
    request.path = path.toStdString();
    request.adds = adds && current_ != nullptr;
    // Of a workspace, which is a folder, people see the file in it.
    if (request.path.filename() == "workspace.json") request.path = request.path.parent_path();
    if (request.adds)
      open(request);
    else
      openAsked(request);
  });
  dialog->open();
}

void MainWindow::openAsked(const LoadRequest& request) {
  if (!asks_ || settleEdits()) open(request);
}

void MainWindow::saveWorkspaceTo(const QString& folder) {
  if (current_ == nullptr) throw Error("there is no scene to save");
  tryValues(); // what this tick's timer has not asked for yet
  waitFor([&](EditThread::Done done) { edits_->saveAs(folder.toStdString(), std::move(done)); });
  recent_->add(folder);
}

void MainWindow::save() {
  saveNow();
}

bool MainWindow::saveNow() {
  if (current_ == nullptr) return false;
  if (!standing_.folder) return saveDialog();
  try {
    if (values_edited_) tryValues();
    waitFor([&](EditThread::Done done) { edits_->save(std::move(done)); });
    statusBar()->showMessage(tr("Saved %1").arg(name_), 4000);
    return true;
  } catch (const std::exception& error) {
    showProblem(this, tr("The workspace cannot be saved"), QString::fromStdString(error.what()),
                tr("Nothing is lost: make room, or save to another folder."));
    return false;
  }
}

bool MainWindow::saveDialog() {
  const QString folder = QFileDialog::getSaveFileName(
      this, tr("Save the workspace as a folder"), QStringLiteral("scene.patina"), {}, nullptr,
      QFileDialog::DontConfirmOverwrite | QFileDialog::HideNameFilterDetails);
  if (folder.isEmpty()) return false;
  try {
    saveWorkspaceTo(folder);
    statusBar()->showMessage(tr("Saved %1").arg(folder), 4000);
    return true;
  } catch (const std::exception& error) {
    showProblem(this, tr("The workspace cannot be saved"), QString::fromStdString(error.what()),
                tr("Choose a folder that you may write to."));
    return false;
  }
}

bool MainWindow::settleEdits() {
  // A stroke that was just painted may not be in the history yet.
  if (edits_->busy() && current_ != nullptr)
    waitFor([this](EditThread::Done done) {
      edits_->apply(
          "", [](const CompiledScene&) { return nullptr; }, false, std::move(done));
    });
  while (isWindowModified()) {
    QMessageBox box(QMessageBox::Question, tr("The edits are not saved"),
                    standing_.folder ? tr("%1 was edited since it was saved.").arg(name_)
                                     : tr("The scene was edited and is in no workspace yet."),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
    box.setObjectName(QStringLiteral("unsaved_edits"));
    const int answer = box.exec();
    if (answer == QMessageBox::Cancel) return false;
    if (answer == QMessageBox::Save) {
      saveNow();
      continue;
    }
    if (answer != QMessageBox::Discard) return false;
    if (standing_.folder) {
      try {
        waitFor([this](EditThread::Done done) { edits_->discard(std::move(done)); });
      } catch (const std::exception& error) {
        showProblem(this, tr("The edits stay in the workspace"),
                    QString::fromStdString(error.what()), tr("They can be undone later."));
      }
    }
    return true;
  }
  return true;
}

bool MainWindow::settleRecording() {
  collect();
  while (!recording_.samples().empty()) {
    QMessageBox box(QMessageBox::Question, tr("The recording is not saved"),
                    tr("%1 recorded ticks are in no file yet.").arg(recording_.samples().size()),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
    box.setObjectName(QStringLiteral("unsaved_recording"));
    const int answer = box.exec();
    if (answer == QMessageBox::Discard) {
      recording_.clear();
      record_action_->setChecked(false);
    } else if (answer != QMessageBox::Save) {
      return false;
    } else {
      saveRecordingDialog();
    }
  }
  return true;
}

bool MainWindow::saveRecordingDialog() {
  const QString path = QFileDialog::getSaveFileName(
      this, tr("Save the recorded forces"), QStringLiteral("feel.csv"), tr("Tables (*.csv)"));
  if (path.isEmpty()) return false;
  const std::size_t count = recording_.samples().size(), lost = recording_.lost();
  try {
    recording_.save(path.toStdString());
  } catch (const std::exception& error) {
    showProblem(this, tr("The recording cannot be saved"), QString::fromStdString(error.what()),
                tr("Choose a folder that you may write to. The recording is kept."));
    return false;
  }
  record_action_->setChecked(false);
  QString words = tr("Saved %1 ticks to %2").arg(count).arg(path);
  if (lost > 0) words += tr("; %1 ticks came too fast to be kept").arg(lost);
  statusBar()->showMessage(words, lost > 0 ? 0 : 4000);
  return true;
}

void MainWindow::recordDialog(bool on) {
  if (on) return startRecording();
  collect();
  recording_.pause();
  if (saveRecordingDialog() || settleRecording()) return;
  recording_.resume();
  record_action_->setChecked(true);
}

void MainWindow::exportDialog() {
  const QString path = QFileDialog::getSaveFileName(
      this, tr("Export the picture"), QStringLiteral("patina.png"), tr("PNG pictures (*.png)"));
  if (path.isEmpty()) return;
  if (!view_->grabFramebuffer().save(path, "PNG"))
    showProblem(this, tr("The picture cannot be saved"), path,
                tr("Choose a folder that you may write to, and a name that ends in .png."));
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (asks_ && !closing_ && !(settleRecording() && settleEdits())) return event->ignore();
  closing_ = true;
  timer_.stop();
  loader_->cancel();
  stability_->cancel();
  relief_->cancel();
  closeFeel();
  if (!loader_->resting()) {
    // A reader cannot be stopped within a file: the window says so and goes when it is done.
    load_bar_->showClosing();
    connect(loader_, &SceneLoader::rested, this, &QWidget::close, Qt::UniqueConnection);
    return event->ignore();
  }
  event->accept();
}

} // namespace patina

#include "app/gui/window/background.h"

#include <string>
#include <utility>

#include <QMetaObject>

namespace patina {

Background::Background(QObject* parent) : QObject(parent) {}

Background::~Background() {
  silence();
  for (Job& job : jobs_) job.thread.join();
}

void Background::silence() {
  for (Job& job : jobs_) job.progress->cancel();
  ++number_;
  busy_ = false;
}

void Background::reap() {
  const std::size_t before = jobs_.size();
  jobs_.remove_if([](Job& job) {
    if (!job.done) return false;
    job.thread.join();
    return true;
  });
  if (before > 0 && jobs_.empty()) emit rested();
}

void Background::deliver(std::uint64_t job, bool last, std::function<void()> then) {
  QMetaObject::invokeMethod(
      this,
      [this, job, last, then = std::move(then)] {
        if (job != number_) return;
        if (last) busy_ = false;
        then();
      },
      Qt::QueuedConnection);
}

void Background::start(Work work) {
  silence();
  busy_ = true;
  const std::uint64_t number = number_;
  // Workers report every few microseconds; a bar wants a hundred steps.
  auto shown = std::make_shared<std::pair<double, std::string>>(-1, "");
  Job& job = jobs_.emplace_back();
  job.progress = std::make_unique<Progress>([=, this](double fraction, std::string_view what) {
    if (what == shown->second && fraction < shown->first + 0.01 && fraction >= shown->first) return;
    *shown = {fraction, std::string(what)};
    const QString words = QString::fromUtf8(what.data(), static_cast<int>(what.size()));
    deliver(number, false, [this, fraction, words] { emit progressed(fraction, words); });
  });
  job.thread = std::thread([this, &job, work = std::move(work), number] {
    work(*job.progress, [this, number](bool last, std::function<void()> then) {
      deliver(number, last, std::move(then));
    });
    job.done = true;
    QMetaObject::invokeMethod(
        this, [this] { reap(); }, Qt::QueuedConnection);
  });
}

} // namespace patina

#include "app/gui/toolkit/background.h"

#include "app/gui/toolkit/words.h"

#include <string>
#include <utility>

#include <QMetaObject>

namespace patina {

void Background::wait() {
  discardResult();
  for (Job& job : jobs_) job.thread.join();
  jobs_.clear();
}

void Background::discardResult() {
  for (Job& job : jobs_) job.progress->cancel();
  ++number_;
  busy_ = false;
}

void Background::reap() {
  jobs_.remove_if([](Job& job) {
    if (!job.done) return false;
    job.thread.join();
    return true;
  });
}

void Background::post(std::uint64_t job, bool last, std::function<void()> then) {
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
  discardResult();
  busy_ = true;
  const std::uint64_t number = number_;
  // Workers report every few microseconds, but a bar needs a hundred steps.
  auto shown = std::make_shared<std::pair<double, std::string>>(-1, "");
  Job& job = jobs_.emplace_back();
  job.progress = std::make_unique<Progress>([=, this](double fraction, std::string_view what) {
    if (what == shown->second && fraction < shown->first + 0.01 && fraction >= shown->first) return;
    *shown = {fraction, std::string(what)};
    const QString words = shownText(what);
    post(number, false, [this, fraction, words] { emit progressed(fraction, words); });
  });
  job.thread = std::thread([this, &job, work = std::move(work), number] {
    work(*job.progress, [this, number](bool last, std::function<void()> then) {
      post(number, last, std::move(then));
    });
    job.done = true;
    QMetaObject::invokeMethod(
        this, [this] { reap(); }, Qt::QueuedConnection);
  });
}

} // namespace patina

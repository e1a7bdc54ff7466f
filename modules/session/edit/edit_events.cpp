#include "session/edit/edit_events.h"

namespace patina {

template <typename Change> void EditEventBuffer::change(Change&& change) {
  bool wakes = false;
  {
    const std::lock_guard lock(mutex_);
    change();
    wakes = !std::exchange(woken_, true);
  }
  if (wakes && wake_) wake_();
}

void EditEventBuffer::addScene(std::shared_ptr<const CompiledScene> compiled, bool anew) {
  change([&] {
    events_.compiled = std::move(compiled);
    events_.anew = events_.anew || anew;
  });
}

void EditEventBuffer::setStatus(std::shared_ptr<const EditStatus> status) {
  change([&] { events_.status = std::move(status); });
}

void EditEventBuffer::setProgress(std::optional<EditProgress> progress) {
  change([&] { events_.progress = std::move(progress); });
}

void EditEventBuffer::addProblem(const std::string& line) {
  change([&] { events_.problems.push_back(line); });
}

void EditEventBuffer::addDone(std::function<void()> then) {
  change([&] { events_.done.push_back(std::move(then)); });
}

EditEvents EditEventBuffer::take() {
  const std::lock_guard lock(mutex_);
  woken_ = false;
  EditEvents taken = std::move(events_);
  events_ = {};
  events_.progress = taken.progress; // it goes on
  return taken;
}

} // namespace patina

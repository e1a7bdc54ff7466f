#include "session/edit/edit_news.h"

#include <utility>

namespace patina {
template <typename Change> void EditNewsBoard::change(Change&& change) {
  bool wakes = false;
  {
    const std::lock_guard lock(mutex_);
    change();
    wakes = !std::exchange(woken_, true);
  }
  if (wakes && wake_) wake_();
}

void EditNewsBoard::scene(std::shared_ptr<const CompiledScene> compiled, bool anew) {
  change([&] {
    news_.compiled = std::move(compiled);
    news_.anew = news_.anew || anew;
  });
}

void EditNewsBoard::standing(std::shared_ptr<const EditStanding> standing) {
  change([&] { news_.standing = std::move(standing); });
}

void EditNewsBoard::doing(std::optional<EditDoing> doing) {
  change([&] { news_.doing = std::move(doing); });
}

void EditNewsBoard::problem(const std::string& line) {
  change([&] { news_.problems.push_back(line); });
}

void EditNewsBoard::done(std::function<void()> then) {
  change([&] { news_.done.push_back(std::move(then)); });
}

EditNews EditNewsBoard::take() {
  const std::lock_guard lock(mutex_);
  woken_ = false;
  EditNews taken = std::move(news_);
  news_ = {};
  news_.doing = taken.doing; // it goes on
  return taken;
}

} // namespace patina

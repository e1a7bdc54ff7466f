#include "app/edit_news.h"

#include <algorithm>
#include <utility>

namespace patina {
namespace {

template <typename T> void unite(std::vector<T>& into, const std::vector<T>& more) {
  into.insert(into.end(), more.begin(), more.end());
  std::sort(into.begin(), into.end());
  into.erase(std::unique(into.begin(), into.end()), into.end());
}

} // namespace

void add(std::vector<PaintChange>& changes, const std::vector<PaintChange>& more) {
  for (const PaintChange& change : more) {
    const auto known = std::find_if(changes.begin(), changes.end(), [&](const PaintChange& c) {
      return c.object == change.object;
    });
    if (known == changes.end()) {
      changes.push_back(change);
      continue;
    }
    known->region.extend(change.region);
    unite(known->color_tiles, change.color_tiles);
    unite(known->relief_tiles, change.relief_tiles);
    unite(known->material_blocks, change.material_blocks);
  }
}

template <typename Change> void EditNewsBoard::change(Change&& change) {
  bool wakes = false;
  {
    const std::lock_guard lock(mutex_);
    change();
    wakes = !std::exchange(woken_, true);
  }
  if (wakes && wake_) wake_();
}

void EditNewsBoard::scene(std::shared_ptr<const CompiledScene> compiled,
                          std::optional<std::vector<PaintChange>> changes, bool anew) {
  change([&] {
    const bool first = news_.compiled == nullptr;
    news_.compiled = std::move(compiled);
    news_.anew = news_.anew || anew;
    if (first)
      news_.changes = std::move(changes);
    else if (!changes)
      news_.changes.reset();
    else if (news_.changes)
      add(*news_.changes, *changes);
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

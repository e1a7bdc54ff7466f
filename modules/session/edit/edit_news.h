// News of edits gathered until somebody asks: bounded, however seldom that is.
#pragma once

#include <functional>
#include <mutex>

#include "session/edit/edit_thread.h"

namespace patina {

// Any thread.
class EditNewsBoard {
 public:
  explicit EditNewsBoard(std::function<void()> wake) : wake_(std::move(wake)) {}

  void scene(std::shared_ptr<const CompiledScene> compiled, bool anew);
  void standing(std::shared_ptr<const EditStanding> standing);
  void doing(std::optional<EditDoing> doing);
  void problem(const std::string& line);
  void done(std::function<void()> then);
  EditNews take();

 private:
  template <typename Change> void change(Change&& change);

  std::function<void()> wake_;
  std::mutex mutex_;
  EditNews news_;
  bool woken_ = false;
};

} // namespace patina

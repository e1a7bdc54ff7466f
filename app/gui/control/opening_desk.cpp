#include "app/gui/control/opening_desk.h"

#include <utility>

namespace patina {

OpeningDesk::OpeningDesk(DocumentController& documents, DeskController& desks,
                         std::function<bool()> is_seen, QObject* parent)
    : QObject(parent), desks_(desks), is_seen_(std::move(is_seen)) {
  connect(&documents, &DocumentController::opening, this, [this] { begin(); });
  connect(&documents, &DocumentController::previewed, this, [this] { come(); });
  for (const auto signal : {&DocumentController::openedNow, &DocumentController::openAlready})
    connect(&documents, signal, this, [this] {
      come();
      end();
    });
  connect(&documents, &DocumentController::abandoned, this, [this] { goBack(); });
}

void OpeningDesk::begin() {
  // One that takes the place of another under way goes back to where that began.
  if (came_ && desks_.desk() == Desk::feel) return;
  from_ = desks_.desk();
  came_ = false;
}

void OpeningDesk::come() {
  if (from_ != desks_.desk() || is_seen_()) return; // a desk that was chosen meanwhile stays
  came_ = true;
  desks_.choose(Desk::feel);
}

void OpeningDesk::goBack() {
  const std::optional<Desk> back = came_ && desks_.desk() == Desk::feel ? from_ : std::nullopt;
  end();
  if (back) desks_.choose(*back);
}

void OpeningDesk::end() {
  from_.reset();
  came_ = false;
}

} // namespace patina

#include "app/gui/loading/recovery_offer.h"

#include "core/error.h"
#include "session/store/autosave.h"

namespace patina {

RecoveryOffer::RecoveryOffer(RecoverBar& bar, QObject* parent) : QObject(parent) {
  connect(&bar, &RecoverBar::laterAsked, this, &RecoveryOffer::next);
  connect(&bar, &RecoverBar::forgetAsked, this, [this] {
    try {
      Autosave::adopt(places_.front())->own(); // and let it go
    } catch (const Error&) {                   // another program has taken it meanwhile
    }
    next();
  });
  connect(&bar, &RecoverBar::recoverAsked, this, [this] {
    const std::filesystem::path place = places_.front();
    next();
    emit taken(place);
  });
}

void RecoveryOffer::begin() {
  places_ = leftBehind(stateFolder());
  emit changed();
}

std::optional<std::filesystem::path> RecoveryOffer::present() const {
  return places_.empty() ? std::nullopt : std::optional(places_.front());
}

void RecoveryOffer::next() {
  places_.erase(places_.begin());
  emit changed();
}

} // namespace patina

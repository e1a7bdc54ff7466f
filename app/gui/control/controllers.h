// What works behind the window's widgets, each for one thing.
#pragma once

namespace patina {

class DocumentController;
class SaveController;
class RecoveryOffer;
class EditController;
class FeelController;
class PaintController;
class ViewController;
class DeskController;

struct Controllers {
  DocumentController& documents;
  SaveController& saving;
  RecoveryOffer& recovery;
  EditController& edits;
  FeelController& feel;
  PaintController& paint;
  ViewController& view;
  DeskController& desks;
};

} // namespace patina

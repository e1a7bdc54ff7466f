// When the pictures of a video file are shown, as its container says. OpenCV tells the time at
// which a picture was decoded, which is another where pictures are stored in another order than
// they are shown, and none for the last of them.
#pragma once

#include <memory>
#include <string>

namespace patina {

class PictureTimes {
 public:
  // What cannot be opened has no times.
  explicit PictureTimes(const std::string& path);
  ~PictureTimes();
  PictureTimes(const PictureTimes&) = delete;
  PictureTimes& operator=(const PictureTimes&) = delete;

  // Of the next picture that is shown, from the first on [s]; NaN: it has none.
  double next();
  // How many are in the file in all, shown or not, and how many are shown and were not asked for.
  // Reads the rest of it.
  int held();
  int left();

 private:
  class File;
  std::unique_ptr<File> file_;
};

} // namespace patina

#include "app/cli/input/paint_images.h"

#include <algorithm>

#include "core/numbers.h"
#include "pictures/picture_file.h"

namespace patina::cli {

namespace {

Picture pictureOf(const TiledImage& image) {
  Picture picture{image.width(), image.height(), image.channels(), {}};
  for (int j = 0; j < image.height(); ++j)
    for (int i = 0; i < image.width(); ++i)
      for (int c = 0; c < image.channels(); ++c) picture.texel.push_back(image.at(i, j, c));
  return picture;
}

void divideByCoverage(Picture& picture) {
  for (std::size_t i = 0; i < picture.texel.size(); i += kColorChannels) {
    const float alpha = picture.texel[i + 3];
    if (alpha <= 0) continue;
    for (std::size_t c = 0; c < 3; ++c) picture.texel[i + c] /= alpha;
  }
}

} // namespace

std::vector<std::string> writePaintImages(const Scene& scene, const std::filesystem::path& folder,
                                          Console& console) {
  std::vector<std::string> files;
  const auto write = [&](const std::string& stem, const Picture& picture) {
    for (const char* extension : {".png", ".exr"}) {
      writePicture(folder / (stem + extension), picture);
      files.push_back(stem + extension);
    }
  };
  for (const SceneObject& object : scene.objects) {
    if (!object.paint) continue;
    if (object.paint->color) {
      Picture picture = pictureOf(*object.paint->color);
      divideByCoverage(picture);
      write(object.name + "-color", picture);
    }
    if (!object.paint->relief) continue;
    const Picture picture = pictureOf(*object.paint->relief);
    const auto [least, most] = std::minmax_element(picture.texel.begin(), picture.texel.end());
    if (*least < 0 || *most > 1)
      console.warn(object.name + "-relief.png holds 0 to 1: what lies between " +
                   formatNumber(static_cast<double>(*least)) + " and " +
                   formatNumber(static_cast<double>(*most)) + " is whole in the .exr");
    write(object.name + "-relief", picture);
  }
  return files;
}

} // namespace patina::cli

#include "visualization/layers/paint_layer.h"

#include <algorithm>
#include <array>

#include <vtkMapper.h>
#include <vtkProperty.h>

#include "scene/paint/grey_relief.h"
#include "visualization/layers/image_surface.h"
#include "visualization/values/color_table.h"
#include "visualization/values/scalar_bar.h"

namespace patina {
namespace {

ValueRange both(const ValueRange& a, const ValueRange& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

} // namespace

struct PaintLayer::Impl {
  struct Drawn {
    SceneObject object; // with the smoothed relief
    GreyImage grey;
    std::shared_ptr<const TexelMap> texels;
    std::unique_ptr<ImageSurface> image;
    std::unique_ptr<MaterialSurface> material;
  };

  vtkRenderer* scene;
  vtkSmartPointer<vtkScalarBarActor> bar = scalarBar("");
  std::vector<Drawn> objects;
  Material base;
  double height = 0;
  std::optional<PaintQuantity> quantity;
  std::array<ColorScale, kPaintQuantities> scales{};
  std::array<ValueRange, kPaintQuantities> ranges{};
  ColorScale colors_scale;         // scale of `colors`
  std::optional<ValueRange> range; // range of the colours
  vtkSmartPointer<vtkLookupTable> colors;
  std::optional<PaintQuantity> colors_of;
  bool visible = false, wireframe = false;
  vtkSmartPointer<vtkPlaneCollection> cuts;

  static std::size_t at(PaintQuantity q) { return static_cast<std::size_t>(q); }
  bool draws(const Drawn& drawn) const { return quantity && hasPaint(drawn.object, *quantity); }

  void remove(Drawn& drawn) {
    if (drawn.image) scene->RemoveActor(&drawn.image->actor());
    if (drawn.material) scene->RemoveActor(&drawn.material->actor());
    drawn.image = nullptr;
    drawn.material = nullptr;
  }
  void add(vtkActor& actor) {
    scene->AddActor(&actor);
    actor.GetMapper()->SetClippingPlanes(cuts);
  }

  ValueRange prepareValues(Drawn& drawn);
  void addValues(const Drawn& drawn, std::vector<double>& values) const;
  void setColors(const ValueRange& wanted);
  void showWhatIsDrawn();
};

ValueRange PaintLayer::Impl::prepareValues(Drawn& drawn) {
  if (const auto channel = channelOf(*quantity)) {
    if (!drawn.material) {
      drawn.material = std::make_unique<MaterialSurface>();
      add(drawn.material->actor());
    }
    drawn.material->set(drawn.object, base);
    return drawn.material->prepare(*channel);
  }
  if (!drawn.image) {
    drawn.image = std::make_unique<ImageSurface>();
    add(drawn.image->actor());
  }
  drawn.image->set(drawn.object, height, drawn.texels);
  return *quantity == PaintQuantity::relief ? drawn.image->heights() : ValueRange{0, 0};
}

void PaintLayer::Impl::addValues(const Drawn& drawn, std::vector<double>& values) const {
  if (channelOf(*quantity)) {
    const std::vector<float> shown = drawn.material->values();
    values.insert(values.end(), shown.begin(), shown.end());
  } else if (quantity == PaintQuantity::relief) {
    for (std::size_t tile = 0; drawn.object.paint->relief && // unpainted tiles do not count
                               tile < drawn.object.paint->relief->tileCount();
         ++tile)
      if (const float* texels = drawn.object.paint->relief->tile(tile))
        for (int i = 0; i < kTileSide * kTileSide; ++i)
          values.push_back(height * static_cast<double>(texels[i]));
  }
}

void PaintLayer::Impl::setColors(const ValueRange& wanted) {
  const ColorScale& scale = scales[at(*quantity)];
  if (colors && colors_of == quantity && range == wanted && colors_scale == scale) return;
  range = wanted;
  colors_of = quantity;
  colors_scale = scale;
  colors = colorTable(
      scale, quantity == PaintQuantity::relief ? StandardMap::diverging : StandardMap::sequential,
      wanted);
  const ReadingUnit reading = readingUnit(*quantity, wanted);
  const vtkNew<vtkLookupTable> read;
  read->DeepCopy(colors);
  read->SetRange(reading.display_per_si * wanted.low, reading.display_per_si * wanted.high);
  bar->SetLookupTable(read);
  setTitle(*bar, reading.title);
  bar->SetLabelFormat(labelFormat(scale, "%.4g").c_str());
}

void PaintLayer::Impl::showWhatIsDrawn() {
  bool any = false;
  for (Drawn& drawn : objects) {
    const bool on = visible && draws(drawn);
    any = any || on;
    const bool material = quantity && channelOf(*quantity).has_value();
    if (drawn.image) {
      drawn.image->actor().SetVisibility(on && !material);
      drawn.image->actor().GetProperty()->SetEdgeVisibility(wireframe);
    }
    if (drawn.material) drawn.material->actor().SetVisibility(on && material);
  }
  bar->SetVisibility(any && quantity != PaintQuantity::color && colors != nullptr);
}

PaintLayer::PaintLayer(vtkRenderer& scene, vtkRenderer& overlay) : my_(std::make_unique<Impl>()) {
  my_->scene = &scene;
  overlay.AddActor2D(my_->bar);
  my_->bar->SetVisibility(false);
}

PaintLayer::~PaintLayer() = default;

void PaintLayer::set(const Scene& scene,
                     const std::vector<std::shared_ptr<const TexelMap>>& texels) {
  // Objects with the same mesh keep their surface, so that an edit of one leaves the others.
  std::vector<Impl::Drawn> objects(scene.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto old = std::find_if(my_->objects.begin(), my_->objects.end(), [&](const auto& drawn) {
      return drawn.object.mesh != nullptr && drawn.object.mesh == scene.objects[i].mesh;
    });
    if (old != my_->objects.end()) {
      objects[i] = std::move(*old);
      old->object.mesh = nullptr;
    }
    objects[i].object = scene.objects[i];
    objects[i].object.paint =
        withRelief(scene.objects[i].paint, scene.relief.source, &objects[i].grey);
    if (i < texels.size() && texels[i]) objects[i].texels = texels[i];
    if (!objects[i].object.paint) {
      my_->remove(objects[i]);
      objects[i].texels = nullptr;
    }
  }
  for (Impl::Drawn& old : my_->objects) my_->remove(old);
  my_->objects = std::move(objects);
  my_->base = baseMaterial(scene.haptics);
  my_->height = scene.relief.height;
  my_->showWhatIsDrawn();
}

void PaintLayer::show(std::optional<PaintQuantity> quantity) {
  my_->quantity = quantity;
  my_->showWhatIsDrawn();
}

bool PaintLayer::has(PaintQuantity quantity) const {
  return std::any_of(my_->objects.begin(), my_->objects.end(),
                     [&](const Impl::Drawn& drawn) { return hasPaint(drawn.object, quantity); });
}

bool PaintLayer::draws(std::size_t object) const {
  return object < my_->objects.size() && my_->draws(my_->objects[object]);
}

void PaintLayer::setScale(PaintQuantity quantity, const ColorScale& scale) {
  my_->scales[Impl::at(quantity)] = scale;
}

ValueRange PaintLayer::range(PaintQuantity quantity) const {
  return my_->ranges[Impl::at(quantity)];
}

vtkLookupTable* PaintLayer::colors() const {
  return my_->quantity == PaintQuantity::color ? nullptr : my_->colors.Get();
}

void PaintLayer::setVisible(bool on) {
  my_->visible = on;
  my_->showWhatIsDrawn();
}

void PaintLayer::prepare() {
  if (!my_->quantity || !my_->visible || !has(*my_->quantity)) return;
  const PaintQuantity quantity = *my_->quantity;
  std::optional<ValueRange> found;
  for (Impl::Drawn& drawn : my_->objects)
    if (my_->draws(drawn)) {
      const ValueRange own = my_->prepareValues(drawn);
      found = found ? both(*found, own) : own;
    }
  const ColorScale& scale = my_->scales[Impl::at(quantity)];
  std::vector<double> values;
  for (Impl::Drawn& drawn : my_->objects)
    if (scale.percentile && my_->draws(drawn)) my_->addValues(drawn, values);
  std::sort(values.begin(), values.end());
  my_->ranges[Impl::at(quantity)] = shownRange(scale, rounded(*found), values);
  if (quantity != PaintQuantity::color) my_->setColors(range(quantity));
  for (Impl::Drawn& drawn : my_->objects) {
    if (!my_->draws(drawn)) continue;
    if (channelOf(quantity))
      drawn.material->setColors(my_->colors);
    else
      drawn.image->prepare(quantity, my_->colors);
    vtkActor& actor = channelOf(quantity) ? drawn.material->actor() : drawn.image->actor();
    actor.GetProperty()->SetOpacity(scale.opacity.value_or(1));
  }
  my_->showWhatIsDrawn();
}

void PaintLayer::setWireframe(bool on) {
  my_->wireframe = on;
  my_->showWhatIsDrawn();
}

void PaintLayer::setCuts(vtkPlaneCollection* planes) {
  my_->cuts = planes;
  for (Impl::Drawn& drawn : my_->objects)
    for (vtkActor* actor : {drawn.image ? &drawn.image->actor() : nullptr,
                            drawn.material ? &drawn.material->actor() : nullptr})
      if (actor != nullptr) actor->GetMapper()->SetClippingPlanes(planes);
}

vtkScalarBarActor& PaintLayer::bar() {
  return *my_->bar;
}

} // namespace patina

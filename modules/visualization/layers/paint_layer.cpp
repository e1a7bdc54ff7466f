#include "visualization/layers/paint_layer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <vtkMapper.h>
#include <vtkProperty.h>

#include "scene/paint/grey_relief.h"
#include "visualization/layers/image_surface.h"
#include "visualization/layers/material_surface.h"
#include "visualization/values/scalar_bar.h"

namespace patina {
namespace {

// Smallest range of both.
ValueRange both(const ValueRange& a, const ValueRange& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

} // namespace

struct PaintLayer::Impl {
  struct Drawn {
    SceneObject object; // with the relief that is felt
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
  std::array<std::optional<ValueRange>, kPaintQuantities> locked{}, found{};
  std::optional<ValueRange> range; // of the colours
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

void PaintLayer::Impl::setColors(const ValueRange& wanted) {
  if (colors && colors_of == quantity && range == wanted) return;
  range = wanted;
  colors_of = quantity;
  colors = paintColors(*quantity, wanted);
  const ReadingUnit reading = readingUnit(*quantity, wanted);
  const vtkNew<vtkLookupTable> read;
  read->DeepCopy(colors);
  read->SetRange(reading.per_si * wanted.low, reading.per_si * wanted.high);
  bar->SetLookupTable(read);
  setTitle(*bar, reading.title);
  bar->SetLabelFormat("%.4g");
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

PaintLayer::PaintLayer(vtkRenderer& scene, vtkRenderer& overlay) : impl_(std::make_unique<Impl>()) {
  impl_->scene = &scene;
  overlay.AddActor2D(impl_->bar);
  impl_->bar->SetVisibility(false);
}

PaintLayer::~PaintLayer() = default;

void PaintLayer::set(const Scene& scene,
                     const std::vector<std::shared_ptr<const TexelMap>>& texels) {
  Impl& my = *impl_;
  // Objects are the same as long as their meshes are: an edit of one keeps the others' surfaces.
  std::vector<Impl::Drawn> objects(scene.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto old = std::find_if(my.objects.begin(), my.objects.end(), [&](const auto& drawn) {
      return drawn.object.mesh != nullptr && drawn.object.mesh == scene.objects[i].mesh;
    });
    if (old != my.objects.end()) {
      objects[i] = std::move(*old);
      old->object.mesh = nullptr;
    }
    objects[i].object = scene.objects[i];
    objects[i].object.paint =
        withRelief(scene.objects[i].paint, scene.relief.source, &objects[i].grey);
    if (i < texels.size() && texels[i]) objects[i].texels = texels[i];
    if (!objects[i].object.paint) {
      my.remove(objects[i]);
      objects[i].texels = nullptr;
    }
  }
  for (Impl::Drawn& old : my.objects) my.remove(old);
  my.objects = std::move(objects);
  my.base = baseMaterial(scene.haptics);
  my.height = scene.relief.height;
  my.showWhatIsDrawn();
}

void PaintLayer::show(std::optional<PaintQuantity> quantity) {
  impl_->quantity = quantity;
  impl_->showWhatIsDrawn();
}

bool PaintLayer::has(PaintQuantity quantity) const {
  return std::any_of(impl_->objects.begin(), impl_->objects.end(),
                     [&](const Impl::Drawn& drawn) { return hasPaint(drawn.object, quantity); });
}

bool PaintLayer::draws(std::size_t object) const {
  return object < impl_->objects.size() && impl_->draws(impl_->objects[object]);
}

void PaintLayer::lockRange(PaintQuantity quantity, std::optional<ValueRange> range) {
  impl_->locked[Impl::at(quantity)] = range;
}

bool PaintLayer::locked(PaintQuantity quantity) const {
  return impl_->locked[Impl::at(quantity)].has_value();
}

ValueRange PaintLayer::range(PaintQuantity quantity) const {
  const Impl& my = *impl_;
  if (my.locked[Impl::at(quantity)]) return *my.locked[Impl::at(quantity)];
  return my.found[Impl::at(quantity)].value_or(ValueRange{});
}

vtkLookupTable* PaintLayer::colors() const {
  return impl_->quantity == PaintQuantity::color ? nullptr : impl_->colors.Get();
}

void PaintLayer::setVisible(bool on) {
  impl_->visible = on;
  impl_->showWhatIsDrawn();
}

void PaintLayer::prepare() {
  Impl& my = *impl_;
  if (!my.quantity || !my.visible || !has(*my.quantity)) return;
  const PaintQuantity quantity = *my.quantity;
  std::optional<ValueRange> found;
  for (Impl::Drawn& drawn : my.objects)
    if (my.draws(drawn)) {
      const ValueRange own = my.prepareValues(drawn);
      found = found ? both(*found, own) : own;
    }
  my.found[Impl::at(quantity)] = rounded(*found);
  if (quantity != PaintQuantity::color) my.setColors(range(quantity));
  for (Impl::Drawn& drawn : my.objects) {
    if (!my.draws(drawn)) continue;
    if (channelOf(quantity))
      drawn.material->setColors(my.colors);
    else
      drawn.image->prepare(quantity, my.colors);
  }
  my.showWhatIsDrawn();
}

void PaintLayer::setWireframe(bool on) {
  impl_->wireframe = on;
  impl_->showWhatIsDrawn();
}

void PaintLayer::setCuts(vtkPlaneCollection* planes) {
  Impl& my = *impl_;
  my.cuts = planes;
  for (Impl::Drawn& drawn : my.objects)
    for (vtkActor* actor : {drawn.image ? &drawn.image->actor() : nullptr,
                            drawn.material ? &drawn.material->actor() : nullptr})
      if (actor != nullptr) actor->GetMapper()->SetClippingPlanes(planes);
}

vtkScalarBarActor& PaintLayer::bar() {
  return *impl_->bar;
}

} // namespace patina

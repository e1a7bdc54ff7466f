#include "session/store/edit_history.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/utc_time.h"

namespace patina {
namespace {

template <typename F> void forEachPart(const Scene& scene, const F& visit) {
  for (const SceneScan& scan : scene.scans)
    for (const auto& [name, text] : scan.files) visit(text.get(), text->size());
  for (const SceneObject& object : scene.objects) {
    visit(object.mesh.get(), object.mesh ? object.mesh->positions.size() * sizeof(Vec3) +
                                               object.mesh->triangles.size() * sizeof(Triangle)
                                         : 0);
    if (!object.paint) continue;
    const ObjectPaint& paint = *object.paint;
    if (paint.layout.uvs)
      visit(paint.layout.uvs.get(), paint.layout.uvs->size() * sizeof((*paint.layout.uvs)[0]));
    for (const TiledImage* image : {paint.color.get(), paint.relief.get()}) {
      if (!image) continue;
      visit(image, image->tileCount() * sizeof(void*) * 2);
      for (std::size_t i = 0; i < image->tileCount(); ++i)
        if (const auto& tile = image->sharedTile(i))
          visit(tile.get(), sizeof(TiledImage::Tile) + tile->size() * sizeof(float));
    }
    if (paint.textures) {
      visit(paint.textures.get(), paint.textures->faces.size() * sizeof(TexturedFace));
      for (const auto& [number, texture] : paint.textures->library)
        visit(texture.get(), bytes(*texture));
    }
    if (!paint.material) continue;
    visit(paint.material.get(), paint.material->blocks().size() * sizeof(MaterialBlock));
    for (const auto& [index, block] : paint.material->blocks())
      for (const auto& layer : block.layer)
        if (layer) visit(layer.get(), sizeof(MaterialLayer));
  }
}

double replayCost(const Edit& edit) {
  if (const auto* stroke = std::get_if<Stroke>(&edit))
    return 1 + static_cast<double>(stroke->samples.size());
  return 1;
}

} // namespace

EditHistory::EditHistory(Scene start, Replay replay, std::size_t budget_bytes)
    : start_(std::move(start)), replay_(std::move(replay)), budget_(budget_bytes),
      present_(start_) {
  addReferences(start_);
}

void EditHistory::append(Edit edit, Scene after, const Record& record) {
  Scene present = after;
  Entry entry{std::move(edit), std::move(after), {}, utcSeconds()};
  if (entries_.capacity() <= position_) entries_.reserve(2 * position_ + 1);
  addReferences(*entry.after);
  try {
    if (record) record(entry.edit, entry.time);
  } catch (...) {
    removeReferences(*entry.after);
    throw;
  }
  truncate();
  entries_.push_back(std::move(entry));
  present_ = std::move(present);
  position_ = entries_.size();
  evict();
}

void EditHistory::appendStored(Edit edit, Load load, std::int64_t time) {
  truncate();
  entries_.push_back({std::move(edit), std::nullopt, std::move(load), time});
  position_ = entries_.size();
}

void EditHistory::setPosition(std::size_t position, Scene present) {
  position_ = std::min(position, entries_.size());
  present_ = std::move(present);
  if (position_ == 0) return;
  Entry& entry = entries_[position_ - 1];
  if (!entry.after) {
    entry.after = present_;
    addReferences(*entry.after);
    evict(); // going back through a long history would otherwise keep every scene
  }
}

void EditHistory::truncate() {
  while (entries_.size() > position_) {
    if (entries_.back().after) removeReferences(*entries_.back().after);
    entries_.pop_back();
  }
}

bool EditHistory::undo(std::size_t steps) {
  return steps <= position_ && goTo(position_ - steps);
}

bool EditHistory::redo(std::size_t steps) {
  return steps <= redoable() && goTo(position_ + steps);
}

bool EditHistory::goTo(std::size_t position) {
  present_ = sceneAt(position);
  position_ = position;
  return true;
}

// Replays the records after the nearest earlier scene that is kept in memory or on disk.
Scene EditHistory::sceneAt(std::size_t position) const {
  std::size_t from = position;
  while (from > 0 && !entries_[from - 1].after && !entries_[from - 1].load &&
         !sceneOf(entries_[from - 1].edit))
    --from;
  Scene scene = start_;
  if (from > 0) {
    const Entry& entry = entries_[from - 1];
    scene = entry.after ? *entry.after : entry.load ? entry.load() : *sceneOf(entry.edit);
  }
  for (std::size_t i = from; i < position; ++i) scene = replay_(scene, entries_[i].edit);
  return scene;
}

const Scene* EditHistory::sceneOf(const Edit& edit) {
  const auto* whole = std::get_if<SceneEdit>(&edit);
  return whole ? whole->scene.get() : nullptr;
}

std::vector<std::string> EditHistory::descriptions() const {
  std::vector<std::string> list;
  for (const Entry& entry : entries_) list.push_back(describe(entry.edit));
  return list;
}

std::vector<std::size_t> EditHistory::checkpoints(double cost) const {
  std::vector<std::size_t> chosen;
  double since = 0;
  for (std::size_t at = position_; at > 0; --at) {
    since += replayCost(entries_[at - 1].edit);
    if (since < cost || !(entries_[at - 1].after || entries_[at - 1].load)) continue;
    chosen.push_back(at);
    since = 0;
    cost *= 2;
  }
  std::reverse(chosen.begin(), chosen.end());
  return chosen;
}

void EditHistory::addReferences(const Scene& scene) {
  forEachPart(scene, [&](const void* part, std::size_t size) {
    if (shared_[part]++ == 0) bytes_ += size;
  });
}

void EditHistory::removeReferences(const Scene& scene) {
  forEachPart(scene, [&](const void* part, std::size_t size) {
    const auto found = shared_.find(part);
    if (--found->second > 0) return;
    shared_.erase(found);
    bytes_ -= size;
  });
}

std::size_t EditHistory::scenes() const {
  return 1 + static_cast<std::size_t>(
                 std::count_if(entries_.begin(), entries_.end(),
                               [](const Entry& entry) { return entry.after.has_value(); }));
}

// Evicts the scene with the lowest cost: its replay cost over its distance from the present.
void EditHistory::evict() {
  while (bytes_ > budget_) {
    Entry* least = nullptr;
    double min_score = std::numeric_limits<double>::infinity();
    double gap = 0, from_start = 0, to_here = 0;
    for (std::size_t i = 0; i < position_; ++i) to_here += replayCost(entries_[i].edit);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      Entry& entry = entries_[i];
      const double cost = replayCost(entry.edit);
      gap += cost;
      from_start += cost;
      if (!entry.after) continue;
      double ahead = 0; // replay cost to the next kept scene
      for (std::size_t k = i + 1; k < entries_.size() && !entries_[k].after; ++k)
        ahead += replayCost(entries_[k].edit);
      const bool droppable = i + 1 != position_ && !sceneOf(entry.edit);
      const double score = (gap + ahead) / (1 + std::abs(to_here - from_start));
      if (droppable && score < min_score) {
        min_score = score;
        least = &entry;
      }
      gap = 0;
    }
    if (!least) return;
    removeReferences(*least->after);
    least->after.reset();
  }
}

} // namespace patina

#include "haptics/contact_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "haptics/ray_search.h"

namespace patina {
namespace {

constexpr double kMinGradient = 0.1; // K05
constexpr double kCreep = 0.25;      // voxels a tick
// Cosine between a coarse direction and the normal where it leads, from which the normal is
// believed less and not at all: in a concave crease it is that of one of the two faces, by chance.
constexpr double kAlike = 0.95, kUnlike = 0.85;
constexpr int kRefinements = 2;
constexpr double kDeepFrom = 2.75;     // voxels before the band's end, where the sampler turns deep
constexpr double kHandoverTime = 5e-3; // [s]
// Grid sides a second at most: across a deep solid the difference is of the solid's size, and to
// lose it in 5 ms would be a jump fault. A quarter of that threshold.
constexpr double kHandoverSpeed = 5;
// A VCP that moves so far in a tick while its normal turns by 25 to 155 degrees has gone to another
// face; what turns farther is the hold's.
constexpr double kLeapTurn = 0.9;
constexpr double kLeapVoxels = 0.25;

const SurfaceField& sampled(const std::shared_ptr<const SurfaceField>& field) {
  if (!field) throw std::invalid_argument("contact: no field");
  return *field;
}

bool outOfGrid(const FieldGrid& grid, const Vec3& q) noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    const double last = grid.nodes[static_cast<std::size_t>(axis)] - 1;
    if (!(q[axis] >= 0 && q[axis] <= last)) return true;
  }
  return false;
}

// K05; zero if there is no direction.
Vec3 directionAt(const GridSample& sample, const ContactMemory& memory) noexcept {
  const double squared = sample.gradient.squaredNorm();
  if (squared >= kMinGradient * kMinGradient) return sample.gradient / std::sqrt(squared);
  return memory.in_contact ? memory.last_normal : Vec3::Zero();
}

} // namespace

ContactStage::ContactStage(std::shared_ptr<const SurfaceField> field, Sampler sampler, double iso,
                           bool history)
    : field_(std::move(field)), sampler_(sampled(field_), sampler), voxel_(field_->grid.voxel),
      per_voxel_(1 / voxel_), iso_(iso * per_voxel_),
      hold_limit_(0.25 * *std::max_element(field_->grid.nodes.begin(), field_->grid.nodes.end())),
      history_(history) {}

void ContactStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  const Vec3 q = toGrid(contact.tip);
  if (outOfGrid(sampler_.grid(), q)) ++memory.outside_ticks;
  const GridSample sample = sampler_.atGrid(q);
  contact.samples = 1;
  const double f = sample.phi - iso_;
  Vec3 direction = f < 0 ? directionAt(sample, memory) : Vec3::Zero();

  Found found;
  bool at_once = false, ahead = false;
  if (sample.region == FieldRegion::deep && f < 0) [[unlikely]] {
    // About the middle the blend of opposite directions is one of none of them (F9). A VCP that is
    // there stays ahead; else the nearest one that a coarse node knows.
    const std::optional<FieldSampler::DeepFeet> feet = sampler_.deepFeet(q);
    if (feet && feet->opposed) {
      ahead = history_ && memory.in_contact;
      if (ahead)
        direction = memory.last_normal;
      else
        at_once = towardsFoot(q, feet->nearest, found);
    }
  }
  if (at_once) {
    contact.deep = true;
    finish(found, contact, memory);
  } else if (history_ && hold(q, sample, direction, memory, found)) {
    finish(found, contact, memory);
  } else if (f < 0) {
    alongRay(q, sample, direction, contact, found);
    if (ahead && found.mode == ContactMode::ray) found.mode = ContactMode::ahead;
    finish(found, contact, memory);
  } else {
    memory.leaveContact();
  }
  memory.clearance = f;
}

// Whether the tip is on the wrong side of a surface that it entered by; the VCP on that surface.
bool ContactStage::hold(const Vec3& q, const GridSample& sample, const Vec3& direction,
                        const ContactMemory& memory, Found& found) const noexcept {
  if (!memory.has_last_tip) return false;
  const double f = sample.phi - iso_;
  if (memory.in_contact) {
    const Vec3 last = toGrid(memory.last_candidate);
    const double turned = direction.dot(memory.last_normal);
    const bool wrong_side = f < 0 ? (memory.held() ? turned < 0.5 : turned < 0)
                                  : (q - last).dot(memory.last_normal) < 0;
    // Inside, letting go would turn the force around; there it has no limit.
    const double limit = f < 0 ? std::numeric_limits<double>::infinity() : hold_limit_;
    // Nor may the VCP run round a solid whose middle the tip has passed.
    const double reach = f < 0 ? kCreep + 4 * (q - toGrid(memory.last_tip)).norm() : limit;
    return wrong_side && follow(q, {last, memory.last_normal}, limit, reach, found);
  }
  // Slow motion ends here: a 1-Lipschitz field has no surface between two points whose clearances
  // together exceed their distance, and a tip that enters moves against the direction.
  const Vec3 from = toGrid(memory.last_tip);
  const double step = (q - from).norm();
  const bool suspicious = f < 0 ? direction.dot(q - from) > 0 : f + memory.clearance < step;
  if (!suspicious || !(memory.clearance >= 0 && memory.clearance < step)) return false;
  const std::optional<SurfaceContact> entry = firstCrossing(sampler_, from, q, iso_);
  if (!entry || (f < 0 && entry->normal.dot(direction) > 0)) return false;
  return follow(q, *entry, hold_limit_, hold_limit_, found);
}

// Leaves `found` alone unless it succeeds.
bool ContactStage::follow(const Vec3& q, const SurfaceContact& from, double limit, double reach,
                          Found& found) const noexcept {
  const std::optional<SurfaceContact> foot = trackFoot(sampler_, q, from, iso_, reach);
  if (!foot) return false;
  const double depth = (foot->point - q).dot(foot->normal);
  if (!(depth > 0 && depth < limit)) return false;
  found = {foot->normal, depth, ContactMode::held};
  return true;
}

// Leaves `found` alone unless it succeeds.
bool ContactStage::towardsFoot(const Vec3& q, const Vec3& near, Found& found) const noexcept {
  const std::optional<Vec3> foot = descendToNearest(sampler_, q, near, iso_);
  if (!foot) return false;
  const Vec3 out = *foot - q;
  const double depth = out.norm();
  if (!(depth > 0)) return false;
  found = {out / depth, depth, ContactMode::ahead};
  return true;
}

void ContactStage::alongRay(const Vec3& q, const GridSample& sample, const Vec3& direction,
                            Contact& contact, Found& found) const noexcept {
  contact.deep = sample.region == FieldRegion::deep;
  found.normal = direction;
  if (direction.isZero()) return;
  const RayRoot root = rayRoot(sampler_, q, direction, iso_ - sample.phi, iso_);
  contact.samples += root.samples;
  if (root.found) {
    found.depth = root.s;
    if (contact.deep) refine(q, contact, found);
    return;
  }
  // F9. A distance's own slope is 1; where the blended gradient is shorter, at a crease, dividing
  // by it would throw the VCP far beyond the part.
  found.depth = iso_ - sample.phi;
  found.mode = ContactMode::newton;
}

// The normal where the ray ends is nearer to the nearest point's than a coarse direction is, by
// depth over radius of curvature. It fades in behind the band and out again where depth may exceed
// that radius, so that the force is continuous.
void ContactStage::refine(const Vec3& q, Contact& contact, Found& found) const noexcept {
  const double band = field_->band;
  const double weight =
      std::clamp(std::min(found.depth - (band - kDeepFrom), 3 - found.depth / band), 0.0, 1.0);
  if (!(weight > 0)) return;
  for (int i = 0; i < kRefinements; ++i) {
    const GridSample surface = sampler_.atGrid(q + found.depth * found.normal);
    ++contact.samples;
    if (!(surface.gradient.dot(found.normal) > kMinGradient)) return;
    const Vec3 there = surface.gradient.normalized();
    const double agrees =
        std::clamp((surface.gradient.dot(found.normal) - kUnlike) / (kAlike - kUnlike), 0.0, 1.0);
    if (!(agrees > 0)) return;
    const Vec3 normal = (found.normal + weight * agrees * (there - found.normal)).normalized();
    const RayRoot root = rayRoot(sampler_, q, normal, found.depth, iso_);
    contact.samples += root.samples;
    if (!root.found) return;
    found.depth = root.s;
    found.normal = normal;
  }
}

void ContactStage::finish(const Found& found, Contact& contact,
                          ContactMemory& memory) const noexcept {
  contact.touching = true;
  contact.held = found.mode == ContactMode::held;
  contact.approximate = found.mode == ContactMode::newton;
  contact.normal = found.normal;
  contact.depth = found.depth * voxel_;
  contact.candidate = contact.tip + contact.depth * found.normal;

  const Vec3 step = contact.tip - memory.last_tip;
  if (!history_ && memory.in_contact && found.normal.dot(memory.last_normal) < 0)
    contact.slip_step = (contact.candidate - memory.last_candidate)
                            .norm(); // the paper's form turns round by its own rule
  // Deeper than the band the ray may go from one face of an edge to the other within a tick.
  const double turned = found.normal.dot(memory.last_normal);
  const bool leapt =
      history_ && contact.deep && found.mode == ContactMode::ray && std::abs(turned) < kLeapTurn &&
      (contact.candidate - memory.last_candidate).norm() > kLeapVoxels * voxel_ + 10 * step.norm();
  if (memory.in_contact && (memory.mode != found.mode || leapt)) {
    // Where the old way would have put it: along with the tip over the surface.
    const Vec3 over = step - step.dot(memory.last_normal) * memory.last_normal;
    memory.handover = memory.last_candidate + over - contact.candidate;
    memory.has_handover = true;
  }
  if (memory.has_handover) {
    const double along = memory.handover.dot(found.normal);
    memory.has_handover = contact.depth + along >= -0.1 * contact.depth &&
                          memory.handover.squaredNorm() > 1e-12 * voxel_ * voxel_;
    if (memory.has_handover) {
      contact.candidate += memory.handover;
      contact.depth = std::max(0.0, contact.depth + along);
      const double dt = std::max(contact.dt, 0.0);
      const double gone = kHandoverSpeed * 4 * hold_limit_ * voxel_ * dt;
      memory.handover *=
          std::max(kHandoverTime / (kHandoverTime + dt), 1 - gone / memory.handover.norm());
    }
  }
  contact.vcp = contact.candidate;
  contact.surface = contact.candidate - iso_ * voxel_ * found.normal;
  memory.in_contact = true;
  memory.mode = found.mode;
  memory.last_candidate = contact.candidate;
  if (!found.normal.isZero()) memory.last_normal = found.normal;
}

} // namespace patina

#include "haptics/law/proxy_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptics/law/contact_memory.h"

namespace patina {
namespace {

constexpr double kMaxTick = 0.05;          // longest tick with proxy motion without the tip [s]
constexpr double kSafeClearance = 0.1;     // clearance above which phi is not evaluated [voxels]
constexpr double kMaxGridCoordinate = 1e9; // [voxels]
constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr double kNoDepth = 1e-9; // [voxels]
constexpr double kSamePlace =
    0.1; // largest shift of a surface by an edit that keeps stiction [voxels]

double sideOf(const FieldGrid& grid) {
  return grid.voxel * (*std::max_element(grid.nodes.begin(), grid.nodes.end()) - 1);
}

void recordClearance(const Contact& contact, ContactPointMemory& memory) noexcept {
  memory.c.reset();
  memory.clearance = contact.clearance;
}

void copyWalls(const Walls& walls, const WallProjection& held, double voxel, Contact& contact) {
  contact.walls = held.count;
  for (int i = 0; i < held.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    contact.wall[k] = {walls[held.active[k]].normal, voxel * held.multiplier[k]};
    for (std::size_t j = k; j > 0 && contact.wall[j].multiplier > contact.wall[j - 1].multiplier;
         --j)
      std::swap(contact.wall[j], contact.wall[j - 1]);
  }
}

} // namespace

ProxyStage::ProxyStage(const FieldSampler& sampler, double iso, double lipschitz, bool curved)
    : sampler_(sampler), search_(sampler_, iso / sampler.grid().voxel, lipschitz, curved),
      voxel_(sampler.grid().voxel), iso_(iso * sampler_.perVoxel()), lipschitz_(lipschitz),
      per_lipschitz_(1 / lipschitz), snap_speed_(kSnapSides * sideOf(sampler.grid())),
      curved_(curved) {}

void ProxyStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  ContactPointMemory& at = memory.contact;
  const Vec3 x = sampler_.toGrid(contact.tip);
  const Vec3 last = memory.tip.last ? sampler_.toGrid(*memory.tip.last) : x;
  const Vec3 from = last.cwiseAbs().maxCoeff() < kMaxGridCoordinate ? last : x;
  if (!(x.cwiseAbs().maxCoeff() < kMaxGridCoordinate)) // squares would overflow
    return recordClearance(contact, at);
  Proxy& proxy = memory.proxy;
  double step_radius =
      (x - from).norm() + snap_speed_ * sampler_.perVoxel() * std::clamp(contact.dt, 0.0, kMaxTick);
  if (at.c) {
    proxy.c = sampler_.toGrid(*at.c);
    if (at.reproject) {
      proxy.walls.count = 0;
      proxy.generated_energy = 0;
      if (!search_.reproject(x, proxy.c, contact.samples)) return recordClearance(contact, at);
      // Stiction to a surface that has moved would keep its old force.
      if ((proxy.c - sampler_.toGrid(*at.c)).squaredNorm() > kSamePlace * kSamePlace)
        contact.release_stick = true;
    }
  } else {
    if (!enter(x, from, memory, contact, proxy.c)) return recordClearance(contact, at);
    proxy.walls.count = 0;
    proxy.generated_energy = 0;
    step_radius += (x - proxy.c).norm();
  }
  at.reproject = false;
  const ProxyMove move = search_.follow(x, at.c ? from : proxy.c, step_radius, proxy);
  contact.samples += move.samples;
  if (!move.touching) {
    contact.clearance = per_lipschitz_ * move.clearance;
    return recordClearance(contact, at);
  }
  contact.touching = true;
  contact.frictionless_point = sampler_.grid().origin + voxel_ * proxy.c;
  contact.vcp = contact.frictionless_point;
  if (at.c) contact.displacement = contact.frictionless_point - *at.c;
  at.c = contact.frictionless_point;
  at.clearance = contact.clearance = 0;
  if (move.smooth) {
    contact.normal = proxy.walls[0].normal;
    contact.depth = voxel_ * move.held.multiplier[0];
    contact.wall[0] = {contact.normal, contact.depth};
    contact.walls = 1;
    contact.surface = contact.frictionless_point - iso_ * voxel_ * contact.normal;
    contact.jacobian = move.jacobian;
    return;
  }
  const Vec3 out = proxy.c - x;
  const double depth = out.norm();
  contact.snap = move.snap;
  contact.depth = voxel_ * depth;
  if (depth > kNoDepth) contact.normal = 1 / depth * out;
  copyWalls(proxy.walls, move.held, voxel_, contact);
  if (contact.walls == 0) { // contact ended within rounding
    contact.walls = 1;
    contact.wall[0] = {contact.normal, contact.depth};
  } else if (contact.normal.isZero(0)) {
    contact.normal = contact.wall[0].normal;
  }
  contact.surface = contact.frictionless_point - iso_ * voxel_ * contact.wall[0].normal;
  if (BandCell cell; curved_ && contact.walls == 1 && sampler_.cellAt(proxy.c, cell))
    contact.jacobian.emplace(cell, contact.wall[0].normal, depth, iso_);
}

// Detects a new contact and finds its point.
bool ProxyStage::enter(const Vec3& x, const Vec3& from, const ContactMemory& memory,
                       Contact& contact, Vec3& c) const noexcept {
  const double step = (x - from).norm();
  double known = memory.tip.last ? memory.contact.clearance : kUnknown;
  if (std::isfinite(known) && known - step > kSafeClearance) {
    contact.clearance = known - step;
    return false;
  }
  const double height = search_.heightAt(x);
  ++contact.samples;
  bool came = std::isfinite(known) && known >= 0;
  if (!came && memory.tip.last && height < 0) {
    known = per_lipschitz_ * search_.heightAt(from);
    ++contact.samples;
    came = known >= 0;
  }
  if (height >= 0 && (!came || per_lipschitz_ * height + known >= step)) {
    contact.clearance = per_lipschitz_ * height;
    return false;
  }
  std::optional<Vec3> at;
  if (came)
    at = search_.firstCrossing(from, known * lipschitz_, x, height, contact.samples);
  else
    at = search_.seekSurface(x, contact.samples);
  if (at) c = *at;
  if (!at && height >= 0) contact.clearance = per_lipschitz_ * height;
  contact.deep = at && !came;
  return at.has_value();
}

} // namespace patina

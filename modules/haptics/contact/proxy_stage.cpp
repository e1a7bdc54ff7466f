#include "haptics/contact/proxy_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptics/contact/contact_memory.h"

namespace patina {
namespace {

constexpr double kLongestTick = 0.05; // [s], of those that a proxy may run on its own
constexpr double kUnlooked = 0.1;     // voxels of clearance that nobody needs to look at
constexpr double kFarthest = 1e9;     // voxels
constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr double kNoDepth = 1e-9;  // voxels
constexpr double kSamePlace = 0.1; // voxels, of a surface before and after an edit

double sideOf(const FieldGrid& grid) {
  return grid.voxel * (*std::max_element(grid.nodes.begin(), grid.nodes.end()) - 1);
}

void stayFree(const Contact& contact, ContactPointMemory& memory) noexcept {
  memory.c.reset();
  memory.clearance = contact.clearance;
}

void takeWalls(const Walls& walls, const WallProjection& held, double voxel, Contact& contact) {
  contact.walls = held.count;
  for (int i = 0; i < held.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    contact.wall[k] = {walls[held.active[k]].normal, voxel * held.load[k]};
    for (std::size_t j = k; j > 0 && contact.wall[j].load > contact.wall[j - 1].load; --j)
      std::swap(contact.wall[j], contact.wall[j - 1]);
  }
}

} // namespace

ProxyStage::ProxyStage(const FieldSampler& sampler, double iso, double steepness, bool curved)
    : sampler_(sampler), search_(sampler_, iso / sampler.grid().voxel, steepness, curved),
      voxel_(sampler.grid().voxel), iso_(iso * sampler_.perVoxel()), steepness_(steepness),
      per_steepness_(1 / steepness), snap_speed_(kSnapSides * sideOf(sampler.grid())),
      curved_(curved) {}

void ProxyStage::apply(Contact& contact, ContactMemory& memory) const noexcept {
  ContactPointMemory& at = memory.contact;
  const Vec3 x = sampler_.toGrid(contact.tip);
  const Vec3 last = memory.tip.last ? sampler_.toGrid(*memory.tip.last) : x;
  const Vec3 from = last.cwiseAbs().maxCoeff() < kFarthest ? last : x;
  if (!(x.cwiseAbs().maxCoeff() < kFarthest)) // no place at all: squares would overflow
    return stayFree(contact, at);
  Proxy& proxy = memory.proxy;
  double ball = (x - from).norm() +
                snap_speed_ * sampler_.perVoxel() * std::clamp(contact.dt, 0.0, kLongestTick);
  if (at.c) {
    proxy.c = sampler_.toGrid(*at.c);
    if (at.reseat) {
      proxy.walls.count = 0;
      proxy.lent = 0;
      if (!search_.seat(x, proxy.c, contact.samples)) return stayFree(contact, at);
      // What stuck to a surface that is elsewhere now would hold the old one's force.
      if ((proxy.c - sampler_.toGrid(*at.c)).squaredNorm() > kSamePlace * kSamePlace)
        contact.lets_go = true;
    }
  } else {
    if (!enter(x, from, memory, contact, proxy.c)) return stayFree(contact, at);
    proxy.walls.count = 0;
    proxy.lent = 0;
    ball += (x - proxy.c).norm();
  }
  at.reseat = false;
  const ProxyMove move = search_.follow(x, at.c ? from : proxy.c, ball, proxy);
  contact.samples += move.samples;
  if (!move.touching) {
    contact.clearance = per_steepness_ * move.clearance;
    return stayFree(contact, at);
  }
  contact.touching = true;
  contact.candidate = sampler_.grid().origin + voxel_ * proxy.c;
  contact.vcp = contact.candidate;
  if (at.c) contact.drawn = contact.candidate - *at.c;
  at.c = contact.candidate;
  at.clearance = contact.clearance = 0;
  if (move.smooth) {
    contact.normal = proxy.walls[0].normal;
    contact.depth = voxel_ * move.held.load[0];
    contact.wall[0] = {contact.normal, contact.depth};
    contact.walls = 1;
    contact.surface = contact.candidate - iso_ * voxel_ * contact.normal;
    contact.jacobian = move.jacobian;
    return;
  }
  const Vec3 out = proxy.c - x;
  const double depth = out.norm();
  contact.snap = move.snap;
  contact.depth = voxel_ * depth;
  if (depth > kNoDepth) contact.normal = 1 / depth * out;
  takeWalls(proxy.walls, move.held, voxel_, contact);
  if (contact.walls == 0) { // the way of contact ended within rounding
    contact.walls = 1;
    contact.wall[0] = {contact.normal, contact.depth};
  } else if (contact.normal.isZero(0)) {
    contact.normal = contact.wall[0].normal;
  }
  contact.surface = contact.candidate - iso_ * voxel_ * contact.wall[0].normal;
  if (BandCell cell; curved_ && contact.walls == 1 && sampler_.cellAt(proxy.c, cell))
    contact.jacobian.emplace(cell, contact.wall[0].normal, depth, iso_);
}

// Whether the tip has come into contact, and where.
bool ProxyStage::enter(const Vec3& x, const Vec3& from, const ContactMemory& memory,
                       Contact& contact, Vec3& c) const noexcept {
  const double step = (x - from).norm();
  double known = memory.tip.last ? memory.contact.clearance : kUnknown;
  if (std::isfinite(known) && known - step > kUnlooked) {
    contact.clearance = known - step;
    return false;
  }
  const double height = search_.heightAt(x);
  ++contact.samples;
  bool came = std::isfinite(known) && known >= 0;
  if (!came && memory.tip.last && height < 0) {
    known = per_steepness_ * search_.heightAt(from);
    ++contact.samples;
    came = known >= 0;
  }
  if (height >= 0 && (!came || per_steepness_ * height + known >= step)) {
    contact.clearance = per_steepness_ * height;
    return false;
  }
  std::optional<Vec3> at;
  if (came)
    at = search_.firstCrossing(from, known * steepness_, x, height, contact.samples);
  else
    at = search_.seekSurface(x, contact.samples);
  if (at) c = *at;
  if (!at && height >= 0) contact.clearance = per_steepness_ * height;
  contact.deep = at && !came;
  return at.has_value();
}

} // namespace patina

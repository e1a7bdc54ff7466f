// Cluster hierarchy of WindingNumber (Barill et al. 2018). Internal to winding_number*.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/mesh/triangle_mesh.h"

namespace patina::winding {

using Float4 = float __attribute__((vector_size(16)));
using Mask4 = std::int32_t __attribute__((vector_size(16)));

inline constexpr std::size_t kLeafTriangles = 16; // at most

// Four triangles, one a lane. Empty lanes have three equal corners and thus no solid angle.
struct Packet {
  std::array<Float4, 3> a, b, c;
};

// Four sibling clusters, one a lane. With r = centre - q and rho = |r| a cluster's solid angle is
//   [ dipole.r + second(r,r) / rho^2 + third(r,r,r) / rho^4 ] / rho^3,
// the Taylor expansion of (x - q).n / |x - q|^3 about its centre. The moments include the factors
// of the derivatives of 1/rho, and no traces, which vanish because 1/rho is harmonic.
struct ClusterNode4 {
  std::array<Float4, 3> centre;
  Float4 far_squared; // smallest valid squared distance; -1 in empty lanes
  std::array<Float4, 3> dipole;
  std::array<Float4, 6> second; // xx yy zz xy xz yz
  std::array<Float4, 10> third; // xxx yyy zzz xxy xxz yyx yyz zzx zzy xyz
  // ClusterNode4 of the children (always a later one), or -1 for a leaf, which has packets.
  std::array<std::int32_t, 4> children;
  std::array<std::uint32_t, 4> first_packet, packet_count;
};

struct Tree {
  Vec3 origin = Vec3::Zero();
  double scale = 1; // tree coordinates = (p - origin) * scale, within a unit cube
  std::vector<Packet> packets;
  std::vector<ClusterNode4> nodes; // the first is the root; none if there is no triangle
};

Tree build(const TriangleMesh& mesh, double accuracy);

// Symmetric parts of the integrals of n, n (x) d and n (x) d (x) d over a cluster, d = x - centre.
struct Moments {
  std::array<float, 3> centre{};
  float radius = -1; // bounds the cluster about the centre; -1 = no cluster
  float area = 0;
  Eigen::Vector3f low = Eigen::Vector3f::Constant(2), high = Eigen::Vector3f::Constant(-2); // box
  std::array<float, 3> n{};
  std::array<float, 6> m{};  // in the order of ClusterNode4::second
  std::array<float, 10> s{}; // in the order of ClusterNode4::third
};

Moments leafMoments(const Packet* packets, std::size_t count); // count <= kLeafTriangles / 4
Moments parentOf(const std::array<Moments, 4>& children);
void store(const Moments& cluster, float accuracy, ClusterNode4& node, int lane);

// Triangles to sum, in Morton order.
struct Item {
  std::uint32_t code;
  std::uint32_t triangle : 31;
  std::uint32_t flip : 1;
};
// Drops coincident triangles as WindingNumber documents. items: every finite triangle, unflipped,
// sorted by code and then by triangle; coincident triangles have equal codes.
std::vector<Item> withoutCoincident(const TriangleMesh& mesh, std::vector<Item> items);

} // namespace patina::winding

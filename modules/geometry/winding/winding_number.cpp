#include "geometry/winding/winding_number.h"

#include <cmath>
#include <cstring>
#include <numbers>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "geometry/winding/winding_number_tree.h"

namespace patina {

using winding::ClusterNode4;
using winding::Float4;
using winding::Mask4;
using winding::Packet;
using winding::Tree;

namespace {

Float4 root(Float4 x) {
#if defined(__SSE2__)
  return _mm_sqrt_ps(x);
#else
  for (int i = 0; i < 4; ++i) x[i] = std::sqrt(x[i]);
  return x;
#endif
}

Float4 keep(Mask4 mask, Float4 x) {
  return reinterpret_cast<Float4>(mask & reinterpret_cast<Mask4>(x));
}

Float4 select(Mask4 mask, Float4 yes, Float4 no) {
  return reinterpret_cast<Float4>((mask & reinterpret_cast<Mask4>(yes)) |
                                  (~mask & reinterpret_cast<Mask4>(no)));
}

float sum(Float4 x) {
  return (x[0] + x[1]) + (x[2] + x[3]);
}

struct Point4 {
  Float4 x, y, z;
};

Float4 splat(float x) {
  return Float4{x, x, x, x};
}

Float4 dot(const Point4& a, const Point4& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Point4 minus(const std::array<Float4, 3>& a, const Point4& b) {
  return {a[0] - b.x, a[1] - b.y, a[2] - b.z};
}

// Adds half solid angles by multiplying complex numbers, so that one arc tangent serves all
// triangles of a query; counts the full turns where the argument passes +-pi.
class SolidAngles {
 public:
  void add(const Packet& packet, const Point4& q) {
    const Point4 a = minus(packet.a, q);
    const Point4 b = minus(packet.b, q);
    const Point4 c = minus(packet.c, q);
    const Float4 la = root(dot(a, a));
    const Float4 lb = root(dot(b, b));
    const Float4 lc = root(dot(c, c));
    Float4 im = a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                a.z * (b.x * c.y - b.y * c.x);
    Float4 re = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    // At a corner both vanish: no angle.
    const Float4 size = root(re * re + im * im);
    const Mask4 some = size > splat(1e-30F);
    const Float4 scale = splat(1) / select(some, size, splat(1));
    re = select(some, re * scale, splat(1));
    im = keep(some, im * scale);

    const Float4 zero = splat(0);
    const Float4 re_next = re_ * re - im_ * im;
    const Float4 im_next = re_ * im + im_ * re;
    const Mask4 up = (im_ >= zero) & (im >= zero) & (im_next < zero);
    const Mask4 down = (im_ < zero) & (im < zero) & (im_next >= zero);
    turns_ += down - up; // Masks are -1 for true.
    re_ = re_next;
    im_ = im_next;
  }

  double turns() const {
    double total = 0;
    for (int i = 0; i < 4; ++i) {
      double angle = std::atan2(im_[i], re_[i]);
      total += turns_[i] + angle / (2 * std::numbers::pi);
    }
    return total;
  }

 private:
  Float4 re_ = {1, 1, 1, 1};
  Float4 im_ = {0, 0, 0, 0};
  Mask4 turns_ = {0, 0, 0, 0};
};

// Adds the expansions of the far lanes; returns the near lanes as bits.
int addFar(const ClusterNode4& node, const Point4& q, Float4& solid_angle) {
  const Point4 r = minus(node.centre, q);
  const Float4 xx = r.x * r.x;
  const Float4 yy = r.y * r.y;
  const Float4 zz = r.z * r.z;
  const Float4 squared = xx + yy + zz;
  const Mask4 far = squared > node.far_squared;
  const Float4 inverse = splat(1) / squared;
  const Float4 first = node.dipole[0] * r.x + node.dipole[1] * r.y + node.dipole[2] * r.z;
  const auto& m = node.second;
  const Float4 second = m[0] * xx + m[1] * yy + m[2] * zz + m[3] * (r.x * r.y) +
                        m[4] * (r.x * r.z) + m[5] * (r.y * r.z);
  const auto& s = node.third;
  const Float4 third = r.x * (s[0] * xx + s[5] * yy + s[7] * zz + s[9] * (r.y * r.z)) +
                       r.y * (s[1] * yy + s[3] * xx + s[8] * zz) +
                       r.z * (s[2] * zz + s[4] * xx + s[6] * yy);
  const Float4 all = (first + (second + third * inverse) * inverse) * inverse * root(inverse);
  solid_angle += keep(far, all);
  const Mask4 near = ~far;
#if defined(__SSE2__)
  return _mm_movemask_ps(reinterpret_cast<__m128>(near));
#else
  return (near[0] & 1) | (near[1] & 2) | (near[2] & 4) | (near[3] & 8);
#endif
}

} // namespace

struct WindingNumber::Impl {
  Tree tree;
};

WindingNumber::WindingNumber(const TriangleMesh& mesh, double accuracy)
    : impl_(std::make_unique<Impl>(Impl{winding::build(mesh, accuracy)})) {}
WindingNumber::WindingNumber(WindingNumber&&) noexcept = default;
WindingNumber& WindingNumber::operator=(WindingNumber&&) noexcept = default;
WindingNumber::~WindingNumber() = default;

double WindingNumber::at(const Vec3& p) const {
  const Tree& tree = impl_->tree;
  const Vec3 local = (p - tree.origin) * tree.scale;
  // Farther away (or NaN) the solid angle is negligible, and squares would overflow.
  if (tree.nodes.empty() || !(local.cwiseAbs().maxCoeff() < 1e6)) return 0;
  const Point4 q{splat(static_cast<float>(local.x())), splat(static_cast<float>(local.y())),
                 splat(static_cast<float>(local.z()))};

  // Depth first: at most three entries a level remain, and the tree is no deeper than the 30 bits
  // of a code plus the halvings of equal codes.
  std::array<std::int32_t, 256> stack;
  std::size_t waiting = 0;
  stack[waiting++] = 0;
  Float4 far = splat(0);
  SolidAngles near;
  while (waiting > 0) {
    const ClusterNode4& node = tree.nodes[static_cast<std::size_t>(stack[--waiting])];
    const int lanes = addFar(node, q, far);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      if (!(lanes >> lane & 1)) continue;
      if (node.children[lane] >= 0) {
        stack[waiting++] = node.children[lane];
        continue;
      }
      for (std::uint32_t i = 0; i < node.packet_count[lane]; ++i)
        near.add(tree.packets[node.first_packet[lane] + i], q);
    }
  }
  return near.turns() + static_cast<double>(sum(far)) / (4 * std::numbers::pi);
}

std::size_t WindingNumber::bytes() const {
  return sizeof(Impl) + impl_->tree.packets.capacity() * sizeof(Packet) +
         impl_->tree.nodes.capacity() * sizeof(ClusterNode4);
}

} // namespace patina

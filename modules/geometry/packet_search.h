// Part of the packet kernel (see triangle_packet_kernel.h): descents of the tree.
#pragma once

#include "geometry/packet_triangles.h"

namespace patina::PATINA_KERNEL {

constexpr int kStack = 640; // 7 more a level; the tree's depth is bounded by its builder

struct Entry {
  float d2;
  std::int32_t node, place;
};

// The triangles below `at` that any point may need. Children near the packet's box, nearest last,
// go on the stack; each is tested against every point when its turn comes, by when the limits are
// tighter.
inline void search(const LatticeJob& job, const Points& p, const Box& box, std::int32_t at,
                   Answer& answer) {
  Entry stack[kStack];
  int top = 0;
  for (;;) {
    const WideNode& node = job.nodes[at];
    const Lanes d2 = boxDistances(node.centre, node.half, box);
    unsigned near = bits(d2 <= spread(answer.max_limit));
    alignas(32) float distance[kWide];
    store(distance, d2);
    const int base = top;
    while (near) {
      const int place = __builtin_ctz(near);
      near &= near - 1;
      int slot = top++;
      while (slot > base && stack[slot - 1].d2 < distance[place]) {
        stack[slot] = stack[slot - 1];
        --slot;
      }
      stack[slot] = {distance[place], at, place};
    }
    for (;;) {
      if (top == 0) return;
      const Entry entry = stack[--top];
      if (entry.d2 > answer.max_limit) continue;
      const WideNode& parent = job.nodes[entry.node];
      const std::int32_t child = parent.child[entry.place];
      if (child < 0) {
        tryTriangle(job.triangles, ~child, p, answer);
        continue;
      }
      if (!any(childDistance(parent, entry.place, p) <= answer.limit)) continue;
      at = child;
      break;
    }
  }
}

// The same where the limits are tight already: then order gains nothing, and costs.
inline void searchWarm(const LatticeJob& job, const Points& p, const Box& box, std::int32_t at,
                       Answer& answer) {
  std::int32_t stack[kStack];
  int top = 0;
  stack[top++] = at;
  while (top > 0) {
    const WideNode& node = job.nodes[stack[--top]];
    unsigned near = bits(boxDistances(node.centre, node.half, box) <= spread(answer.max_limit));
    while (near) {
      const int place = __builtin_ctz(near);
      near &= near - 1;
      const std::int32_t child = node.child[place];
      if (child < 0)
        tryTriangle(job.triangles, ~child, p, answer);
      else if (any(childDistance(node, place, p) <= answer.limit))
        stack[top++] = child;
    }
  }
}

struct PointEntry {
  float d2;
  std::int32_t node;
};

// From the node `at`; `visit` gets triangles at hand and tightens the limit, which it returns.
template <typename Visit>
PATINA_INLINE void descend(const WideNode* nodes, const Points& p, std::int32_t at, float limit,
                           const Visit& visit) {
  PointEntry stack[kStack];
  int top = 0;
  for (;;) {
    const WideNode& node = nodes[at];
    const Lanes d2 = childDistances(node, p);
    unsigned near = bits(d2 <= spread(limit));
    alignas(32) float distance[kWide];
    store(distance, d2);
    std::int32_t triangle[kWide];
    int triangles = 0;
    const int base = top;
    while (near) {
      const int place = __builtin_ctz(near);
      near &= near - 1;
      const std::int32_t child = node.child[place];
      if (child < 0) {
        triangle[triangles++] = ~child;
        continue;
      }
      int slot = top++;
      while (slot > base && stack[slot - 1].d2 < distance[place]) {
        stack[slot] = stack[slot - 1];
        --slot;
      }
      stack[slot] = {distance[place], child};
    }
    if (triangles > 0) limit = visit(triangle, triangles);
    do {
      if (top == 0) return;
      --top;
    } while (stack[top].d2 > limit);
    at = stack[top].node;
  }
}

inline void searchPoint(const LatticeJob& job, const Points& p, Nearest& nearest) {
  const auto visit = [&](std::int32_t(&triangle)[kWide], int count) __attribute__((always_inline)) {
    tryTriangles(job.triangles, triangle, count, p, nearest);
    return nearest.limit;
  };
  descend(job.nodes, p, 0, nearest.limit, visit);
}

} // namespace patina::PATINA_KERNEL

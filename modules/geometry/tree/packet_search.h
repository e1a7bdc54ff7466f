// Part of the packet kernel (see triangle_packet_kernel.h): descents of the tree.
#pragma once

#include "geometry/tree/packet_triangles.h"

namespace patina::PATINA_KERNEL {

constexpr int kDepth = 90;  // of the tree, bounded by its builder
constexpr int kStack = 640; // 7 more a level

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

// A node on the way down: the distances of its children that wait, infinite for those that went.
struct Waiting {
  alignas(32) float d2[kWide];
  std::int32_t node;
};

// One point from the root. `visit` gets a triangle and `visitBlock` those of a node from `inner`
// on; both tighten the limit, which they return. Nearest children first, but they are not sorted:
// by when the second's turn comes, few are near enough. The limit is at most kFarthest.
template <typename Visit, typename VisitBlock>
PATINA_INLINE void descend(const WideNode* nodes, std::int32_t inner, const Points& p, float limit,
                           const Visit& visit, const VisitBlock& visitBlock) {
  Waiting stack[kDepth];
  int top = 0;
  std::int32_t at = 0;
  for (;;) {
    if (at >= inner) {
      limit = visitBlock(at - inner);
    } else {
      store(stack[top].d2, childDistances(nodes[at], p));
      stack[top++].node = at;
    }
    for (;;) {
      if (top == 0) return;
      Waiting& waiting = stack[top - 1];
      const Lanes d2 = load(waiting.d2);
      const float nearest = smallest(d2);
      if (!(nearest <= limit)) {
        --top;
        continue;
      }
      const int place = __builtin_ctz(bits(d2 <= spread(nearest)));
      waiting.d2[place] = __builtin_inff();
      at = nodes[waiting.node].child[place];
      if (at >= 0) break;
      limit = visit(~at);
    }
  }
}

inline void searchPoint(const LatticeJob& job, const Points& p, Nearest& nearest) {
  const auto visit = [&](std::int32_t triangle) __attribute__((always_inline)) {
    tryTriangle(job.triangles, triangle, p, nearest);
    return nearest.limit;
  };
  const auto visitBlock = [&](std::int32_t at) __attribute__((always_inline)) {
    const WideNode& node = job.nodes[job.inner + at];
    take(job.triangles, squaredDistance(job.blocks[at], p), node.child, nearest);
    return nearest.limit;
  };
  descend(job.nodes, job.inner, p, nearest.limit, visit, visitBlock);
}

} // namespace patina::PATINA_KERNEL

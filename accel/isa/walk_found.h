// Part of walk_list.h: the leaves that each ray of a group meets, found without regard to their order.
//
// A ray that is walked in the order of its way waits for every node: which one comes next is known only when the last
// has been tested and what it led to been sorted, and no processor guesses that. Here rays do not wait, for nodes are
// taken as they come, those of sixteen rays in one queue, and no branch depends on what they meet. That opens nodes
// behind the treelets that will be listed, which costs less than the waiting did, unless a ray meets very many.

#include "accel/isa/walk_lanes.h"

constexpr int most_tube_visits = 48;  // a tube that opens more nodes than this saves nothing
constexpr int most_visits = 1024;     // of a group's rays to nodes, before those that are left go on in order
constexpr int ahead = 8;              // visits by which nodes are fetched early

/// Leaves and where they are entered, by ray of the group.
struct Found {
  static constexpr int room = 32;  ///< a ray that meets more is better walked in order

  alignas(32) float entries[group][room + WideNode::width];
  std::uint32_t leaves[group][room + WideNode::width];
  int count[group] = {};

  bool is_full(int k) const { return count[k] > room; }
};

/// Adds to ray k what it meets of a node.
static inline void add(Found& found, int k, lanes entries, lanes children, unsigned chosen) {
  store_chosen(found.entries[k] + found.count[k], entries, chosen);
  found.count[k] += store_chosen(found.leaves[k] + found.count[k], children, chosen);
}

/// Adds a leaf to those that meet it.
static inline void add(Found& found, unsigned rays, const float* entries, std::uint32_t leaf) {
  for (; rays; rays &= rays - 1) {
    const int k = __builtin_ctz(rays);
    found.entries[k][found.count[k]] = entries[k];
    found.leaves[k][found.count[k]] = leaf;
    found.count[k] += !found.is_full(k);
  }
}

/// The leaves that a tube meets: lanes of nodes.
struct TubeLeaves {
  std::uint32_t nodes[(most_tube_visits + 1) * WideNode::width], lanes[(most_tube_visits + 1) * WideNode::width];
  int count = 0;
};

/// False when the tube opens too many nodes. They are visited first come first served, lest each wait for the last.
static inline bool find_leaves(const WideNode* nodes, const Tube& tube, TubeLeaves& leaves) {
  alignas(32) static constexpr std::uint32_t every_lane[WideNode::width] = {0, 1, 2, 3, 4, 5, 6, 7};
  std::uint32_t visited[most_tube_visits + WideNode::width];
  visited[0] = 0;
  int end = 1;
  for (int at = 0; at != end; ++at) {
    const WideNode& node = nodes[visited[at]];
    lanes enter;
    const unsigned met = meet(node, tube, enter);
    const lanes children = load_words(node.children);
    const unsigned met_leaves = met & sign_bits(children);
    store_eight(leaves.nodes + leaves.count, visited[at]);
    leaves.count += store_chosen(leaves.lanes + leaves.count, load_words(every_lane), met_leaves);
    end += store_chosen(visited + end, children, met ^ met_leaves);
    if (end > most_tube_visits) return false;
  }
  return true;
}

/// What the rays of a tube meet; false when it opens too many nodes.
static inline bool find_together(const WideNode* nodes, const LocalRays& rays, const Tube& tube, Found& found) {
  TubeLeaves leaves;
  if (!find_leaves(nodes, tube, leaves)) return false;
  for (int i = 0; i < leaves.count; ++i) {
    const WideNode& node = nodes[leaves.nodes[i]];
    const std::uint32_t lane = leaves.lanes[i];
    alignas(32) float entries[group];
    const unsigned by = meet_box(node, lane, rays, tube, entries);
    add(found, by, entries, node.children[lane]);
  }
  return true;
}

/// Has a node brought near before it is visited.
static inline void fetch(const WideNode& node) {
  for (std::size_t at = 0; at < sizeof node; at += 64) __builtin_prefetch(reinterpret_cast<const char*>(&node) + at);
}

/// What the chosen rays meet behind their cursors, each for itself; answers those that are left undone.
static inline unsigned find_apart(const WideNode* nodes, const LocalRays& rays, unsigned chosen, const float* after,
                                  Found& found) {
  std::uint32_t visited[most_visits + WideNode::width], by[most_visits + WideNode::width];
  int end = 0;
  for (; chosen; chosen &= chosen - 1) visited[end] = 0, by[end++] = static_cast<std::uint32_t>(__builtin_ctz(chosen));
  int at = 0;
  for (; at != end && end <= most_visits; ++at) {
    const int k = static_cast<int>(by[at]);
    fetch(nodes[visited[at + ahead < end ? at + ahead : at]]);
    if (found.is_full(k)) continue;
    const WideNode& node = nodes[visited[at]];
    lanes enter;
    const unsigned met = meet(node, LocalRay(rays, k), all(after[k]), enter);
    const lanes children = load_words(node.children);
    const unsigned leaves = met & sign_bits(children);
    add(found, k, enter, children, leaves);
    store_eight(by + end, by[at]);
    end += store_chosen(visited + end, children, met ^ leaves);
  }
  unsigned undone = 0;
  for (; at != end; ++at) undone |= 1u << by[at];
  return undone;
}

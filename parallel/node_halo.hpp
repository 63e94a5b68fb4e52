// Exchange of contributions to the nodes that bricks of several ranks share: one message to each neighbouring
// rank; its buffer and length are fixed when the set of bricks changes.
//
// For every brick of ours and every neighbouring rank, the nodes that it shares with any brick of that rank
// are sent, field by field; the receiver derives the same list from its ghosts. Bricks are ordered by key,
// the nodes of each by index.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/communication/brick_directory.hpp"
#include "core/communication/node_halo.hpp"
#include "core/grid/brick_grid.hpp"
#include "parallel/mpi.hpp"

namespace mpm::parallel {

/// Nodes of several bricks in the order of a message.
struct NodeList {
  struct Piece {
    core::Slot slot = core::no_slot;
    int field = 0;
    std::uint32_t begin = 0, end = 0;  ///< in `nodes`
  };
  std::vector<Piece> pieces;
  std::vector<std::uint16_t> nodes;  ///< index in the brick's node block

  std::size_t size() const { return nodes.size(); }
};

/// Nodes sent to and received from one neighbouring rank.
struct HaloPartner {
  int rank = 0;
  NodeList send;     ///< from owned slots
  NodeList receive;  ///< into ghost slots
};

/// Partners by rank. Two ranks that are each other's partners have the same lists.
std::vector<HaloPartner> halo_partners(const core::BrickGrid& grid, const core::BrickDirectory& directory);

class MpiHalo final : public core::NodeHalo {
 public:
  MpiHalo(const Communicator& comm, const core::BrickDirectory& directory)
      : comm_(comm), directory_(directory) {}

  /// The ranks with bricks next to ours, in ascending order. No communication.
  const std::vector<HaloPartner>& partners(const core::BrickGrid& grid) {
    update(grid);
    return partners_;
  }
  void begin(core::BrickGrid& grid, core::NodeFields fields) override;
  void end(core::BrickGrid& grid) override;
  void exchange_components(const core::BrickGrid& grid,
                           std::vector<std::vector<std::int32_t>>& of_slot) override;
  void exchange_points(const core::BrickGrid& grid, std::vector<std::vector<double>>& of_slot) override;

 private:
  void update(const core::BrickGrid& grid);
  template <class T>
  void exchange_lists(const core::BrickGrid& grid, std::vector<std::vector<T>>& of_slot, int tag);
  PersistentRequests& receives(int count) { return receives_[static_cast<std::size_t>(count)]; }
  PersistentRequests& sends(int count) { return sends_[static_cast<std::size_t>(count)]; }
  void set_up_requests(int count);

  const Communicator& comm_;
  const core::BrickDirectory& directory_;
  const core::BrickGrid* planned_grid_ = nullptr;  ///< for which, and for which state of it, the partners are
  std::uint64_t planned_revision_ = 0;
  bool ghosts_are_clear_ = false;

  std::vector<HaloPartner> partners_;
  std::vector<std::vector<double>> outgoing_, incoming_;  ///< [partner][node x count]
  std::array<PersistentRequests, core::node_doubles + 1> sends_,
      receives_;  ///< [count], one for each partner

  std::optional<core::NodeFields> under_way_;
};

}  // namespace mpm::parallel

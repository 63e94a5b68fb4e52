// Main memory that a run needs, and that is available.
#pragma once

#include "core/model.hpp"

namespace mpm::core {

/// Bytes that one rank uses from the start of the steps on, in addition to the program itself with its
/// libraries (about 30 MB).
struct MemoryNeed {
  double particles = 0;  ///< their columns, in blocks of eight of one body, in whole pages
  double bricks = 0;     ///< nodes of owned and ghost bricks, and the bricks themselves
  double bodies = 0;     ///< input, ledger, sums and text rows that grow with the number of bodies
  double total() const { return particles + bricks + bodies; }
};

/// Current memory of the model's particles, bricks and bodies on this rank.
MemoryNeed memory_need(const Model& model);

/// Bytes of main memory free on this machine for all its ranks: of the system, or of the rank's control group
/// (container, batch job), whichever is less.
double available_memory();
/// Bytes that this process may still allocate (ulimit -v); infinite without a limit.
double address_space_left();

}  // namespace mpm::core

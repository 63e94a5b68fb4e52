// What a run needs of main memory, and what there is of it.
#pragma once

#include "core/model.hpp"

namespace mpm::core {

/// Bytes that one rank holds from the start of the steps on, beside the program itself with its libraries
/// (about 30 MB).
struct MemoryNeed {
  double particles = 0;  ///< their columns, in blocks of eight of one body, in whole pages
  double bricks = 0;     ///< nodes of owned and ghost bricks, and the bricks themselves
  double bodies = 0;     ///< input, ledger, sums and rows of text that grow with the number of bodies
  double total() const { return particles + bricks + bodies; }
};

/// What the model's particles, bricks and bodies take as they are now on this rank.
MemoryNeed memory_need(const Model& model);

/// Bytes of main memory that this machine has free for all ranks on it: of the system, or of the control
/// group (container, batch job) that the rank runs in, whichever is less.
double available_memory();
/// Bytes that this process may still take (ulimit -v); infinite without a limit.
double address_space_left();

}  // namespace mpm::core

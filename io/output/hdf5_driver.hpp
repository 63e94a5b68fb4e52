// The driver through which HDF5 reaches files that one rank handles alone.
//
// HDF5 does not survive a write that fails: it keeps what it could not write, cannot close the file, and
// crashes when it is shut down. This driver takes every write, remembers the first failure, and writes
// nothing from then on: HDF5 closes the file in peace, and the file keeps the order of what was written
// before.
#pragma once

#include <string>

#include <hdf5.h>

namespace mpm::io::hdf5 {

/// For H5Pset_driver. Registered once per process; below zero if HDF5 refuses.
hid_t driver();

/// The first failure of the file that was opened last, in the system's words and with its path; empty if
/// there was none. It outlives the file, since closing writes too.
std::string& failure();

}  // namespace mpm::io::hdf5

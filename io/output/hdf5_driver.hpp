// The virtual file driver of HDF5.
// HDF5 cannot recover from a failed write: it keeps the unwritten data, cannot close the file, and crashes at
// shutdown. This driver accepts every write, records the first failure of the file, and discards all later
// writes: HDF5 closes the file normally, and earlier data remains. HDF5 does not detect that a file is opened
// twice with this driver; this program never does that.
#pragma once

#include <memory>
#include <string>

#include <hdf5.h>

namespace mpm::io::hdf5 {

/// The first failure of one file, with its path and the system's message; empty if none. It outlives the
/// file, since closing also writes.
using Failure = std::shared_ptr<std::string>;

/// Files opened with this access list use the driver and report to `failure`, which must not move until the
/// file is open.
void use_driver(hid_t access_list, Failure& failure);

}  // namespace mpm::io::hdf5

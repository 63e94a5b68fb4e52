// The driver through which HDF5 reaches files.
//
// HDF5 does not survive a write that fails: it keeps what it could not write, cannot close the file, and
// crashes when it is shut down. This driver takes every write, remembers the first failure of the file, and
// writes nothing to it from then on: HDF5 closes the file in peace, and what was written before stays.
//
// HDF5 does not notice when a file is opened twice with this driver; nobody here does.
#pragma once

#include <memory>
#include <string>

#include <hdf5.h>

namespace mpm::io::hdf5 {

/// The first failure of one file, with its path and in the system's words; empty while there is none. It
/// outlives the file, since closing writes too.
using Failure = std::shared_ptr<std::string>;

/// Files opened with this access list are reached through the driver and tell `failure`, which must stay
/// where it is until the file is open.
void use_driver(hid_t access_list, Failure& failure);

}  // namespace mpm::io::hdf5

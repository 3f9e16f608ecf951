// SPDX-License-Identifier: BSD-3-Clause
// Check of a netCDF file's header before a library opens the file: whether the file is complete.
//
// The netCDF library reads zeros beyond the end of a classic file, and allocates the memory that a header
// claims. Checks made here:
// - Classic files (CDF-1, CDF-2, CDF-5): the header is parsed, every count is bounded by the remaining bytes
//   of the file, and the end of each variable is compared with the file's size (NetCDF Classic Format
//   Specification, Unidata). The stored vsize is not used: it saturates at 4 GiB. The padding of the last
//   variable may be missing; a single record variable has none.
// - netCDF-4 files (HDF5): the end of file stated in the superblock is compared with the file's size (HDF5
//   File Format Specification 3.0, section II.A).
//
// Calls may overlap between threads.
#pragma once

#include <string>

namespace halocline::ocean {

enum class NetcdfKind { kNone, kClassic, kHdf5 };

// Returns the kind by the file's first bytes. Throws InvalidArgument when `path` is not a readable regular
// file.
NetcdfKind netcdf_kind_of(const std::string& path);

// Throws InvalidArgument "<path>: ..." in three cases: the file is of neither kind (the message names its
// format where the first bytes reveal it); it is truncated (the message names the variable and the sizes);
// its header contradicts itself or the file's size.
void require_whole_netcdf(const std::string& path);

}  // namespace halocline::ocean

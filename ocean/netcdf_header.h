// SPDX-License-Identifier: BSD-3-Clause
// A look at the header of a netCDF file before a library opens it: whether the file is whole.
//
// The netCDF library reads zeros beyond the end of a classic file, and asks for the memory that a header
// claims. Here
//   classic files (CDF-1, CDF-2, CDF-5): the header is parsed, every count bounded by what is left of the
//   file, and the end of
//     each variable compared with the file's size (NetCDF Classic Format Specification, Unidata). The stored
//     vsize is not used: it saturates at 4 GiB. The padding of the last variable may be missing; a single
//     record variable has none.
//   netCDF-4 (HDF5): the end of file that its superblock states (HDF5 File Format Specification 3.0, section
//   II.A).
//
// Calls may overlap between threads.
#pragma once

#include <string>

namespace halocline::ocean {

enum class NetcdfKind { kNone, kClassic, kHdf5 };

// By the file's first bytes. Throws InvalidArgument where `path` is no readable regular file.
NetcdfKind netcdf_kind_of(const std::string& path);

// Throws InvalidArgument "<path>: ..." for a file that is neither kind, naming what it is instead where its
// first bytes tell; for one that was cut short, with the variable and the sizes; for a header that
// contradicts itself or the file's size.
void require_whole_netcdf(const std::string& path);

}  // namespace halocline::ocean

// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/rasters/gdal_access.h"

#include <array>
#include <mutex>
#include <string_view>
#include <vector>

#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogr_srs_api.h>

#include "bathymetry/rasters/raster_options.h"
#include "core/check.h"
#include "core/files/input_file.h"
#include "ocean/netcdf_header.h"

namespace halocline::bathymetry::gdal {
namespace {

constexpr std::string_view kInMemory = "/vsimem/";  // files that the process itself created

struct Format {
  const char* name;
  void (*enter)();
};
constexpr std::array kFormats{
    Format{"GTiff", GDALRegister_GTiff},     Format{"netCDF", GDALRegister_netCDF},
    Format{"AAIGrid", GDALRegister_AAIGrid}, Format{"GRASSASCIIGrid", GDALRegister_GRASSASCIIGrid},
    Format{"XYZ", GDALRegister_XYZ},         Format{"BAG", GDALRegister_BAG},
    Format{"HDF5", GDALRegister_HDF5},       Format{"HDF5Image", GDALRegister_HDF5Image},
    Format{"GSAG", GDALRegister_GSAG},       Format{"GSBG", GDALRegister_GSBG},
    Format{"GS7BG", GDALRegister_GS7BG},     Format{"ENVI", GDALRegister_ENVI},
    Format{"EHdr", GDALRegister_EHdr},       Format{"HFA", GDALRegister_HFA},
    Format{"SRTMHGT", GDALRegister_SRTMHGT}, Format{"USGSDEM", GDALRegister_USGSDEM},
    Format{"DTED", GDALRegister_DTED},       Format{"SAGA", GDALRegister_SAGA},
    Format{"GRIB", GDALRegister_GRIB}};

// File system that refuses every file; replaces a virtual one.
class RefusingHandler final : public VSIFilesystemHandler {
 public:
  VSIVirtualHandle* Open(const char* name, const char*, bool, CSLConstList) override {
    CPLError(CE_Failure, CPLE_OpenFailed, "%s: virtual files are not allowed here", name);
    return nullptr;
  }
  int Stat(const char*, VSIStatBufL*, int) override { return -1; }
};

void close_virtual_files() {
  // GDAL forgets handlers that are replaced while they may still be in use: kept for the life of the process.
  static auto& replaced = *new std::vector<VSIFilesystemHandler*>;
  char** prefixes = VSIFileManager::GetPrefixes();
  for (int i = 0; prefixes != nullptr && prefixes[i] != nullptr; ++i) {
    const std::string_view prefix = prefixes[i];
    if (!prefix.starts_with("/vsi") || prefix == kInMemory) continue;
    replaced.push_back(VSIFileManager::GetHandler(prefixes[i]));
    VSIFileManager::InstallHandler(prefixes[i], new RefusingHandler);  // owned by GDAL from now on
  }
  CSLDestroy(prefixes);
}

}  // namespace

void prepare_access() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (is_any_raster_allowed()) return GDALAllRegister();
    for (const Format& format : kFormats) format.enter();
    close_virtual_files();
    OSRSetPROJEnableNetwork(0);
  });
}

const char* const* allowed_drivers() {
  static const auto names = [] {
    std::array<const char*, kFormats.size() + 1> list{};
    for (std::size_t i = 0; i < kFormats.size(); ++i) list[i] = kFormats[i].name;
    return list;
  }();
  return is_any_raster_allowed() ? nullptr : names.data();
}

void require_allowed(const std::string& path) {
  if (is_any_raster_allowed() || path.starts_with(kInMemory)) return;
  require_input_file(path);
  if (ocean::netcdf_kind_of(path) != ocean::NetcdfKind::kNone) ocean::require_whole_netcdf(path);
}

}  // namespace halocline::bathymetry::gdal

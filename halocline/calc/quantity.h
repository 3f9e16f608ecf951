// SPDX-License-Identifier: BSD-3-Clause
// Quantities that `halocline calc` can compute: their descriptions, formulas and columns.
//
// A quantity has one form for each formula (`--model`), at least one. A form names the columns that it reads,
// with units and allowed ranges, its optional columns, and the columns that it writes. Column names are those
// of the reference tables and contain their units (kHz, degC, dB re 1 uPa ...), which are converted to SI
// here.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace halocline::clients {

// Options of the command line.
struct CalcOptions {
  std::string quantity = "";
  // Name of a form, or of a file; empty: the first form whose columns exist, otherwise the first.
  std::string model = "";
  std::string profile = "";  // built-in name or file, for delays and links; empty: global-mean
  double latitude_deg = 45;  // -90..90; for gridded files and models of pressure
  double longitude_deg = 0;  // for gridded files and models of pressure
  bool list = false;         // describe the quantities and read nothing
};

// Column that a form reads.
struct InputColumn {
  std::vector<std::string> names;   // first the name, then accepted synonyms; none: unread
  double lowest, highest;           // allowed range
  std::optional<double> otherwise;  // default of a missing column; empty: the column is required
};

// Maps values of the input columns, in their order, to values of the output columns. May throw
// InvalidArgument.
using RowFunction = std::function<std::vector<double>(const std::vector<double>&)>;

struct QuantityForm {
  std::string model;
  std::vector<InputColumn> inputs;
  std::vector<std::string> outputs;
  // Called once per run; may read a profile and throw InvalidArgument.
  std::function<RowFunction(const CalcOptions&)> prepare;
};

struct Quantity {
  std::string name;
  std::string summary;
  std::vector<QuantityForm> forms;  // at least one; the first is the default
  // Makes a form from the path of a model file (.toml); null when models are formulas only.
  std::function<QuantityForm(const std::string& path)> form_of_file = nullptr;
};

// Returns all quantities in the order in which they are listed.
const std::vector<Quantity>& all_quantities();

// Return the groups of quantities; each is defined in its own file.
std::vector<Quantity> water_quantities();
std::vector<Quantity> boundary_quantities();
std::vector<Quantity> link_quantities();
std::vector<Quantity> delay_quantities();
std::vector<Quantity> packet_quantities();

}  // namespace halocline::clients

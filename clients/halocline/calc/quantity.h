// SPDX-License-Identifier: BSD-3-Clause
// What `halocline calc` can compute: a description of every quantity, its formulas and its columns.
//
// A quantity has one or more forms, one a formula (`--model`). A form names the columns it reads, with unit
// and allowed range, those it may do without, and the columns it writes; names are those of the reference
// tables, units in them (kHz, degC, dB re 1 uPa ...): this is the edge where they turn into SI.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace halocline::clients {

// Options of the command line.
struct CalcOptions {
  std::string quantity = "";
  std::string model =
      "";  // of the quantity's forms, or a file; empty: its first, or the one whose columns are there
  std::string profile = "";  // built-in name or file, for delays and links; empty: global-mean
  double latitude_deg = 45;  // of the place, for files on a grid and models of pressure, -90..90
  double longitude_deg = 0;  // likewise
  bool list = false;         // describe the quantities and read nothing
};

// A column that is read.
struct InputColumn {
  std::vector<std::string> names;   // the first is its name, others are understood; none: unread
  double lowest, highest;           // allowed
  std::optional<double> otherwise;  // value where the column is missing; empty: the column is needed
};

// Values of the input columns in their order, to values of the output columns. May throw InvalidArgument.
using RowFunction = std::function<std::vector<double>(const std::vector<double>&)>;

struct QuantityForm {
  std::string model;
  std::vector<InputColumn> inputs;
  std::vector<std::string> outputs;
  // Made once a run; may read a profile and throw InvalidArgument.
  std::function<RowFunction(const CalcOptions&)> prepare;
};

struct Quantity {
  std::string name;
  std::string summary;
  std::vector<QuantityForm> forms;  // at least one; the first is the default
  // Makes a form of a model that is the path of a file (.toml); empty where models are formulas.
  std::function<QuantityForm(const std::string& path)> form_of_file = nullptr;
};

// Every quantity, in the order of the list.
const std::vector<Quantity>& all_quantities();

// The parts of it, one a file.
std::vector<Quantity> water_quantities();
std::vector<Quantity> boundary_quantities();
std::vector<Quantity> link_quantities();
std::vector<Quantity> delay_quantities();
std::vector<Quantity> packet_quantities();

}  // namespace halocline::clients

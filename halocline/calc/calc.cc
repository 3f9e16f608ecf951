// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/calc/calc.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <optional>
#include <ostream>

#include "acoustics/sea/published_range.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "halocline/calc/published.h"

namespace halocline::clients {
namespace {

// Index of the table's column for each input of a form; empty for a missing column.
using ColumnMap = std::vector<std::optional<std::size_t>>;

std::optional<std::size_t> find_column(const CsvTable& table, const InputColumn& input) {
  for (const std::string& name : input.names) {
    if (const auto column = table.column(name)) return column;
  }
  return std::nullopt;
}

ColumnMap map_columns(const CsvTable& table, const QuantityForm& form) {
  ColumnMap map;
  for (const InputColumn& input : form.inputs) map.push_back(find_column(table, input));
  return map;
}

bool has_needed_columns(const CsvTable& table, const QuantityForm& form) {
  return std::all_of(form.inputs.begin(), form.inputs.end(), [&](const InputColumn& input) {
    return input.otherwise.has_value() || find_column(table, input).has_value();
  });
}

const Quantity* find_quantity(const std::string& name) {
  const auto& all = all_quantities();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Quantity& q) { return q.name == name; });
  return found == all.end() ? nullptr : &*found;
}

const QuantityForm* find_form(const Quantity& quantity, const std::string& model) {
  for (const QuantityForm& form : quantity.forms) {
    if (form.model == model) return &form;
  }
  return nullptr;
}

// Selects the form when no model is given: the first one whose columns exist, so that a table with T68 is
// computed by the formula for T68.
const QuantityForm& form_for_table(const Quantity& quantity, const CsvTable& table) {
  for (const QuantityForm& form : quantity.forms) {
    if (has_needed_columns(table, form)) return form;
  }
  return quantity.forms.front();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string allowed(const InputColumn& input) {
  return format_number(input.lowest) + " to " + format_number(input.highest);
}

void check_needed_columns(const CsvTable& table, const QuantityForm& form, std::vector<std::string>& errors) {
  for (const InputColumn& input : form.inputs) {
    if (input.otherwise || find_column(table, input)) continue;
    errors.push_back("line " + std::to_string(table.header.number) + ": no column " + input.names.front() +
                     " (model " + form.model + "; allowed are numbers from " + allowed(input) + ")");
  }
}

// Reads the inputs of one row; appends a line to `errors` for each bad cell.
std::vector<double> read_row(const CsvTable& table, const CsvLine& row, const QuantityForm& form,
                             const ColumnMap& map, std::vector<std::string>& errors) {
  std::vector<double> values;
  for (std::size_t i = 0; i < form.inputs.size(); ++i) {
    const InputColumn& input = form.inputs[i];
    if (!map[i]) {
      values.push_back(*input.otherwise);
      continue;
    }
    const std::string& cell = row.cells[*map[i]];
    const auto value = parse_number(cell);
    values.push_back(value.value_or(std::nan("")));
    if (value && *value >= input.lowest && *value <= input.highest) continue;
    errors.push_back("line " + std::to_string(row.number) + ", column " + table.header.cells[*map[i]] +
                     ": '" + cell + "'; allowed is a number from " + allowed(input));
  }
  return values;
}

// Records the first value outside of the published range of its formula, and the number of such values.
class PublishedCheck {
 public:
  PublishedCheck(const std::string& quantity, const QuantityForm& form) : model_(form.model) {
    for (const InputColumn& input : form.inputs)
      ranges_.push_back(input.names.empty() ? acoustics::PublishedRange{}
                                            : published_range(quantity, form.model, input.names.front()));
  }

  void check(const CsvTable& table, const CsvLine& row, const ColumnMap& map,
             const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!map[i] || ranges_[i].holds(values[i]) || count_++ > 0) continue;
      first_ = "line " + std::to_string(row.number) + ", column " + table.header.cells[*map[i]] + ": " +
               format_number(values[i]) + " lies outside of the range for which " + model_ +
               " was published, " + format_number(ranges_[i].lowest) + " to " +
               format_number(ranges_[i].highest);
    }
  }
  // Returns the note for the user; empty when all values are inside.
  std::string note() const {
    if (count_ == 0) return {};
    return "note: " + first_ +
           (count_ == 1 ? "" : "; there are " + std::to_string(count_) + " values outside of theirs");
  }

 private:
  std::string model_, first_;
  std::vector<acoustics::PublishedRange> ranges_;
  int count_ = 0;
};

std::vector<std::string> output_names(const CsvTable& table, const QuantityForm& form) {
  std::vector<std::string> names;
  for (std::string name : form.outputs) {
    while (table.column(name)) name = "computed_" + name;
    names.push_back(std::move(name));
  }
  return names;
}

std::string result_cells(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += "," + format_number(value);
  return text;
}

// Returns the lines to write; appends lines to `errors` for rows that cannot be computed.
std::vector<std::string> compute(const CsvTable& table, const QuantityForm& form, const RowFunction& function,
                                 PublishedCheck& published, std::vector<std::string>& errors) {
  std::string header = table.header.text;
  for (const std::string& name : output_names(table, form)) header += "," + name;
  std::vector<std::string> lines = {header};
  const ColumnMap map = map_columns(table, form);
  for (const CsvLine& row : table.rows) {
    const std::size_t before = errors.size();
    const std::vector<double> values = read_row(table, row, form, map, errors);
    if (errors.size() > before) continue;
    published.check(table, row, map, values);
    try {
      lines.push_back(row.text + result_cells(function(values)));
    } catch (const InvalidArgument& error) {
      errors.push_back("line " + std::to_string(row.number) + ": " + error.what());
    }
  }
  return lines;
}

int report(const std::vector<std::string>& errors, int code, std::ostream& err) {
  for (const std::string& error : errors) err << error << '\n';
  return code;
}

void describe(const Quantity& quantity, std::ostream& out) {
  out << quantity.name << ": " << quantity.summary << '\n';
  for (const QuantityForm& form : quantity.forms) {
    std::vector<std::string> needed, optional;
    for (const InputColumn& input : form.inputs) {
      if (input.names.empty()) continue;
      const std::string& name = input.names.front();
      if (!input.otherwise) {
        needed.push_back(name);
      } else {
        optional.push_back(
            name + " (" + (std::isnan(*input.otherwise) ? "derived" : format_number(*input.otherwise)) + ")");
      }
    }
    out << "  --model " << form.model << '\n' << "    needs " << joined(needed) << '\n';
    if (!optional.empty()) out << "    may have " << joined(optional) << '\n';
    out << "    gives " << joined(form.outputs) << '\n';
  }
}

int list_quantities(const Quantity* only, std::ostream& out) {
  for (const Quantity& quantity : all_quantities()) {
    if (only == nullptr || only == &quantity) describe(quantity, out);
  }
  return kCalcDone;
}

}  // namespace

const std::vector<Quantity>& all_quantities() {
  static const std::vector<Quantity> all = [] {
    std::vector<Quantity> list = water_quantities();
    for (const auto& part :
         {boundary_quantities(), link_quantities(), delay_quantities(), packet_quantities()})
      list.insert(list.end(), part.begin(), part.end());
    return list;
  }();
  return all;
}

std::vector<std::string> quantity_names() {
  std::vector<std::string> names;
  for (const Quantity& quantity : all_quantities()) names.push_back(quantity.name);
  return names;
}

std::vector<std::string> model_names(const std::string& quantity) {
  std::vector<std::string> names;
  if (const Quantity* found = find_quantity(quantity)) {
    for (const QuantityForm& form : found->forms) names.push_back(form.model);
  }
  return names;
}

int run_calc(const CalcOptions& options, std::istream& in, std::ostream& out, std::ostream& err) {
  const Quantity* quantity = find_quantity(options.quantity);
  if (quantity == nullptr && !(options.list && options.quantity.empty())) {
    return report({"no quantity '" + options.quantity + "'; there are " + joined(quantity_names())},
                  kCalcBadRequest, err);
  }
  if (options.list) return list_quantities(quantity, out);
  const QuantityForm* form = find_form(*quantity, options.model);
  QuantityForm of_file;
  if (quantity->form_of_file && options.model.ends_with(".toml")) {
    of_file = quantity->form_of_file(options.model);
    form = &of_file;
  }
  if (form == nullptr && !options.model.empty()) {
    return report({"no model '" + options.model + "' of " + quantity->name + "; there are " +
                   joined(model_names(quantity->name))},
                  kCalcBadRequest, err);
  }
  std::vector<std::string> errors;
  const CsvTable table = read_csv(in, errors);
  if (form == nullptr) form = &form_for_table(*quantity, table);
  check_needed_columns(table, *form, errors);
  const bool columns_missing = !has_needed_columns(table, *form);
  if (columns_missing) return report(errors, kCalcBadTable, err);
  RowFunction function;
  try {
    function = form->prepare(options);
  } catch (const InvalidArgument& error) {
    return report({error.what()}, kCalcBadRequest, err);
  }
  PublishedCheck published(quantity->name, *form);
  const std::vector<std::string> lines = compute(table, *form, function, published, errors);
  if (!errors.empty()) return report(errors, kCalcBadTable, err);
  if (const std::string note = published.note(); !note.empty()) err << note << '\n';
  for (const std::string& line : lines) out << line << '\n';
  return kCalcDone;
}

}  // namespace halocline::clients

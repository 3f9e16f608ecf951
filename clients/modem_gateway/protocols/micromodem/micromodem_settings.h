// SPDX-License-Identifier: BSD-3-Clause
// Settings of a Micromodem by name. A host may also set names that are unknown here.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "core/archive.h"

namespace halocline::modem_gateway {

class MicromodemSettings {
 public:
  MicromodemSettings();

  void reset() { *this = MicromodemSettings(); }
  void set(std::string_view name, std::string_view value) { values_[std::string(name)] = std::string(value); }
  // Returns "0" for a setting that was never set and has no factory value.
  std::string value(std::string_view name) const;
  // Returns the value as a whole number; 0 when it is not one.
  std::int64_t number(std::string_view name) const;
  bool is_on(std::string_view name) const { return number(name) != 0; }
  const std::map<std::string, std::string, std::less<>>& all() const { return values_; }
  void archive(Archive& a) { a(values_); }

 private:
  std::map<std::string, std::string, std::less<>> values_;
};

}  // namespace halocline::modem_gateway

// SPDX-License-Identifier: BSD-3-Clause
// Pieces of SVG and HTML as text.
//
// Colours are CSS variables and classes (page_style.cc), so that a picture follows the light and the dark
// scheme of the page. A mark of an outcome is a symbol in mark_definitions(), coloured by its class.
#pragma once

#include <string>
#include <string_view>

#include "clients/mission/outcome_classes.h"

namespace halocline::clients {

// For the content of elements and for attributes in double quotes; bytes that XML does not allow become '?'.
std::string escaped_xml(std::string_view text);

// A coordinate or length: one decimal at most, no trailing zero.
std::string px(double value);

// <title> of an element, shown while the pointer rests on it.
std::string hover(std::string_view text);

// A number with its unit in a lighter weight: 12.3 <dB>.
std::string with_unit(std::string_view number, std::string_view unit);

// An invisible <svg> that the marks of the page refer to; once in a page.
std::string mark_definitions();

// The mark of a class of outcomes, `size` wide, centred.
std::string mark(const OutcomeClass& outcome_class, double x, double y, double size);
// The same as an inline element of a text.
std::string inline_mark(const OutcomeClass& outcome_class);

}  // namespace halocline::clients

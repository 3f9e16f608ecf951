// SPDX-License-Identifier: BSD-3-Clause
// Pieces of SVG and HTML as text.
//
// Colours are CSS variables and classes (page_style.cc), so that a picture follows the light or dark scheme
// of the page. The mark of an outcome is a symbol in mark_definitions(), coloured by its class.
#pragma once

#include <string>
#include <string_view>

#include "runs/timeline/outcome_classes.h"

namespace halocline::clients {

// Escapes text for the content of elements and for attributes in double quotes; bytes that XML does not allow
// become '?'.
std::string escaped_xml(std::string_view text);

// Formats a coordinate or length: at most one decimal, no trailing zero.
std::string px(double value);

// Returns the <title> of an element, which is shown while the pointer rests on it.
std::string hover(std::string_view text);

// Formats a number with its unit in a lighter weight: 12.3 <dB>.
std::string with_unit(std::string_view number, std::string_view unit);

// Returns an invisible <svg> with the symbols that marks refer to; needed once in a page.
std::string mark_definitions();

// Returns the mark of a class of outcomes, `size` pixels wide and centred on (x, y).
std::string mark(const OutcomeClass& outcome_class, double x, double y, double size);
// Returns the mark as an inline element of a text.
std::string inline_mark(const OutcomeClass& outcome_class);

}  // namespace halocline::clients

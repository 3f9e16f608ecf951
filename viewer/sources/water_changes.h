// SPDX-License-Identifier: BSD-3-Clause
// Difference between two states of the water as a SET_ENVIRONMENT message.
#pragma once

#include <optional>

#include "bus/messages/messages.h"

namespace halocline::monitor {

// Returns nothing when both agree in everything that SET_ENVIRONMENT sets. The change is valid from its
// reception.
std::optional<environment_change_t> change_between(const environment_t& before, const environment_t& after);

}  // namespace halocline::monitor

// SPDX-License-Identifier: BSD-3-Clause
// Listening socket of a web server: it stays in the network namespace in which it was opened, even when the
// process enters another.
#pragma once

#include "viewer/web/web_rules.h"

namespace halocline::monitor {

// Listens at `access` and stores the actual port there. Throws InvalidArgument when the address is not
// available, or is reachable by others without a token.
int listening_socket(WebAccess& access);

}  // namespace halocline::monitor

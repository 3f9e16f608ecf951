// SPDX-License-Identifier: BSD-3-Clause
// The socket on which a web server listens: it stays in the network in which it was opened, wherever the
// process goes.
#pragma once

#include "clients/monitor/web/web_rules.h"

namespace halocline::monitor {

// Listens as `access` says, and puts the port in there. Throws InvalidArgument when the address cannot be
// had, and for one that others reach without a token.
int listening_socket(WebAccess& access);

}  // namespace halocline::monitor

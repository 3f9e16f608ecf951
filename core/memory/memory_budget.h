// SPDX-License-Identifier: BSD-3-Clause
// Available memory, so that work is refused before it begins rather than killed while it runs.
//
// Linux ends a process that touches more memory than there is, without a message. The caller estimates its
// need. The available memory is the smallest of MemAvailable (/proc/meminfo), the rest of the control group
// (memory.max minus memory.current), and RLIMIT_AS (ulimit -v) minus the mapped memory.
#pragma once

#include <string>

namespace halocline {

// Available memory, bytes; infinite if the system reports none of the three.
double available_memory_bytes();
// Mapped memory of the process's address space, bytes; infinite if the system does not report it.
double mapped_memory_bytes();

// Throws InvalidArgument if `bytes` exceed the available memory: "WHAT needs about 40 GB of memory, and 17 GB
// are available; REMEDY".
void require_memory(double bytes, const std::string& what, const std::string& remedy);

// Returns a size such as "340 GB", with two digits.
std::string size_text(double bytes);

}  // namespace halocline

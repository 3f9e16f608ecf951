// SPDX-License-Identifier: BSD-3-Clause
// Memory that is still to be had, for work that is refused before it begins rather than killed in its midst.
//
// Linux ends a process that touches more memory than there is, without a word. The estimate is the caller's;
// what is there is the least of MemAvailable (/proc/meminfo), of what the control group leaves (memory.max
// less memory.current) and of RLIMIT_AS (ulimit -v) less what is mapped.
#pragma once

#include <string>

namespace halocline {

// Bytes; infinite where the system tells none of them.
double available_memory_bytes();
// Of the process's address space; infinite where the system does not tell.
double mapped_memory_bytes();

// Throws InvalidArgument where `bytes` are more: "WHAT needs about 40 GB of memory, and 17 GB are available;
// REMEDY".
void require_memory(double bytes, const std::string& what, const std::string& remedy);

// "340 GB", two digits.
std::string size_text(double bytes);

}  // namespace halocline

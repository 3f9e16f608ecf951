// SPDX-License-Identifier: BSD-3-Clause
// The report: one static HTML page with everything in it, about one log or about two side by side.
//
// It loads nothing and runs no script. Pictures of axes and curves are by gnuplot; where that is not
// installed the page has the others and names what is missing. Its size is bounded (3 MB for one
// log, whatever it holds): each section states what it leaves out.
#pragma once

#include <string>
#include <vector>

#include "clients/halocline/analysis/comparison.h"
#include "clients/mission/mission_store.h"

namespace halocline::clients {

// One of the logs of a report.
struct ReportPart {
  std::string log;  // its name
  const MissionStore& mission;
  std::vector<std::string> remarks = {};  // sentences: damage, times that were moved
};

std::string report_page(const ReportPart& part);
std::string report_page(const ReportPart& before, const ReportPart& after, const Comparison& comparison);

// The style sheet of the page.
std::string page_style();

}  // namespace halocline::clients

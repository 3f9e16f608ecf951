// SPDX-License-Identifier: BSD-3-Clause
// Report: one self-contained static HTML page about one log, or about two for comparison.
//
// It loads nothing and runs no script. Pictures with axes and curves are drawn by gnuplot; when that is not
// installed, the page names the missing pictures and contains the others. Its size is bounded (3 MB for any
// one log): each section states what it leaves out.
#pragma once

#include <string>
#include <vector>

#include "runs/analysis/comparison.h"
#include "runs/timeline/run_timeline.h"

namespace halocline::clients {

// One of the logs of a report.
struct ReportPart {
  std::string log;  // name of the log
  const RunTimeline& timeline;
  std::vector<std::string> remarks = {};  // sentences: damage, times shifted
};

std::string report_page(const ReportPart& part);
std::string report_page(const ReportPart& before, const ReportPart& after, const Comparison& comparison);

std::string page_style();

}  // namespace halocline::clients

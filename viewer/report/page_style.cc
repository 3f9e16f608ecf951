// SPDX-License-Identifier: BSD-3-Clause
// Style of a report: two sizes of one typeface, tabular figures, lighter units, panels separated by space.
// The colours of the page are variables, so that pictures follow the scheme that the reader's system selects.
#include <string>

#include <fmt/format.h>

#include "runs/timeline/outcome_classes.h"
#include "viewer/report/report_page.h"
#include "viewer/report/vehicle_style.h"

namespace halocline::clients {
namespace {

constexpr const char* kStyle =
    R"css(:root { --paper: #fbfaf6; --ink: #1b2327; --quiet: #5d6a71; --line: #dcd9d0; --accent: #0a6a8c;
  --seabed: #d9d1be; --seabed-edge: #8b7f66; --water: #e6eff0; --hatch: #fbfaf6; --soft: #f0eee7;
    --contour: #14262c; --arrived: .55; --casing: #fff; color-scheme: light dark; }
@media (prefers-color-scheme: dark) { :root { --paper: #0d1316; --ink: #e4e9eb; --quiet: #93a0a7;
  --line: #28333a; --accent: #63c4e3;
  --seabed: #3d382d; --seabed-edge: #9a8d72; --water: #10242b; --hatch: #0d1316; --soft: #151d21;
    --contour: #14262c; --arrived: .8; --casing: #0b1a20; --c-no_path: #4d9fd0; }
  svg image { filter: brightness(.86); } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 1rem/1.5 system-ui, sans-serif;
  font-variant-numeric: tabular-nums;
  -webkit-text-size-adjust: 100%; }
main { max-width: 1180px; margin: 0 auto; padding: 2rem 1.5rem 4rem; display: grid;
  grid-template-columns: 656px minmax(0, 1fr); gap: 2.2rem 2.2rem; }
main > * { grid-column: 1 / -1; min-width: 0; }
main:not(.two) { grid-template-rows: auto auto auto 1fr; }
main:not(.two) > #chart { grid-column: 1; grid-row: 2 / span 3; }
main:not(.two) > .narrow { grid-column: 2; }
main.two { max-width: 1480px; display: block; }
main.two > section { margin-top: 2.2rem; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 2rem; }
.pair > div { min-width: 0; }
h1, h2 { font-size: 1rem; font-weight: 650; margin: 0 0 .4rem; }
header h2 { margin-top: 1.4rem; }
p { margin: 0 0 .5rem; }
.lead { margin-bottom: .2rem; }
.quiet, .legend, .remark, table, pre, code, svg text, details { font-size: .8125rem; }
.quiet, .unit { color: var(--quiet); }
.unit { font-weight: 300; }
.quiet { max-width: 46rem; }
.remark { border-left: 3px solid var(--accent); padding-left: .6rem; }
table { border-collapse: collapse; }
th, td { text-align: left; vertical-align: baseline; padding: .18rem .9rem .18rem 0; font-weight: 400; }
th { color: var(--quiet); }
.number { text-align: right; }
.summary { margin-top: .8rem; font-size: 1rem; }
.summary th { color: var(--ink); font-weight: 650; white-space: nowrap; }
.wide { overflow-x: auto; }
svg { display: block; max-width: 100%; height: auto; font-variant-numeric: tabular-nums; }
#depth .wide > svg, #packets .wide > svg { min-width: 760px; }
.sample { display: inline-block; width: 22px; height: 10px; vertical-align: -.02em; margin-right: .35rem; }
.sample .vehicle { stroke: none; }
.sample .track, .sample .seabed-edge { stroke-width: 2.6; }
.seabed { fill: var(--seabed); }
.seabed-edge { fill: none; stroke: var(--seabed-edge); }
.commanded { fill: none; stroke: var(--ink); stroke-width: 1.2; stroke-dasharray: 5 4; }
.predicted { fill: none; stroke: var(--accent); stroke-width: 2; stroke-dasharray: 6 4; }
a { color: inherit; text-decoration-color: var(--line); text-underline-offset: .2em; }
svg a { cursor: pointer; }
tr:target { background: var(--soft); box-shadow: inset 3px 0 var(--accent); }
g:target .arrived, g:target .point, g:target .refused { stroke: var(--accent); stroke-width: 3; }
tr:target, g:target { scroll-margin-top: 40vh; }
.mark { display: inline-block; width: .8em; height: .8em; vertical-align: -.05em; }
.legend span { margin-right: 1rem; white-space: nowrap; }
.legend { margin: .5rem 0 .3rem; }
.matrix th, .matrix td { text-align: center; padding: .35rem .4rem; white-space: nowrap; }
.matrix tr > th:first-child { text-align: left; padding-left: 0; }
.matrix .cell { background: color-mix(in srgb, #009e73 calc(var(--share) * 46%), var(--soft));
  border: 2px solid var(--paper); min-width: 4rem; }
.matrix b { display: block; font-size: 1rem; font-weight: 650; }
.matrix small { display: block; font-size: .8125rem; line-height: 1.3; white-space: nowrap; }
.ledger .share { width: 100%; padding-right: 0; vertical-align: middle; }
.ledger { width: 100%; }
.ledger td { white-space: nowrap; }
.ledger .sum td { border-top: 1px solid var(--line); }
.share i { display: block; height: .7em; background: currentColor; min-width: 2px; }

.losses td, .losses th { white-space: nowrap; }
.losses td:last-child { white-space: normal; min-width: 24rem; }
details > summary { cursor: pointer; font-size: 1rem; }
details > summary h2 { display: inline; }
pre { background: var(--soft); padding: 1rem; overflow-x: auto; line-height: 1.4; }
svg text { font-family: inherit; stroke: none; }
.tick { fill: var(--quiet); }
g[fill="var(--contour)"] text { paint-order: stroke; stroke: #fff; stroke-opacity: .45; stroke-width: 2.5px; }
svg text.lane { fill: var(--ink); font-weight: 650; }
.grid { stroke: var(--line); stroke-width: .7; }
.lane-line { stroke: var(--line); stroke-width: 1; }
.point { fill: transparent; }
.sent { fill: currentColor; }
.swatch { fill: none; stroke: currentColor; stroke-width: 4; }
.arrived { fill: currentColor; fill-opacity: var(--arrived); }
.flight { stroke: currentColor; stroke-width: 1; opacity: .45; fill: none; }
.faint { stroke: currentColor; stroke-width: 1.4; opacity: .55; }
.refused { fill: none; stroke: var(--quiet); stroke-width: 1.2; }
.hatch { stroke: var(--hatch); stroke-width: 2.4; }
.measured { fill: var(--paper); stroke: var(--ink); stroke-width: 2; }
.fault path { stroke: #d55e00; stroke-width: 1.2; stroke-dasharray: 2 2; }
svg .fault text { fill: #d55e00; }
.empty-map { fill: var(--water); }
.casing { fill: none; stroke: var(--casing); stroke-opacity: .85; stroke-width: 5; stroke-linejoin: round; }
.track { fill: none; stroke: currentColor; stroke-width: 2.6; stroke-linejoin: round; }
.start { fill: var(--casing); stroke: currentColor; stroke-width: 2; }
.time { fill: var(--casing); stroke: currentColor; stroke-width: 1.2; }
.vehicle { fill: currentColor; stroke: var(--casing); stroke-width: 1.4; stroke-linejoin: round; }
.link { stroke: #fff; stroke-opacity: .5; stroke-dasharray: 1 5; stroke-linecap: round; }
.plan { fill: none; stroke: currentColor; stroke-width: 1.4; stroke-dasharray: 5 4;
  filter: drop-shadow(0 0 1px var(--casing)) drop-shadow(0 0 1px var(--casing)); }
.waypoint { fill: var(--casing); fill-opacity: .6; stroke: currentColor; stroke-width: 1.2; }
.disc { fill: #fff; fill-opacity: .85; }
.loss .c-no_path { filter: drop-shadow(0 0 1.2px #fff) drop-shadow(0 0 .6px #fff); }
.scale { fill: none; stroke: #fff; stroke-width: 1.6; paint-order: stroke;
  filter: drop-shadow(0 0 1.5px #0b1a20); }
svg text.name { fill: #fff; font-weight: 650; paint-order: stroke; stroke: #0b1a20; stroke-width: 2.6px;
  stroke-opacity: .8; stroke-linejoin: round; }
.on-paper .link, .on-paper .scale { stroke: var(--ink); filter: none; }
svg .on-paper text.name { fill: var(--ink); stroke: var(--water); }
@media (max-width: 1100px) { main { grid-template-columns: minmax(0, 1fr); } main:not(.two) > * {
  grid-column: 1 !important; grid-row: auto !important; } main:not(.two) { grid-template-rows: none; } }
@media (max-width: 640px) { main { padding: 1rem .8rem 3rem; } .pair { grid-template-columns: 1fr; }
  #chart .wide > svg { min-width: 440px; }
  .summary, .summary tbody, .summary tr, .summary th, .summary td { display: block; padding: 0; }
    .summary td { margin-bottom: .3rem; } }
@media print { details > *:not(summary) { display: block; } .wide { overflow: visible; } }
)css";

}  // namespace

std::string page_style() {
  std::string style = kStyle + vehicle_style(false) + "@media (prefers-color-scheme: dark) { " +
                      vehicle_style(true) + "}\n" + vehicle_classes();
  for (const OutcomeClass& c : outcome_classes())
    style += fmt::format(".c-{0} {{ color: var(--c-{0}, {1}); }}\n", c.key, c.colour);
  return style;
}

}  // namespace halocline::clients

#include "reports/campaign_page/look.hpp"

namespace fleetproof::html {

Literal style_sheet() {
  return R"css(
:root { color-scheme: light dark; --ink: #1d232b; --soft: #57616d; --paper: #ffffff; --panel: #f5f7f9;
  --line: #d9dee4; --accent: #245f9c; --good: #2d6a4f; --bad: #a83224; --open: #8a6100; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4e8ec; --soft: #a3adb8; --paper: #14181d; --panel: #1c2228; --line: #333c46; --accent: #84b6e8;
    --good: #7cc4a0; --bad: #f09383; --open: #e3ba62; }
  svg.map rect { filter: brightness(0.9); }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; }
/* As wide as the widest table, up to the window. What wraps anyway asks for no width. */
main { width: fit-content; min-width: min(100%, 1220px); max-width: 100%; margin: 0 auto; padding: 0 28px 80px;
  overflow-wrap: break-word; }
h1, h2, h3, nav, details, .headline, .maps, .case { contain: inline-size; }
h1 { font-size: 20px; font-weight: 600; margin: 0 0 20px; color: var(--soft); }
h2 { font-size: 22px; line-height: 1.3; font-weight: 650; margin: 0 0 8px; }
h3 { font-size: 16px; font-weight: 650; margin: 24px 0 8px; }
section { margin-top: 26px; padding-top: 14px; border-top: 1px solid var(--line); }
p { margin: 0 0 12px; max-width: 78ch; }
ul { margin: 0 0 12px; padding-left: 20px; }
li { margin: 0 0 6px; max-width: 96ch; }
.headline { background: var(--panel); border-left: 5px solid var(--open); border-radius: 4px; padding: 14px 20px;
  margin: 0 0 14px; }
.headline p { margin: 2px 0 6px; font-size: 18px; }
.headline li { color: var(--soft); font-size: 15px; }
.headline .word { text-transform: uppercase; letter-spacing: 0.05em; font-size: 14px; color: var(--open); }
.demonstrated { border-color: var(--good); } .demonstrated .word { color: var(--good); }
.violated { border-color: var(--bad); } .violated .word { color: var(--bad); }
/* A shadow at an edge says that the table goes on there. */
.scroll { overflow-x: auto; margin: 0 0 16px; background:
  linear-gradient(to right, var(--paper) 30%, transparent) left / 40px 100% no-repeat local,
  linear-gradient(to left, var(--paper) 30%, transparent) right / 40px 100% no-repeat local,
  linear-gradient(to right, var(--line), transparent) left / 14px 100% no-repeat scroll,
  linear-gradient(to left, var(--line), transparent) right / 14px 100% no-repeat scroll; }
table { border-collapse: collapse; font-size: 14px; font-variant-numeric: tabular-nums; }
th, td { padding: 6px 12px; border-bottom: 1px solid var(--line); vertical-align: top; }
th { font-weight: 600; color: var(--soft); white-space: nowrap; border-bottom-width: 2px; }
.scroll td { white-space: nowrap; }
th.sortable { cursor: pointer; } th.sortable:hover, th.sortable:focus { color: var(--accent); }
th[aria-sort=ascending]::after { content: " \25B2"; } th[aria-sort=descending]::after { content: " \25BC"; }
table.facts { width: 0; min-width: 100%; table-layout: fixed; }
table.facts td { overflow-wrap: anywhere; } table.facts th { text-align: left; width: 220px; white-space: normal;
  border-bottom-width: 1px; }
tbody tr:hover { background: var(--panel); }
input.filter { font: inherit; font-size: 14px; padding: 6px 10px; margin: 0 0 10px; width: 280px; max-width: 100%;
  color: inherit; background: var(--paper); border: 1px solid var(--line); border-radius: 4px; }
pre { width: fit-content; max-width: 100%; margin: 4px 0 8px; padding: 5px 12px; background: var(--panel);
  border: 1px solid var(--line); border-radius: 4px; overflow-x: auto;
  font: 13px/1.5 ui-monospace, "DejaVu Sans Mono", Consolas, monospace; }
details { margin: 0 0 12px; } summary { cursor: pointer; font-weight: 600; color: var(--accent); }
pre code { user-select: all; } ul.legend { list-style: none; padding: 0; font-size: 14px; }
@media (max-width: 1320px) { th, td { padding: 6px 8px; } }
@media (max-width: 600px) { main { padding: 0 14px 48px; } h2 { font-size: 19px; } .headline p { font-size: 16px; }
  table.facts th { width: 110px; } pre { white-space: pre-wrap; overflow-wrap: anywhere; } }
@media print { body { font-size: 11pt; } main { width: auto; padding: 0; } input.filter, nav { display: none; }
  .scroll td, th { white-space: normal; padding: 3px 5px; } .scroll { overflow: visible; }
  figure, .headline, tr { break-inside: avoid; } pre { white-space: pre-wrap; } }
)css";
}

// Of the bar of sections, of lists, drawings and cases.
Literal part_styles() {
  return R"css(
svg.chart { max-width: 100%; height: auto; } figure { margin: 0 0 12px; overflow-x: auto; }
figcaption { max-width: 110ch; font-size: 14px; color: var(--soft); margin: 0 0 6px; }
.maps { display: flex; flex-wrap: wrap; gap: 12px 32px; } .maps figure { min-width: 0; max-width: 100%; }
.case { margin: 28px 0 0; } .case h3 { margin: 0 0 4px; }
.film { display: flex; flex-wrap: wrap; gap: 8px 7px; margin: 8px 0 0; } .film svg.frame { flex: none;
  max-width: 46%; height: auto; }
.key, .words { font-size: 14px; color: var(--soft); } .words { max-width: 110ch; margin-top: 14px; }
/* It stays at the top; what a link leads to stops below it. */
nav { position: sticky; top: 0; z-index: 2; overflow-x: auto; background: var(--paper);
  border-bottom: 1px solid var(--line); margin: 0 0 18px; }
nav ul { list-style: none; display: flex; gap: 2px 16px; padding: 9px 0; margin: 0; white-space: nowrap; }
nav li { margin: 0; } [id] { scroll-margin-top: 62px; }
nav a { color: var(--accent); font-size: 14px; text-decoration: none; } nav a:hover { text-decoration: underline; }
.headline .failing p { margin: 8px 0 4px; font-size: 15px; font-weight: 600; }
.headline .failing ul { margin: 0 0 10px; }
.headline .failing li { margin: 0 0 3px; color: var(--ink); }
a { color: var(--accent); }
@media (min-width: 1000px) { nav ul { flex-wrap: wrap; } [id] { scroll-margin-top: 78px; } }
)css";
}

Literal script() {
  return R"js(
'use strict';
addEventListener('beforeprint', () => {
  for (const details of document.querySelectorAll('details:not(.plan)')) details.open = true;
});
// A link to a section unfolds it.
const unfold = () => {
  const section = location.hash ? document.getElementById(location.hash.slice(1)) : null;
  const details = section ? section.querySelector('details') : null;
  if (details) details.open = true;
};
addEventListener('hashchange', unfold);
unfold();
const figure = text => {
  const found = text.replace(/(\d) (?=\d{3}\b)/g, '$1').match(/-?\d+(\.\d+)?(e-?\d+)?/);
  return found ? parseFloat(found[0]) : NaN;
};
const order = (a, b) => {
  const x = figure(a), y = figure(b);
  return isNaN(x) || isNaN(y) ? a.localeCompare(b) : x - y;
};
for (const table of document.querySelectorAll('table.long, table.short')) {
  const body = table.tBodies[0], heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    head.classList.add('sortable');
    head.tabIndex = 0;
    const sort = () => {
      const down = head.getAttribute('aria-sort') === 'ascending';
      heads.forEach(other => other.removeAttribute('aria-sort'));
      head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
      const numbers = head.align === 'right';
      [...body.rows].sort((a, b) => {
        const x = a.cells[column].textContent, y = b.cells[column].textContent;
        return (numbers ? order(x, y) : x.localeCompare(y)) * (down ? -1 : 1);
      }).forEach(row => body.append(row));
    };
    head.addEventListener('click', sort);
    head.addEventListener('keydown', event => { if (event.key === 'Enter') sort(); });
  });
  if (!table.classList.contains('long')) continue;
  const filter = document.createElement('input');
  filter.type = 'search';
  filter.className = 'filter';
  filter.placeholder = 'filter rows';
  filter.setAttribute('aria-label', 'filter rows');
  filter.addEventListener('input', () => {
    const wanted = filter.value.toLowerCase();
    for (const row of body.rows) row.hidden = !row.textContent.toLowerCase().includes(wanted);
  });
  table.parentNode.before(filter);
}
)js";
}

}  // namespace fleetproof::html

// The event log: a click on a line goes to its instant; the line that holds is marked.
const eventLog = document.getElementById('log-lines');
const logLines = eventLog ? [...eventLog.querySelectorAll('.line')] : [];
const usOf = line => Number(line.dataset.us);
// In a list that is closed, only its first line counts.
const isOpen = line => line.tagName === 'SUMMARY' || line.parentElement === eventLog || line.parentElement.open;

let markedLine = null;
const lineAt = t_s => {
  let last = null;
  for (const line of logLines) {
    if (usOf(line) <= t_s * 1e6 + 0.5 && isOpen(line) && (!last || usOf(line) >= usOf(last))) last = line;
  }
  return last;
};
// The list scrolls to the line, the page stays.
const markLine = t_s => {
  const line = player.line || lineAt(t_s);
  if (line === markedLine) return;
  if (markedLine) markedLine.classList.remove('now');
  markedLine = line;
  if (!line) return;
  line.classList.add('now');
  const top = line.getBoundingClientRect().top - eventLog.getBoundingClientRect().top + eventLog.scrollTop;
  if (top < eventLog.scrollTop + 30 || top > eventLog.scrollTop + eventLog.clientHeight - 60)
    eventLog.scrollTop = top - eventLog.clientHeight / 2;
};
const stepLine = by => {
  const open = logLines.filter(isOpen), at = open.indexOf(markedLine) + by;
  if (!(at in open)) return;
  play(false);
  goTo(usOf(open[at]) / 1e6, open[at]);
};
document.addEventListener('click', event => {
  const line = event.target.closest('[data-us]');
  if (!line || !line.closest('#log-lines, .why, .story, .differences')) return;
  play(false);
  goTo(usOf(line) / 1e6, eventLog && eventLog.contains(line) ? line : null);
});

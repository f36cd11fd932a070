// The course of events: a click on a line goes to its instant; the line that holds is marked.
const course = document.getElementById('course');
const courseLines = course ? [...course.querySelectorAll('.line')] : [];
const usOf = line => Number(line.dataset.us);
// In a list that is closed, only its first line counts.
const isOpen = line => line.tagName === 'SUMMARY' || line.parentElement === course || line.parentElement.open;

let markedLine = null;
const lineAt = t_s => {
  let last = null;
  for (const line of courseLines) {
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
  const top = line.getBoundingClientRect().top - course.getBoundingClientRect().top + course.scrollTop;
  if (top < course.scrollTop + 30 || top > course.scrollTop + course.clientHeight - 60)
    course.scrollTop = top - course.clientHeight / 2;
};
const stepLine = by => {
  const open = courseLines.filter(isOpen), at = open.indexOf(markedLine) + by;
  if (!(at in open)) return;
  play(false);
  goTo(usOf(open[at]) / 1e6, open[at]);
};
document.addEventListener('click', event => {
  const line = event.target.closest('[data-us]');
  if (!line || !line.closest('#course, .reason, .story')) return;
  play(false);
  goTo(usOf(line) / 1e6, course && course.contains(line) ? line : null);
});

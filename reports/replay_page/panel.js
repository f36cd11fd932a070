// The words beside the floor: the pair that fails, and the AGV or computer that is selected. Names pass through
// textContent only.
const panel = document.getElementById('selected'), pairBox = document.getElementById('pair');

const element = (tag, text, className) => {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  return made;
};
const tableOf = lines => {
  const table = element('table');
  for (const cells of lines) {
    const row = table.insertRow();
    for (const [text, className] of cells.map(cell => (Array.isArray(cell) ? cell : [cell])))
      row.append(element('td', text, className));
  }
  return table;
};
const place = pose => '(' + pose.x_m.toFixed(2) + ', ' + pose.y_m.toFixed(2) + ') m';
// "A4.2, " at a station.
const stationAt = pose => {
  const here = film.stations.find(s => Math.hypot(s.x_um / 1e6 - pose.x_m, s.y_um / 1e6 - pose.y_m) < 0.005);
  return here ? here.name + ', ' : '';
};
// From -179 to 180 degrees, without a minus before a zero.
const heading = pose => {
  const degrees = Math.round(pose.heading_rad * 180 / Math.PI) % 360;
  return (degrees > 180 ? degrees - 360 : degrees <= -180 ? degrees + 360 : degrees) + 0 + '°';
};

const tellPair = (t_s, all) => {
  const pair = pairAt(t_s), gap = gapAt(all, pair);
  pairBox.replaceChildren();
  pairBox.hidden = !pair && film.involved.length === 1;
  if (!pair) {
    pairBox.append(element('span', film.involved.map(nameOf).join(', ') || 'No pair came too close.', 'soft'));
    return;
  }
  const whose = film.nearest && !film.involved.length ? ', the closest pair of the run' : '';
  pairBox.append(element('span', nameOf(pair[0]) + ' to ' + nameOf(pair[1]) + whose, 'soft'), element('br'));
  if (!gap) return void pairBox.append(element('span', 'not both on the floor', 'soft'));
  const broken = gap.apart_m < kSafety_m - 2e-6;
  pairBox.append(element('b', gap.apart_m === 0 ? 'contact' : gap.apart_m.toFixed(3) + ' m', broken ? 'bad' : ''));
  const meaning = broken ? '  below ' + kSafety_m.toFixed(2) + ' m' : '  clearance';
  pairBox.append(element('span', meaning, broken ? 'bad' : 'soft'));
};

const aboutActivity = (body, t_s) => {
  const row = activityOf(body, t_s);
  if (isComputer(body)) return faultsOf(body, t_s).join(', ') || 'running';
  return row ? word(row[3]) + ' ' + word(row[4]) + ', until ' + seconds(row[2] / 1e3) : 'idle';
};
const aboutBeliefs = (body, t_s, all) => {
  const lines = [];
  for (const [about, list] of beliefsOf[body]) {
    const row = lastUpTo(list, r => r[2], t_s * 1e3 + 1e-6), real = all[about];
    if (!row) continue;
    const away_m = real ? Math.hypot(real.pose.x_m - row[4] / 1e3, real.pose.y_m - row[5] / 1e3) : 0;
    const near_m = real && all[body] ? Math.hypot(real.pose.x_m - all[body].pose.x_m,
                                                  real.pose.y_m - all[body].pose.y_m) : 1e9;
    lines.push([near_m, [nameOf(about), seconds(t_s - row[3] / 1e3) + ' old',
                         [away_m.toFixed(1) + ' m off', away_m > 1 ? 'bad' : 'soft']]]);
  }
  return lines.sort((a, b) => a[0] - b[0]).slice(0, 6).map(line => line[1]);
};
const aboutMessages = (body, t_s) => {
  const list = arrivalsOf[body], lines = [], numbers = new Set();
  for (let i = countUpTo(list, a => a.sent_s, t_s) - 1; i >= 0 && lines.length < 7; --i) {
    const a = list[i], sends = a.sender === body;
    if (sends && a.to === -1 && numbers.has(a.number)) continue;
    numbers.add(a.number);
    const arrived = a.age_s !== null && a.sent_s + a.age_s <= t_s;
    const toAll = sends && a.to === -1;
    const whom = !sends ? 'from ' + nameOf(a.sender) : toAll ? 'to all' : 'to ' + nameOf(a.to);
    const receipt = a.age_s === null ? a.receipt : (a.again ? 'again, ' : '') +
      (arrived ? 'after ' + seconds(a.age_s) : 'under way');
    const end = toAll ? '' : [receipt, a.age_s === null || a.again ? 'bad' : 'soft'];
    lines.push([seconds(a.sent_s), whom, a.kind + contentOf(a.number), end]);
  }
  return lines;
};
// The last five that differ; what happened again has a number.
const aboutEvents = (body, t_s) => {
  const list = happeningsOf[body], found = new Map();
  for (let i = countUpTo(list, r => r[1], t_s * 1e3 + 1e-6) - 1; i >= 0; --i) {
    const [, at_ms, what, details, flags] = list[i], key = what + ' ' + details, known = found.get(key);
    if (known) ++known.times;
    else if (found.size < 5) found.set(key, {at_ms, what, details, flags, times: 1});
  }
  return [...found.values()].map(({at_ms, what, details, flags, times}) => [
    seconds(at_ms / 1e3), [word(what) === 'probe' ? 'agent notes' : word(what), flags === 1 ? 'bad' : ''],
    word(details) + (times > 1 ? ', ' + times + ' times' : '')]);
};

const tellBody = (body, t_s, all, box) => {
  const one = all[body];
  box.append(element('div', nameOf(body), isInvolved(body) ? 'who bad' : 'who'));
  if (isComputer(body)) return tellComputer(body, t_s, box);
  if (!one) return void box.append(element('p', 'is not on the floor', 'soft'));
  const speed = one.piece[kManner] === 1 ? speedAt(one.piece, t_s * 1e6) : 0;
  const lines = [['at', stationAt(one.pose) + place(one.pose) + ', heads ' + heading(one.pose)],
                 ['speed', speed.toFixed(2) + ' m/s']];
  if (film.bodies[body].kind === 'AGV') {
    lines.push(['does', aboutActivity(body, t_s)], ['load', isLoaded(body, t_s) ? 'yes' : 'no']);
    if (stateOf(body, t_s)) lines.push(['its agent says', stateOf(body, t_s)]);
    if (waitOf(body, t_s) !== null) lines.push(['waits for', [nameOf(waitOf(body, t_s)), 'bad']]);
  }
  box.append(tableOf(lines.map(([name, value]) => [[name, 'soft'], value])));
};
const tellDetails = (body, t_s, all, box) => {
  const missing = [['(not on this page at this instant)']];
  for (const [title, lines] of [
         ['believes', isKept('beliefs', body, t_s) ? aboutBeliefs(body, t_s, all) : missing],
         ['messages', isKept('messages', body, t_s) ? aboutMessages(body, t_s) : missing],
         ['events', aboutEvents(body, t_s)]]) {
    if (lines.length) box.append(element('h3', title), tableOf(lines));
  }
};

// On a wide screen, why the run failed stands beside the floor, unless an AGV is selected; else below it.
const whyBox = byId('why'), kWide = matchMedia('(min-width: 1150px)');
const placeWhy = () => {
  const player = byId('player'), home = kWide.matches ? panel.parentElement : player.parentElement;
  const next = kWide.matches ? panel : player.nextElementSibling;
  if (next !== whyBox && whyBox.nextElementSibling !== next) home.insertBefore(whyBox, next);
  whyBox.hidden = selected !== null && kWide.matches;
};

// The selected AGV or computer with all details; without one, those involved in short, or else the computers.
const tell = (t_s, all) => {
  placeWhy();
  tellPair(t_s, all);
  const box = document.createDocumentFragment();
  const bodies = selected === null ? (film.involved.length ? film.involved : kComputers).slice(0, 6) : [selected];
  for (const body of bodies) {
    tellBody(body, t_s, all, box);
    if (bodies.length <= 2) tellDetails(body, t_s, all, box);
  }
  if (selected === null) box.append(element('p', 'Select an AGV: click on it, or press 1 to 9.', 'soft'));
  panel.replaceChildren(box);
};

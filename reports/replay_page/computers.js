// Computers, such as the server of a central fleet: their place in the picture, their rows and their words.
const isComputer = body => film.bodies[body].kind === 'computer';
const kComputers = film.bodies.map((body, i) => i).filter(isComputer);
const kAfloat = kComputers.filter(i => film.bodies[i].x_um === undefined);  // without an antenna at a place
const kSymbol = {wide_px: 20, high_px: 26};

// Without an antenna, a computer stands in a strip along the upper edge, beside the buttons.
const inStrip = body => {
  const apart_px = Math.min(130, Math.max(0, floor.clientWidth - 350) / kAfloat.length);
  return [64 + apart_px * kAfloat.indexOf(body), 20];
};
const computerSpot = body => {
  const {x_um, y_um} = film.bodies[body];
  return x_um === undefined ? inStrip(body) : [toX(x_um / 1e6), toY(y_um / 1e6)];
};
// Where messages to and from a body end on the canvas; null: the body is not there. `all`: bodiesAt().
const spotOf = (all, body) =>
  isComputer(body) ? computerSpot(body) : all[body] && [toX(all[body].pose.x_m), toY(all[body].pose.y_m)];
const computerAt = (x, y) => kComputers.find(body => {
  const [cx, cy] = computerSpot(body);
  return Math.abs(x - cx) <= kSymbol.wide_px / 2 + 3 && Math.abs(y - cy) <= kSymbol.high_px / 2 + 3;
});
const computerBoxes = () => kComputers.map(computerSpot).map(([x, y]) =>
  [x - kSymbol.wide_px / 2, y - kSymbol.high_px / 2, x + kSymbol.wide_px / 2, y + kSymbol.high_px / 2]);

// The faults that have struck a body and are not over: [fault, since when].
const faultsOf = (body, t_s) => {
  const struck = new Map();
  for (const [, at_ms, what, details, flags] of happeningsOf[body]) {
    if (flags !== 1 || at_ms > t_s * 1e3 + 1e-6) continue;
    if (word(what).endsWith(' over')) struck.delete(details);
    else struck.set(details, word(details) || word(what));
  }
  return [...struck.values()];
};

// A case with three slots; red and crossed while a fault is under way.
const drawComputers = (context, t_s, label) => {
  const {wide_px, high_px} = kSymbol;
  for (const body of kComputers) {
    const [x, y] = computerSpot(body), down = faultsOf(body, t_s).length > 0, hot = isInvolved(body);
    const left = x - wide_px / 2, top = y - high_px / 2;
    context.fillStyle = hot ? colours.hot : colours.panel;
    context.strokeStyle = body === selected ? colours.accent : down ? colours.bad : colours['agv-line'];
    context.lineWidth = body === selected ? 3.5 : 1.6;
    context.fillRect(left, top, wide_px, high_px);
    context.strokeRect(left, top, wide_px, high_px);
    context.lineWidth = 1.6;
    context.beginPath();
    for (const slot of [0.25, 0.5, 0.75]) {
      context.moveTo(left + 4, top + slot * high_px);
      context.lineTo(left + wide_px - 4, top + slot * high_px);
    }
    if (down) {
      context.moveTo(left - 3, top - 3);
      context.lineTo(left + wide_px + 3, top + high_px + 3);
    }
    context.stroke();
    label(nameOf(body), x, y + high_px / 2 + 12, down ? colours.bad : colours.ink, true);
  }
};

// What a computer sent, in the upper part of its row: a tick for each instant, and what it said to whom where there is
// room.
const drawSaid = (context, body, y) => {
  const list = arrivalsOf[body], look = lookOf(body), ticks = [], numbers = new Set();
  const first = countUpTo(list, a => a.sent_s, window_s.from), end = countUpTo(list, a => a.sent_s, window_s.to);
  for (const a of window_s.to - window_s.from <= 130 ? list.slice(first, end) : []) {
    if (a.sender !== body || numbers.has(a.number)) continue;
    numbers.add(a.number);
    const x = Math.round(rowX(a.sent_s)), last = ticks[ticks.length - 1];
    if (last && last.x === x) ++last.more; else ticks.push({x, a, more: 0});
  }
  context.font = look.font;
  ticks.forEach(({x, a, more}, i) => {
    const most_px = (i + 1 < ticks.length ? ticks[i + 1].x : rows.clientWidth) - x - 7;
    context.fillStyle = colours[colourOfKind(a.kind)];
    context.fillRect(x, y + 4, 2, look.bar_px - 2);
    if (most_px < 40) return;
    const whom = a.to === -1 ? 'all' : nameOf(a.to), others = more > 0 ? ' and ' + more + ' more' : '';
    textIn(context, whom + others + ': ' + a.kind + contentOf(a.number), x + 5, y + look.bar_px / 2 + 6.5, most_px);
  });
};

// Of each other body the last message to it, or from it: [name, what, when, what became of it].
const lastOfEach = (body, t_s, sends) => {
  const list = arrivalsOf[body], last = new Map();
  for (let i = countUpTo(list, a => a.sent_s, t_s) - 1; i >= 0; --i) {
    const a = list[i], other = sends ? a.receiver : a.sender;
    if ((a.sender === body) === sends && !last.has(other)) last.set(other, a);
  }
  return [...last].sort((a, b) => a[0] - b[0]).map(([other, a]) => {
    const arrived = a.age_s !== null && a.sent_s + a.age_s <= t_s;
    const receipt = a.age_s === null ? a.receipt : arrived ? 'after ' + seconds(a.age_s) : 'under way';
    const end = [receipt, a.age_s === null ? 'bad' : 'soft'];
    return [nameOf(other), a.kind + contentOf(a.number), seconds(a.sent_s), end];
  });
};
const tellComputer = (body, t_s, box) => {
  const spot = film.bodies[body], faults = faultsOf(body, t_s);
  const lines = [['antenna', spot.x_um === undefined ? 'access points everywhere'
                                                     : place({x_m: spot.x_um / 1e6, y_m: spot.y_um / 1e6})],
                 faults.length ? ['fault under way', [faults.join(', '), 'bad']] : ['is', 'running']];
  if (stateOf(body, t_s)) lines.push(['its agent says', stateOf(body, t_s)]);
  if (waitOf(body, t_s) !== null) lines.push(['waits for', [nameOf(waitOf(body, t_s)), 'bad']]);
  box.append(tableOf(lines.map(([name, value]) => [[name, 'soft'], value])));
  if (!isKept('messages', body, t_s)) return;
  for (const [title, sends] of [['last sent to each', true], ['last sent to it by each', false]]) {
    const last = lastOfEach(body, t_s, sends);
    if (last.length) box.append(element('h3', title), tableOf(last));
  }
};

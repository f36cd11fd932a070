// The timeline: a row for each AGV and computer: activities, what its agent says, messages, events and faults.
const rows = document.getElementById('rows'), rowsBox = document.getElementById('rows-box');
const playhead = document.getElementById('playhead');
const kAgvs = film.bodies.map((body, i) => i).filter(i => film.bodies[i].kind === 'AGV');
const kAxis_px = 20;
// Those involved stand first, then the computers.
const kOrder = [...kAgvs.filter(isInvolved), ...kComputers, ...kAgvs.filter(i => !isInvolved(i))];
// Of many, only those involved and the selected one have rows with room for what their agents say.
const kTall = {row_px: 40, bar_px: 15, says_px: 12, font: '11px system-ui, sans-serif', says: true};
const kFlat = {row_px: 22, bar_px: 11, says_px: 2, font: '9.5px system-ui, sans-serif', says: false};
const lookOf = body => {
  const alike = isComputer(body) ? kComputers.length <= 4 : kAgvs.length <= 12;
  return alike || isInvolved(body) || body === selected ? kTall : kFlat;
};
const window_s = {from: 0, to: 1, length: 40};
const kBarColours = {drive: 'drive', turn: 'turn', pick: 'transfer', drop: 'transfer', charge: 'charge',
                     dock: 'charge'};

const nameWidth = () => (rows.clientWidth < 600 ? 64 : 96);
const rowX = t_s =>
  nameWidth() + (t_s - window_s.from) / (window_s.to - window_s.from) * (rows.clientWidth - nameWidth());
const moveWindow = t_s => {
  const length_s = window_s.length > 0 ? Math.min(window_s.length, Math.max(kEnd_s, 1)) : Math.max(kEnd_s, 1);
  const from_s = Math.min(Math.max(0, t_s - 0.6 * length_s), Math.max(0, kEnd_s - length_s));
  Object.assign(window_s, {from: from_s, to: from_s + length_s});
};
const isInWindow = t_s => window_s.from <= t_s && t_s <= window_s.to;

// Text that is cut at `most_px`.
const textIn = (context, text, x, y, most_px) => {
  let shownText = text;
  while (shownText && context.measureText(shownText).width > most_px) shownText = shownText.slice(0, -1);
  if (shownText.length > 1 || shownText === text) context.fillText(shownText, x, y);
};

const drawActivities = (context, body, y) => {
  const list = activitiesOf[body], look = lookOf(body);
  context.font = look.font;
  for (let i = Math.max(0, countUpTo(list, r => r[1], window_s.from * 1e3) - 1); i < list.length; ++i) {
    const [, begin_ms, end_ms, kind, details] = list[i];
    if (begin_ms > window_s.to * 1e3) break;
    const x0 = Math.max(nameWidth(), rowX(begin_ms / 1e3)), x1 = Math.max(x0 + 1, rowX(end_ms / 1e3));
    if (end_ms / 1e3 < window_s.from) continue;
    context.fillStyle = colours[kBarColours[word(kind)] || 'other'];
    context.fillRect(x0, y + 3, x1 - x0 - 0.5, look.bar_px);
    if (x1 - x0 < 26) continue;
    context.fillStyle = colours.ink;
    textIn(context, word(details) || word(kind), x0 + 3, y + look.bar_px / 2 + 6.5, x1 - x0 - 6);
  }
};
const drawStates = (context, body, y) => {
  const list = statesOf[body], look = lookOf(body), top = y + 4 + look.bar_px, kept_s = keptOf('states', body)[1];
  for (let i = Math.max(0, countUpTo(list, r => r[1], window_s.from * 1e3) - 1); i < list.length; ++i) {
    const from_s = list[i][1] / 1e3, to_s = Math.min(i + 1 < list.length ? list[i + 1][1] / 1e3 : kEnd_s, kept_s);
    if (from_s > window_s.to) break;
    const x0 = Math.max(nameWidth(), rowX(from_s)), x1 = rowX(Math.min(to_s, window_s.to));
    if (x1 <= x0) continue;
    context.fillStyle = colours[look.says ? 'grid' : 'line'];
    context.fillRect(x0, top, x1 - x0 - 0.5, look.says_px);
    context.fillStyle = colours.soft;
    if (look.says && x1 - x0 > 20) textIn(context, word(list[i][2]), x0 + 3, top + 10, x1 - x0 - 6);
  }
};
// The arrivals of which there are marks: all, or those between bodies involved if all would be a band.
const markedArrivals = body => {
  const list = arrivalsOf[body], first = countUpTo(list, a => a.sent_s, window_s.from - 10);
  const there = list.slice(first, countUpTo(list, a => a.sent_s, window_s.to));
  return there.length < 400 ? there : there.filter(a => isInvolved(a.sender) && isInvolved(a.receiver));
};
const drawMarks = (context, body, y) => {
  const bottom = y + lookOf(body).row_px - 1, list = window_s.to - window_s.from <= 130 ? markedArrivals(body) : [];
  const seen = new Set(), drawn = [];
  for (const a of list) {
    const sends = a.sender === body, lost = !sends && a.age_s === null;
    const at_s = sends || lost ? a.sent_s : a.sent_s + a.age_s, x = Math.round(rowX(at_s));
    const key = a.kind + ' ' + (x * 4 + (sends ? 0 : lost ? 1 : 2));
    if (!isInWindow(at_s) || seen.has(key)) continue;
    seen.add(key);
    drawn.push({x, kind: a.kind, lost});
    context.fillStyle = context.strokeStyle = lost ? colours.bad : colours[colourOfKind(a.kind)];
    context.beginPath();
    if (lost) {
      context.moveTo(x - 2.5, bottom - 5);
      context.lineTo(x + 2.5, bottom);
      context.moveTo(x + 2.5, bottom - 5);
      context.lineTo(x - 2.5, bottom);
      context.stroke();
    } else {
      const tip = sends ? bottom - 5 : bottom, base = sends ? bottom : bottom - 5;
      context.moveTo(x, tip);
      context.lineTo(x + 2.5, base);
      context.lineTo(x - 2.5, base);
      context.fill();
    }
  }
  if (lookOf(body).says) drawLetters(context, drawn, bottom - 6);
  drawHappenings(context, body, y);
};
// The letters of the kinds, where they have room.
const drawLetters = (context, marks, y) => {
  context.font = '600 9px system-ui, sans-serif';
  let free = -1e9;
  for (const {x, kind, lost} of marks.sort((a, b) => a.x - b.x)) {
    const letters = kLetters.get(kind) || '', half = context.measureText(letters).width / 2;
    if (!letters || x - half < free) continue;
    free = x + half + 1;
    context.fillStyle = lost ? colours.bad : colours[colourOfKind(kind)];
    context.fillText(letters, x - half, y);
  }
};
// What happens again and again, as a call that is refused, is one mark with a line to the last time.
const drawHappenings = (context, body, y) => {
  const marks = [];
  for (const [, at_ms, what, details, flags] of happeningsOf[body]) {
    const last = marks[marks.length - 1];
    if (flags >= 2) continue;
    if (flags === 0 && last && last.what === what && last.details === details) last.to_s = at_ms / 1e3;
    else marks.push({from_s: at_ms / 1e3, to_s: at_ms / 1e3, what, details, flags});
  }
  for (const {from_s, to_s, flags} of marks) {
    if (to_s < window_s.from || from_s > window_s.to) continue;
    const x0 = Math.max(nameWidth(), rowX(from_s)), x1 = rowX(to_s);
    context.fillStyle = flags === 1 ? colours.bad : colours.accent;
    context.font = flags === 1 ? '600 15px system-ui' : '600 10px system-ui';
    context.fillText(flags === 1 ? '⚑' : '◆', x0 - 4, y + lookOf(body).bar_px + 2);
    if (x1 - x0 > 4) context.fillRect(x0, y + lookOf(body).bar_px - 2, x1 - x0, 2);
  }
  context.font = '11px system-ui, sans-serif';
};
// From the strike of a fault to its end: a line along the upper edge of the row.
const drawFaults = (context, body, y) => {
  const struck = new Map();
  const line = (from_s, to_s) => {
    const x0 = Math.max(nameWidth(), rowX(from_s));
    context.fillStyle = colours.bad;
    if (to_s >= window_s.from) context.fillRect(x0, y + 1, Math.max(2, rowX(to_s) - x0), 2.5);
  };
  for (const [, at_ms, what, details, flags] of happeningsOf[body]) {
    if (flags !== 1) continue;
    if (word(what) !== 'fault over') struck.set(details, at_ms / 1e3);
    else if (struck.has(details)) {
      line(struck.get(details), at_ms / 1e3);
      struck.delete(details);
    }
  }
  for (const from_s of struck.values()) line(from_s, kEnd_s);
};
const drawBroken = (context, body, y) => {
  for (const v of film.violations) {
    if (v.a !== body && v.b !== body) continue;
    const x0 = Math.max(nameWidth(), rowX(v.first_us / 1e6)), x1 = Math.max(rowX(v.last_us / 1e6), x0 + 2);
    if (v.first_us / 1e6 > window_s.to || v.last_us / 1e6 < window_s.from) continue;
    context.fillStyle = colours.bad;
    context.globalAlpha = 0.22;
    context.fillRect(x0, y + 1, Math.min(x1, rows.clientWidth) - x0, lookOf(body).row_px - 2);
    context.globalAlpha = 1;
  }
};

// What the window lacks, because the page has it only near the failure.
const tellMissing = () => {
  const ends_s = [window_s.from, Math.min(window_s.to - 0.01, kEnd_s)];
  const isWhole = body => ends_s.every(t_s => isKept('messages', body, t_s));
  const all = kOrder.every(isWhole), long = window_s.to - window_s.from > 130;
  document.getElementById('missing').textContent =
    long ? 'messages: choose 2 min or less' : all ? '' : 'here the page has messages only in part';
};

const drawRows = () => {
  tellMissing();
  const width = rowsBox.clientWidth;
  const height = kOrder.reduce((sum, body) => sum + lookOf(body).row_px, kAxis_px);
  rows.style.height = height + 'px';
  playhead.style.height = height + 'px';
  const context = contextOf(rows, width, height);
  context.fillStyle = colours.paper;
  context.fillRect(0, 0, width, height);
  context.font = '11px system-ui, sans-serif';
  context.textAlign = 'left';
  const step_s = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60, 120, 300, 600, 1800].find(
    step => step / (window_s.to - window_s.from) * (width - nameWidth()) >= 55) || 3600;
  for (let t = Math.ceil(window_s.from / step_s) * step_s; t <= window_s.to; t += step_s) {
    context.fillStyle = colours.line;
    context.fillRect(rowX(t), kAxis_px - 4, 1, height);
    context.fillStyle = colours.soft;
    if (rowX(t) < width - 24) context.fillText(+t.toFixed(3) + ' s', rowX(t) + 3, 12);
  }
  let y = kAxis_px;
  for (const body of kOrder) {
    const {row_px} = lookOf(body);
    context.save();
    context.beginPath();
    context.rect(nameWidth(), y, width, row_px);
    context.clip();
    (isComputer(body) ? drawSaid : drawActivities)(context, body, y);
    drawStates(context, body, y);
    drawBroken(context, body, y);
    drawFaults(context, body, y);
    drawMarks(context, body, y);
    context.restore();
    if (body === selected) {
      context.fillStyle = colours.accent;
      context.fillRect(0, y, 4, row_px);
    }
    context.fillStyle = isInvolved(body) ? colours.bad : colours.ink;
    context.font = (isInvolved(body) ? '650 ' : '') + '12px system-ui, sans-serif';
    textIn(context, nameOf(body), 8, y + row_px / 2 + 4, nameWidth() - 12);
    context.font = '11px system-ui, sans-serif';
    context.fillStyle = colours.line;
    context.fillRect(0, y, width, 1);
    y += row_px;
  }
};
// The AGV or computer whose row is there, if one is.
const rowAt = y => {
  let below = kAxis_px;
  return y < kAxis_px ? undefined : kOrder.find(body => (below += lookOf(body).row_px) > y);
};
const timeAt = x => window_s.from +
  (x - nameWidth()) / (rows.clientWidth - nameWidth()) * (window_s.to - window_s.from);


// What moves on the floor: bodies with perimeters and hulls, beliefs as ghosts, messages as arrows.
const shown = {perimeters: true, hulls: true, beliefs: true, messages: true, waits: true, names: true, whose: 'some'};
let selected = null;  // an AGV or a computer

// Those whose beliefs and messages are drawn. Where nothing went wrong, those of the computers.
const spotlight = () => {
  if (shown.whose === 'all') return film.bodies.map((body, i) => i);
  if (selected !== null) return [selected];
  return film.involved.length ? film.involved : kComputers;
};

// All bodies on the floor at an instant.
const bodiesAt = t_s => film.bodies.map((body, i) => {
  const piece = pieceAt(i, t_s);
  if (!piece) return null;
  const pose = poseAt(piece, t_s);
  return {body: i, piece, pose, box: boxOf(piece, pose, 0)};
});

const drawHull = (context, {piece, body}) => {
  if (piece[kManner] === 0) return;
  context.beginPath();
  const hull = hullOf(piece);
  if (hull.length === 2 && piece[kManner] === 1) {  // straight: one box from the first footprint to the last
    const [a, b] = hull, way_m = Math.hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    roundedPath(context, {...a, x_m: (a.x_m + b.x_m) / 2, y_m: (a.y_m + b.y_m) / 2, long_m: a.long_m + way_m / 2},
                kSafety_m);
  } else {
    for (const box of hull) roundedPath(context, box, kSafety_m);
  }
  context.fillStyle = isInvolved(body) || body === selected ? colours.hot : colours.hull;
  context.globalAlpha = 0.2;
  context.fill();
  context.globalAlpha = 1;
};

const drawBody = (context, {body, box}, isBroken, t_s) => {
  const isAgv = film.bodies[body].kind === 'AGV', hot = isInvolved(body);
  if (shown.perimeters) {
    context.beginPath();
    roundedPath(context, box, kSafety_m);
    context.strokeStyle = isBroken ? colours.bad : hot ? colours.hot : colours.lane;
    context.lineWidth = isBroken ? 2 : 1;
    context.stroke();
  }
  context.beginPath();
  boxPath(context, box);
  context.fillStyle = hot ? colours.hot : isAgv ? colours.agv : colours.thing;
  context.fill();
  context.strokeStyle = body === selected ? colours.accent : hot ? colours['hot-line'] : colours['agv-line'];
  context.lineWidth = body === selected ? 3.5 : 1.2;
  context.stroke();
  if (!isAgv) return;
  if (isLoaded(body, t_s)) {
    context.beginPath();
    boxPath(context, {...box, x_m: box.x_m - 0.18 * box.long_m * box.ux, y_m: box.y_m - 0.18 * box.long_m * box.uy,
                      long_m: 0.62 * box.long_m, wide_m: 0.74 * box.wide_m});
    context.fillStyle = colours.load;
    context.fill();
  }
  const point = (along, aside) => [toX(box.x_m + along * box.long_m * box.ux - aside * box.wide_m * box.uy),
                                   toY(box.y_m + along * box.long_m * box.uy + aside * box.wide_m * box.ux)];
  context.beginPath();  // the nose
  context.moveTo(...point(0.94, 0));
  context.lineTo(...point(0.3, 0.42));
  context.lineTo(...point(0.3, -0.42));
  context.closePath();
  context.fillStyle = hot ? colours['hot-line'] : colours['agv-line'];
  context.fill();
};

// Where `agent` believes the others to be.
const drawBeliefs = (context, agent, all, t_s, label) => {
  if (!isKept('beliefs', agent, t_s)) return;
  for (const [about, rows] of beliefsOf[agent]) {
    const row = lastUpTo(rows, r => r[2], t_s * 1e3 + 1e-6), real = all[about];
    if (!row || (shown.whose === 'some' && selected === null && !isInvolved(about))) continue;
    const pose = {x_m: row[4] / 1e3, y_m: row[5] / 1e3, heading_rad: (row[6] || 0) / 1e3};
    const x = toX(pose.x_m), y = toY(pose.y_m), age_s = t_s - row[3] / 1e3;
    context.beginPath();
    if (row.length > 6 && real) {
      boxPath(context, boxOf(real.piece, pose, 0));
    } else {
      context.arc(x, y, Math.max(5, (real ? real.box.wide_m : 0.5) * view.scale), 0, 7);
    }
    if (real) {
      context.moveTo(x, y);
      context.lineTo(toX(real.pose.x_m), toY(real.pose.y_m));
    }
    context.strokeStyle = colours.ghost;
    context.setLineDash([4, 4]);
    context.lineWidth = 1.5;
    context.stroke();
    context.setLineDash([]);
    const away_m = real ? Math.hypot(real.pose.x_m - pose.x_m, real.pose.y_m - pose.y_m) : 0;
    if (isInView(x, y) && (away_m > 0.3 || (age_s > 3 && about !== agent && isInvolved(about))))
      label(nameOf(agent) + ' believes ' + nameOf(about) + ', ' + age_s.toFixed(1) + ' s old', x, y - 8, colours.ghost);
  }
};

// From each AGV that says it waits to the AGV or computer for which it waits.
const drawWaits = (context, all, t_s) => {
  for (const one of all) {
    const other = one && waitOf(one.body, t_s), end = other === null ? null : spotOf(all, other);
    if (!end) continue;
    const hot = (isInvolved(one.body) && isInvolved(other)) || one.body === selected;
    const x0 = toX(one.box.x_m), y0 = toY(one.box.y_m), [x1, y1] = end;
    const bend = 0.18, cx = (x0 + x1) / 2 - bend * (y1 - y0), cy = (y0 + y1) / 2 + bend * (x1 - x0);
    const out = Math.atan2(y1 - cy, x1 - cx), size = hot ? 13 : 8;
    context.strokeStyle = context.fillStyle = colours.wait;
    context.globalAlpha = hot ? 1 : 0.45;
    context.lineWidth = hot ? 3 : 1.3;
    context.beginPath();
    context.moveTo(x0, y0);
    context.quadraticCurveTo(cx, cy, x1, y1);
    context.stroke();
    context.beginPath();
    for (const turn of [0, 2.7, -2.7]) {
      const reach = turn === 0 ? 0 : size;
      context.lineTo(x1 + reach * Math.cos(out + turn), y1 + reach * Math.sin(out + turn));
    }
    context.fill();
    context.globalAlpha = 1;
  }
};

const isInView = (x, y) => x > 0 && y > 0 && x < floor.clientWidth && y < floor.clientHeight;
const kLossShown_s = 0.8, kLate_s = 1;
// Messages that are under way, and losses for a moment: [arrival, share of its way].
const underWay = t_s => {
  const bodies = spotlight(), found = [];
  const lists = shown.whose === 'all' ? [arrivals] : bodies.map(body => arrivalsOf[body]), seen = new Set();
  for (const list of lists) {
    for (let i = countUpTo(list, a => a.sent_s, t_s) - 1; i >= 0 && list[i].sent_s > t_s - kLongestAge_s; --i) {
      const a = list[i], lasts_s = a.age_s === null ? kLossShown_s : Math.max(a.age_s, 0.12);
      if (t_s - a.sent_s > lasts_s || seen.has(a)) continue;
      seen.add(a);
      found.push([a, (t_s - a.sent_s) / lasts_s]);
      if (found.length > 400) return found;
    }
  }
  return found;
};
const drawMessages = (context, all, t_s, label) => {
  const found = underWay(t_s), crowded = found.length > 24;
  const isOfFew = shown.whose === 'some' && selected === null && film.involved.length > 0;
  const matters = body => isInvolved(body) || isComputer(body);
  for (const [a, share] of found) {
    const from = spotOf(all, a.sender), to = spotOf(all, a.receiver);
    if (!from || !to) continue;
    const lost = a.age_s === null, between = film.involved.length > 0 && matters(a.sender) && matters(a.receiver);
    if (crowded && !between && (lost || isOfFew)) continue;
    const [x0, y0] = from, [x1, y1] = to;
    const k = lost ? 0.5 : share, x = x0 + k * (x1 - x0), y = y0 + k * (y1 - y0), out = Math.atan2(y1 - y0, x1 - x0);
    context.strokeStyle = context.fillStyle = lost ? colours.bad : colours.message;
    context.globalAlpha = crowded && !between ? 0.35 : 1;
    context.lineWidth = between ? 2 : 1.2;
    context.setLineDash(!lost && a.age_s > kLate_s ? [6, 5] : []);
    context.beginPath();
    context.moveTo(x0, y0);
    context.lineTo(x, y);
    context.stroke();
    context.setLineDash([]);
    context.beginPath();
    if (lost) {
      for (const turn of [0.25, 0.75]) {
        const dx = 6 * Math.cos(out + turn * Math.PI), dy = 6 * Math.sin(out + turn * Math.PI);
        context.moveTo(x - dx, y - dy);
        context.lineTo(x + dx, y + dy);
      }
      context.stroke();
    } else {
      for (const [along, turn] of [[0, 0], [9, 2.7], [9, -2.7]])
        context.lineTo(x + along * Math.cos(out + turn), y + along * Math.sin(out + turn));
      context.fill();
    }
    context.globalAlpha = 1;
    const old_s = Math.min(t_s - a.sent_s, a.age_s);
    const old = (old_s < 0.1 ? seconds(old_s) : old_s.toFixed(1) + ' s') + ' old' + (a.again ? ', a copy' : '');
    const age = lost ? a.receipt : old;
    if ((!crowded || between) && isInView(x, y))
      label(a.kind + contentOf(a.number) + ', ' + age, x, y - 6, lost ? colours.bad : colours.message);
  }
};

// The pair that the page is about at this instant: of the violation under way, else of the next one, else of the last.
// Without a violation: the two involved, as in a deadlock; if nothing went wrong, the two that came closest.
const pairAt = t_s => {
  const near = film.violations.find(v => v.last_us / 1e6 + 2 >= t_s) || film.violations[film.violations.length - 1];
  if (near) return [near.a, near.b];
  if (film.involved.length) return film.involved.length === 2 ? film.involved : null;
  return film.nearest ? [film.nearest.a, film.nearest.b] : null;
};
const gapAt = (all, pair) =>
  pair && all[pair[0]] && all[pair[1]] ? closestPoints(all[pair[0]].box, all[pair[1]].box) : null;
const isBrokenAt = (body, t_s) =>
  film.violations.some(v => (v.a === body || v.b === body) && v.first_us / 1e6 <= t_s && t_s <= v.last_us / 1e6);

// Boxes on the canvas that labels had better leave free.
const footprintsOnCanvas = t_s => bodiesAt(t_s).filter(Boolean).map(({box}) => {
  const xs = cornersOf(box).map(p => toX(p[0])), ys = cornersOf(box).map(p => toY(p[1]));
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}).concat(computerBoxes());

const isOnCanvas = box => toX(box.x_m) > -40 && toX(box.x_m) < floor.clientWidth + 40;

const drawFloor = t_s => {
  const context = contextOf(floor, floor.clientWidth, floor.clientHeight);
  const label = makeLabels(context, footprintsOnCanvas(t_s));
  context.fillStyle = colours.floor;
  context.fillRect(0, 0, floor.clientWidth, floor.clientHeight);
  const axes = drawAxes(context), stationNames = drawMap(context, label, shown.names), all = bodiesAt(t_s);
  const there = all.filter(Boolean), gap = gapAt(all, pairAt(t_s));
  if (shown.hulls) there.forEach(one => drawHull(context, one));
  there.sort((a, b) => isInvolved(a.body) - isInvolved(b.body));
  for (const one of there) drawBody(context, one, isBrokenAt(one.body, t_s), t_s);
  if (gap && gap.apart_m < 5) {
    const colour = film.violations.length ? colours.bad : colours.accent;
    context.strokeStyle = colour;
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(toX(gap.from[0]), toY(gap.from[1]));
    context.lineTo(toX(gap.to[0]), toY(gap.to[1]));
    context.stroke();
    const x = toX((gap.from[0] + gap.to[0]) / 2), y = toY((gap.from[1] + gap.to[1]) / 2);
    if (x > 0 && x < floor.clientWidth) label(gap.apart_m.toFixed(3) + ' m', x, y - 9, colour, true);
  }
  if (shown.names) {
    const margin_m = shown.perimeters ? kSafety_m : 0;
    for (const {body, box} of there.reverse()) {
      const reach_m = Math.abs(box.uy) * box.long_m + Math.abs(box.ux) * box.wide_m;
      if (isOnCanvas(box) && (view.scale > 5 || isInvolved(body) || body === selected))
        label(nameOf(body), toX(box.x_m), toY(box.y_m - reach_m - margin_m) + 13, colours.ink, isInvolved(body));
    }
  }
  drawComputers(context, t_s, label);
  if (shown.waits) drawWaits(context, all, t_s);
  if (shown.beliefs) spotlight().forEach(agent => drawBeliefs(context, agent, all, t_s, label));
  if (shown.messages) drawMessages(context, all, t_s, label);
  stationNames();
  axes();
  return all;
};

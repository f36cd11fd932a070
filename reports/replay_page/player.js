// Time, keys, mouse and the address of the page.
const slider = byId('slider'), clock = byId('clock');
const player = {t_s: film.open_us / 1e6, playing: false, speed: 1, before_ms: 0, line: null};
const kStill = matchMedia('(prefers-reduced-motion: reduce)');

const movePlayhead = () => { playhead.style.left = rowX(player.t_s) + 'px'; };
const moveCharts = () => {
  const pair = pairAt(player.t_s);
  for (const figure of document.querySelectorAll('figure.clearance')) {
    const d = figure.dataset, share = (player.t_s * 1e6 - d.fromUs) / (d.toUs - d.fromUs);
    const curve = film.clearances[d.curve];
    const x = share >= 0 && share <= 1 ? +d.leftPx + share * (d.rightPx - d.leftPx) : -9;
    const line = figure.querySelector('.now');
    line.setAttribute('x1', x);
    line.setAttribute('x2', x);
    figure.hidden = Boolean(pair) && film.clearances.length > 1 && !(curve.a === pair[0] && curve.b === pair[1]);
  }
};
const draw = () => {
  const t_s = player.t_s, all = drawFloor(t_s);
  if (t_s < window_s.from || t_s > window_s.to) {
    moveWindow(t_s);
    drawRows();
  }
  movePlayhead();
  moveCharts();
  tell(t_s, all);
  markLine(t_s);
  slider.value = t_s;
  clock.textContent = seconds(t_s);
};
const drawAll = () => {
  readColours();
  moveWindow(player.t_s);
  drawRows();
  draw();
};

const remember = () => {
  const address = '#t=' + +player.t_s.toFixed(6) + (selected === null ? '' : '&agv=' + selected);
  try { history.replaceState(null, '', address); } catch (refused) { /* a viewer may forbid it */ }
};
const goTo = (t_s, line = null) => {
  player.line = line;
  player.t_s = Math.min(Math.max(0, t_s), kEnd_s);
  draw();
  if (!player.playing) remember();
};
const select = body => {
  selected = body === selected ? null : body;
  drawRows();
  draw();
  remember();
};

const step = now_ms => {
  if (!player.playing) return;
  const passed_s = (now_ms - player.before_ms) / 1e3 * player.speed;
  if (!kStill.matches || passed_s >= 0.5 * player.speed) {
    player.before_ms = now_ms;
    goTo(player.t_s + Math.min(passed_s, player.speed));
    if (player.t_s >= kEnd_s) play(false);
  }
  requestAnimationFrame(step);
};
const play = on => {
  player.playing = on;
  byId('play').textContent = on ? 'Pause' : 'Play';
  if (!on) return remember();
  if (player.t_s >= kEnd_s) player.t_s = 0;
  player.before_ms = performance.now();
  requestAnimationFrame(step);
};

// Instants that one jumps to: each violation; without any, the end point and the closest approach.
const kJumps_s = film.violations.length ? film.violations.map(v => v.first_us / 1e6)
  : [kFocus_s, ...(film.nearest ? [film.nearest.at_us / 1e6] : [])].sort((a, b) => a - b);
const jump = forward => {
  const ahead = kJumps_s.filter(at => (forward ? at > player.t_s + 5e-7 : at < player.t_s - 5e-7));
  if (!ahead.length) return;
  play(false);
  goTo(forward ? ahead[0] : ahead[ahead.length - 1]);
};

const kSubject = film.involved.length || !film.nearest ? film.involved : [film.nearest.a, film.nearest.b];
// Shows the footprints of the pair, or of others, at some instants, as near as fits.
const showPair = (instants_s, bodies = kSubject, room_m = 0.8) => {
  const places = [];
  for (const t_s of instants_s) {
    for (const piece of bodies.map(body => pieceAt(body, t_s)).filter(Boolean))
      places.push(...cornersOf(boxOf(piece, poseAt(piece, t_s), kSafety_m)));
  }
  if (!places.length) return wholeFloor();
  const xs = places.map(p => p[0]), ys = places.map(p => p[1]);
  fitTo([Math.min(...xs) - room_m, Math.min(...ys) - room_m], [Math.max(...xs) + room_m, Math.max(...ys) + room_m]);
};
const selectComputer = () => {
  if (kComputers.length) select(kComputers[(kComputers.indexOf(selected) + 1) % kComputers.length]);
};
const showFailure = () => showPair([kFocus_s]);
const zoom = (factor, x = floor.clientWidth / 2, y = floor.clientHeight / 2) => {
  const [x_m, y_m] = toFloor(x, y);
  view.scale = Math.min(800, Math.max(1, view.scale * factor));
  const [now_x_m, now_y_m] = toFloor(x, y);
  view.x_m += x_m - now_x_m;
  view.y_m += y_m - now_y_m;
  draw();
};

const kKeys = {
  ' ': () => play(!player.playing),
  n: () => jump(true),
  p: () => jump(false),
  ArrowRight: () => goTo(player.t_s + 1),
  ArrowLeft: () => goTo(player.t_s - 1),
  j: () => stepLine(1),
  k: () => stepLine(-1),
  '>': () => goTo(player.t_s + 0.001),
  '<': () => goTo(player.t_s - 0.001),
  '.': () => goTo(player.t_s + 0.02),
  ',': () => goTo(player.t_s - 0.02),
  w: () => { wholeFloor(); draw(); },
  f: () => { showFailure(); draw(); },
  c: selectComputer,
  '+': () => zoom(1.25),
  '-': () => zoom(0.8),
  '?': () => byId('help').showModal(),
};
addEventListener('keydown', event => {
  if (event.ctrlKey || event.metaKey || event.altKey || byId('help').open) return;
  if (event.target.tagName === 'SELECT') return;
  if (event.key === ' ' && event.target.tagName === 'SUMMARY') return;
  if (event.key === ' ' && event.target.tagName === 'BUTTON') return;
  const number = Number(event.key);
  const action = kKeys[event.key] || (number >= 1 && number <= kAgvs.length ? () => select(kAgvs[number - 1]) : null);
  if (!action) return;
  event.preventDefault();
  action();
});

// Dragging moves the floor, two fingers and the wheel zoom, a click selects.
const fingers = new Map();
let moved_px = 0;
floor.addEventListener('pointerdown', event => {
  floor.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
  if (fingers.size === 1) moved_px = 0;
});
floor.addEventListener('pointermove', event => {
  const before = fingers.get(event.pointerId), now = [event.offsetX, event.offsetY];
  if (!before) return;
  const other = [...fingers].find(([id]) => id !== event.pointerId);
  fingers.set(event.pointerId, now);
  moved_px += Math.hypot(now[0] - before[0], now[1] - before[1]);
  if (other) {
    const reach = p => Math.hypot(p[0] - other[1][0], p[1] - other[1][1]);
    return zoom(reach(now) / Math.max(1, reach(before)), other[1][0], other[1][1]);
  }
  view.x_m -= (now[0] - before[0]) / view.scale;
  view.y_m += (now[1] - before[1]) / view.scale;
  draw();
});
floor.addEventListener('pointerup', event => {
  fingers.delete(event.pointerId);
  if (moved_px > 5) return;
  const at = toFloor(event.offsetX, event.offsetY);
  const hit = bodiesAt(player.t_s).find(one => one && isInside(at, boxOf(one.piece, one.pose, 0.2)));
  const computer = computerAt(event.offsetX, event.offsetY);
  if (computer !== undefined) select(computer);
  else if (hit) select(hit.body);
});
floor.addEventListener('pointercancel', event => fingers.delete(event.pointerId));
floor.addEventListener('wheel', event => {
  event.preventDefault();
  zoom(Math.exp(-event.deltaY / 500), event.offsetX, event.offsetY);
}, {passive: false});
rows.addEventListener('click', event => {
  const body = rowAt(event.offsetY);
  if (event.offsetX < nameWidth()) return void (body !== undefined && select(body));
  goTo(timeAt(event.offsetX));
});
// What has no room in a row: as the browser shows titles.
rows.addEventListener('pointermove', event => {
  const body = rowAt(event.offsetY), t_s = timeAt(event.offsetX);
  rows.title = body === undefined || event.offsetX < nameWidth() ? '' : nameOf(body) + ' at ' + seconds(t_s) + ': ' +
    aboutActivity(body, t_s) + (stateOf(body, t_s) ? '; its agent says "' + stateOf(body, t_s) + '"' : '');
});

slider.max = kEnd_s;
slider.addEventListener('input', () => { play(false); goTo(Number(slider.value)); });
byId('play').addEventListener('click', () => play(!player.playing));
byId('event-after').addEventListener('click', kKeys.j);
byId('event-before').addEventListener('click', kKeys.k);
byId('next').addEventListener('click', () => jump(true));
byId('previous').addEventListener('click', () => jump(false));
byId('speed').addEventListener('change', event => { player.speed = Number(event.target.value); });
byId('span').addEventListener('change', event => { window_s.length = Number(event.target.value); drawAll(); });
byId('whose').addEventListener('change', event => { shown.whose = event.target.value; draw(); });
for (const what of ['perimeters', 'hulls', 'beliefs', 'messages', 'waits', 'names'])
  byId('show-' + what).addEventListener('change', event => { shown[what] = event.target.checked; draw(); });
byId('whole').addEventListener('click', kKeys.w);
byId('failure').addEventListener('click', kKeys.f);
byId('nearer').addEventListener('click', kKeys['+']);
byId('farther').addEventListener('click', kKeys['-']);
byId('help-button').addEventListener('click', kKeys['?']);
byId('help-close').addEventListener('click', () => byId('help').close());

// "#t=64.2&agv=2": an instant in seconds, and the number of an AGV, counted from 0, or the name of an AGV or computer.
const readAddress = () => {
  const asked = new URLSearchParams(location.hash.slice(1)), agv = asked.get('agv');
  if (asked.has('t') && isFinite(asked.get('t'))) player.t_s = Math.min(Math.max(0, Number(asked.get('t'))), kEnd_s);
  if (agv === null) return;
  const found = film.bodies.findIndex(body => body.name === agv);
  selected = found >= 0 ? found : kOrder.includes(Number(agv)) ? Number(agv) : selected;
};
addEventListener('hashchange', () => { readAddress(); drawAll(); });
addEventListener('resize', drawAll);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', drawAll);

// The kinds of messages in the legend: a letter of its colour, and the kind.
for (const kind of kKinds.slice(0, 12)) {
  const letters = element('b', ' ' + kLetters.get(kind) + ' ');
  letters.style.color = 'var(--' + colourOfKind(kind) + ')';
  byId('kinds').append(letters, kind + ' ');
}
if (!film.violations.length) {
  byId('previous').textContent = 'Previous mark';
  byId('next').textContent = 'Next mark';
}
if (!film.involved.length) byId('failure').textContent = 'Closest pair';
byId('failure').hidden = !kSubject.length;
byId('flat').hidden = kOrder.every(body => lookOf(body) === kTall);
byId('player').hidden = false;
document.documentElement.classList.add('ready');  // before the first drawing: then the event log is as high as it stays
readAddress();
if (selected === null || kSubject.includes(selected)) showPair([kFocus_s, player.t_s]);
else showPair([player.t_s], [selected], 6);
drawAll();
document.documentElement.dataset.ready = 'yes';

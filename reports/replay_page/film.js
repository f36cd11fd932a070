// The film: what the page knows of the run, and the questions that the drawings ask of it. Seconds and metres.
'use strict';
const byId = id => document.getElementById(id);
const film = JSON.parse(document.getElementById('film').textContent);
const kSafety_m = film.safety_distance_um / 1e6, kEnd_s = film.end_us / 1e6, kFocus_s = film.focus_us / 1e6;
const word = index => film.words[index];
// Cut to milliseconds as in the tables.
const seconds = value_s => (Math.floor(value_s * 1e3 + 1e-6) / 1e3).toFixed(3) + ' s';
const nameOf = body => film.bodies[body].name;
const isInvolved = body => film.involved.includes(body);

// The number of items, in order of `key`, whose key is at most `value`.
const countUpTo = (items, key, value) => {
  let low = 0, high = items.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (key(items[middle]) > value) high = middle; else low = middle + 1;
  }
  return low;
};
const lastUpTo = (items, key, value) => items[countUpTo(items, key, value) - 1];

const byBody = rows => {
  const lists = film.bodies.map(() => []);
  for (const row of rows) lists[row[0]].push(row);
  return lists;
};
const piecesOf = byBody(film.pieces_us_um_urad), activitiesOf = byBody(film.activities_ms);
const statesOf = byBody(film.states_ms), waitsOf = byBody(film.waits_ms), loadsOf = byBody(film.loads_ms);
const happeningsOf = byBody(film.happenings_ms);

// What an agent believes of each other AGV: beliefsOf[agent] is a map from the other AGV to rows in order of time.
const beliefsOf = byBody(film.beliefs_ms_mm_mrad).map(rows => {
  const about = new Map();
  for (const row of rows) {
    if (!about.has(row[1])) about.set(row[1], []);
    about.get(row[1]).push(row);
  }
  return about;
});

// Every arrival of a message at one receiver, in order of sending. `age_s` null: lost. `again`: its second copy.
const kReceipts = ['received', 'lost by chance', 'lost in an outage', 'lost by interference', 'lost to a source',
                'lost on purpose by the scenario'];
const arrivals = [], whole = new Set();
for (const [number, sender, to, sent_ms, kind, bytes, ...pairs] of film.messages_ms) {
  for (let i = 0; i < pairs.length; i += 2) {
    const lost = pairs[i + 1] < 0, key = number * 65536 + pairs[i], again = whole.has(key);
    whole.add(key);
    arrivals.push({again, number, sender, receiver: pairs[i], sent_s: sent_ms / 1e3, kind: word(kind), bytes, to,
                   age_s: lost ? null : pairs[i + 1] / 1e3, receipt: kReceipts[lost ? -pairs[i + 1] : 0]});
  }
}
// The kinds of messages. Each has a colour, and a letter or two that no other kind has.
const kKinds = [...new Set(film.messages_ms.map(row => row[4]))].map(word).filter(Boolean).sort();
const kLetters = new Map(kKinds.map(kind => {
  const others = kKinds.filter(other => other !== kind);
  const size = [1, 2, 3].find(n => others.every(other => other.slice(0, n) !== kind.slice(0, n))) || 3;
  return [kind, kind.slice(0, size)];
}));
const kKindColours = 6;
const colourOfKind = kind => 'kind-' + Math.max(0, kKinds.indexOf(kind)) % kKindColours;
// What a message says, if the page has it.
const contents = new Map(film.contents.map(([number, content]) => [number, word(content)]));
const contentOf = number => (contents.has(number) ? ': ' + contents.get(number) : '');
const kLongestAge_s = arrivals.reduce((most, a) => Math.max(most, a.age_s || 0), 1);
const arrivalsOf = film.bodies.map(() => []);
for (const arrival of arrivals) {
  arrivalsOf[arrival.sender].push(arrival);
  if (arrival.receiver !== arrival.sender) arrivalsOf[arrival.receiver].push(arrival);
}

// Whether the page has all "messages", "beliefs", "states" or "waits" of a body at an instant. A large fleet has too
// many.
const keptOf = (what, body) => {
  const [from_ms, to_ms] = isInvolved(body) ? film.kept_ms[what] : film.kept_ms[what].slice(2);
  return [from_ms / 1e3, to_ms / 1e3];
};
const isKept = (what, body, t_s) => {
  const [from_s, to_s] = keptOf(what, body);
  return from_s <= t_s + 1e-3 && t_s <= to_s + 1e-3;
};

const stateOf = (body, t_s) => {
  if (!isKept('states', body, t_s)) return '';
  const row = lastUpTo(statesOf[body], r => r[1], t_s * 1e3 + 1e-6);
  return row ? word(row[2]) : '';
};
const waitOf = (body, t_s) => {
  if (!isKept('waits', body, t_s)) return null;
  const row = lastUpTo(waitsOf[body], r => r[1], t_s * 1e3 + 1e-6);
  return row && row[2] >= 0 ? row[2] : null;
};
const isLoaded = (body, t_s) => {
  const row = lastUpTo(loadsOf[body], r => r[1], t_s * 1e3 + 1e-6);
  return Boolean(row && row[2]);
};
const activityOf = (body, t_s) => {
  const row = lastActivityOf(body, t_s);
  return row && row[2] >= t_s * 1e3 ? row : null;
};
const lastActivityOf = (body, t_s) => lastUpTo(activitiesOf[body], r => r[1], t_s * 1e3 + 1e-6);

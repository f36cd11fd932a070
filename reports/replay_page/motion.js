// Where bodies are: the pieces of the film, evaluated at any instant.
// A piece: body, manner (0 rests, 1 drives, 2 turns), begin_us, end_us, outline; of a drive track, flags (1 against the
// track, 2 tail first), way_begin_um, planned_um, else x_um, y_um, heading_urad, planned_urad; then phases.
const kManner = 1, kBegin = 2, kEnd = 3, kOutline = 4, kPhases = 9;

const pieceAt = (body, t_s) => {
  const t_us = t_s * 1e6, piece = lastUpTo(piecesOf[body], p => p[kBegin], t_us);
  return piece && piece[kEnd] >= t_us - 1 ? piece : null;
};

// Metres of a drive, radians of a turn, since the beginning of the piece.
const wayAt = (piece, t_us) => {
  const since_us = Math.min(t_us, piece[kEnd]) - piece[kBegin];
  let at = kPhases;
  while (at + 4 < piece.length && since_us >= piece[at + 4]) at += 4;
  if (at >= piece.length) return 0;
  const d_s = Math.max(0, since_us - piece[at]) / 1e6;
  const way = piece[at + 1] + d_s * (piece[at + 2] + 0.5 * d_s * piece[at + 3]);
  return Math.min(way, Math.abs(piece[8])) / 1e6;
};

const speedAt = (piece, t_us) => {
  const since_us = t_us - piece[kBegin];
  let at = kPhases;
  while (at + 4 < piece.length && since_us >= piece[at + 4]) at += 4;
  if (at >= piece.length) return 0;
  return Math.max(0, piece[at + 2] + (since_us - piece[at]) / 1e6 * piece[at + 3]) / 1e6;
};

// Between two points of a track: the cubic curve with their places and directions.
const onTrack = (points, way_um) => {
  let at = 0;
  while (at + 8 < points.length && way_um > points[at + 7]) at += 4;
  const length = Math.max(1, points[at + 7] - points[at + 3]);
  const u = Math.min(1, Math.max(0, (way_um - points[at + 3]) / length));
  const between = (p0, p1, m0, m1) => ({
    at: (1 + 2 * u) * (1 - u) * (1 - u) * p0 + u * (1 - u) * (1 - u) * m0 + u * u * (3 - 2 * u) * p1 +
        u * u * (u - 1) * m1,
    slope: 6 * u * (1 - u) * (p1 - p0) + (1 - u) * (1 - 3 * u) * m0 + u * (3 * u - 2) * m1,
  });
  const h0 = points[at + 2] / 1e6, h1 = points[at + 6] / 1e6;
  const x = between(points[at], points[at + 4], length * Math.cos(h0), length * Math.cos(h1));
  const y = between(points[at + 1], points[at + 5], length * Math.sin(h0), length * Math.sin(h1));
  return {x_m: x.at / 1e6, y_m: y.at / 1e6, heading_rad: Math.atan2(y.slope, x.slope)};
};

// Of a drive after `way_m` from the beginning of the piece.
const poseOnDrive = (piece, way_m) => {
  const points = film.tracks[piece[5]].points_um_urad, against = piece[6] % 2 === 1, tailFirst = piece[6] >= 2;
  const way_um = piece[7] + way_m * 1e6;
  const pose = onTrack(points, against ? points[points.length - 1] - way_um : way_um);
  if (against !== tailFirst) pose.heading_rad += Math.PI;
  return pose;
};
const poseAfter = (piece, way) => {
  if (piece[kManner] === 1) return poseOnDrive(piece, way);
  const turned_rad = piece[kManner] === 2 ? Math.sign(piece[8]) * way : 0;
  return {x_m: piece[5] / 1e6, y_m: piece[6] / 1e6, heading_rad: piece[7] / 1e6 + turned_rad};
};
const poseAt = (piece, t_s) => poseAfter(piece, piece[kManner] === 0 ? 0 : wayAt(piece, t_s * 1e6));

// A footprint as its centre, heading and half sizes, each side moved outwards by `margin_m`.
const boxOf = (piece, pose, margin_m) => {
  const [length_um, width_um, ahead_um] = film.outlines_um[piece[kOutline]];
  const ux = Math.cos(pose.heading_rad), uy = Math.sin(pose.heading_rad);
  return {x_m: pose.x_m + ux * ahead_um / 1e6, y_m: pose.y_m + uy * ahead_um / 1e6, ux, uy,
          long_m: length_um / 2e6 + margin_m, wide_m: width_um / 2e6 + margin_m};
};
const cornersOf = box => [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([along, aside]) =>
  [box.x_m + along * box.long_m * box.ux - aside * box.wide_m * box.uy,
   box.y_m + along * box.long_m * box.uy + aside * box.wide_m * box.ux]);

// The closest points of two footprints, or null if they overlap.
const toSide = (p, a, b) => {
  const dx = b[0] - a[0], dy = b[1] - a[1];
  const k = Math.min(1, Math.max(0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy)));
  return [a[0] + k * dx, a[1] + k * dy];
};
const isInside = (p, box) => {
  const dx = p[0] - box.x_m, dy = p[1] - box.y_m;
  return Math.abs(dx * box.ux + dy * box.uy) <= box.long_m && Math.abs(dy * box.ux - dx * box.uy) <= box.wide_m;
};
const closestPoints = (one, other) => {
  const a = cornersOf(one), b = cornersOf(other);
  let best = null;
  const take = (p, q) => {
    const apart_m = Math.hypot(p[0] - q[0], p[1] - q[1]);
    if (best === null || apart_m < best.apart_m) best = {apart_m, from: p, to: q};
  };
  for (let i = 0; i < 4; ++i) {
    if (isInside(a[i], other) || isInside(b[i], one)) return {apart_m: 0, from: a[i], to: a[i]};
    for (let k = 0; k < 4; ++k) {
      take(a[i], toSide(a[i], b[k], b[(k + 1) % 4]));
      take(toSide(b[i], a[k], a[(k + 1) % 4]), b[i]);
    }
  }
  return best;
};

// Footprints along all that the drive or turn of a piece is to sweep: what its hull is made of.
const hullOf = piece => {
  if (piece.hull) return piece.hull;
  const planned = Math.abs(piece[8]) / 1e6, curved = piece[kManner] === 2 ||
    film.tracks[piece[5]].points_um_urad.length > 8;
  const steps = curved ? Math.ceil(planned / (piece[kManner] === 2 ? 0.1 : 0.25)) + 1 : 1;
  piece.hull = [];
  for (let i = 0; i <= steps; ++i) piece.hull.push(boxOf(piece, poseAfter(piece, planned * i / steps), 0));
  return piece.hull;
};

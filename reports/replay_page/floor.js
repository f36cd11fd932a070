// The floor: map, bodies, perimeters, hulls, beliefs and messages at one instant, to scale.
const floor = document.getElementById('floor');
const view = {x_m: 0, y_m: 0, scale: 20};  // the middle of the canvas; pixels for a metre
let colours = {};
const kColours = ['ink', 'soft', 'floor', 'grid', 'lane', 'station', 'agv', 'agv-line', 'hot', 'hot-line', 'thing',
                  'load', 'hull', 'ghost', 'wait',
                  'message', 'bad', 'accent', 'paper', 'line', 'drive', 'turn', 'transfer',
                  'charge', 'other', 'panel', 'kind-0', 'kind-1', 'kind-2', 'kind-3', 'kind-4', 'kind-5'];
const readColours = () => {
  const style = getComputedStyle(document.documentElement);
  colours = Object.fromEntries(kColours.map(name => [name, style.getPropertyValue('--' + name).trim()]));
};

// A canvas as large as its place on the page, in CSS pixels.
const contextOf = (canvas, width, height) => {
  const ratio = window.devicePixelRatio || 1;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const context = canvas.getContext('2d');
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return context;
};
const toX = x_m => floor.clientWidth / 2 + (x_m - view.x_m) * view.scale;
const toY = y_m => floor.clientHeight / 2 - (y_m - view.y_m) * view.scale;
const toFloor = (x, y) => [view.x_m + (x - floor.clientWidth / 2) / view.scale,
                           view.y_m - (y - floor.clientHeight / 2) / view.scale];

const fitTo = (low, high) => {
  view.x_m = (low[0] + high[0]) / 2;
  view.y_m = (low[1] + high[1]) / 2;
  view.scale = Math.min((floor.clientWidth - 60) / Math.max(1, high[0] - low[0]),
                        (floor.clientHeight - 50) / Math.max(1, high[1] - low[1]));
};
const wholeFloor = () => {
  const [x0, y0, x1, y1] = film.floor_um, antennas = film.bodies.filter(body => body.x_um !== undefined);
  const xs = [x0, x1, ...antennas.map(body => body.x_um)], ys = [y0, y1, ...antennas.map(body => body.y_um)];
  fitTo([Math.min(...xs) / 1e6 - 1, Math.min(...ys) / 1e6 - 1], [Math.max(...xs) / 1e6 + 1, Math.max(...ys) / 1e6 + 1]);
};

// Names that cover none before them, and no body if there is room beside it. What finds no place is left out.
const makeLabels = (context, bodies) => {
  const width = floor.clientWidth, height = floor.clientHeight;
  const taken = [[width - 250, 0, width, 44], [0, 0, 38, height], [0, height - 18, width, height]];  // buttons and axes
  const meets = (box, others) => others.some(t => t[0] < box[2] && box[0] < t[2] && t[1] < box[3] && box[1] < t[3]);
  return (text, x, y, colour, bold) => {
    context.font = (bold ? '600 ' : '') + '11px system-ui, sans-serif';
    const half = context.measureText(text).width / 2 + 2, middle = [];
    for (const [dx, dy] of [[0, 0], [half + 14, 4], [-half - 14, 4], [0, 15], [0, -15], [half + 14, 19],
                            [-half - 14, 19], [half + 14, -11], [-half - 14, -11], [half + 40, 4], [-half - 40, 4]]) {
      const cx = Math.min(Math.max(x + dx, half + 40), width - half - 4), cy = y + dy;
      middle.push({cx, cy, box: [cx - half, cy - 10, cx + half, cy + 3]});
    }
    const free = middle.filter(({box}) => !meets(box, taken));
    const place = free.find(({box}) => !meets(box, bodies)) || (bold ? free[0] : undefined);
    if (!place) return;
    taken.push(place.box);
    context.textAlign = 'center';
    context.lineWidth = 3;
    context.strokeStyle = colours.floor;
    context.strokeText(text, place.cx, place.cy);
    context.fillStyle = colour;
    context.fillText(text, place.cx, place.cy);
  };
};

const drawAxes = context => {
  const width = floor.clientWidth, height = floor.clientHeight;
  const step_m = [1, 2, 5, 10, 20, 50, 100, 200, 500].find(step => step * view.scale >= 55) || 1000;
  const [left_m, top_m] = toFloor(0, 0), [right_m, bottom_m] = toFloor(width, height);
  context.font = '11px system-ui, sans-serif';
  context.lineWidth = 1;
  context.strokeStyle = colours.grid;
  context.beginPath();
  for (let x = Math.ceil(left_m / step_m) * step_m; x <= right_m; x += step_m) {
    context.moveTo(toX(x), 0);
    context.lineTo(toX(x), height);
  }
  for (let y = Math.ceil(bottom_m / step_m) * step_m; y <= top_m; y += step_m) {
    context.moveTo(0, toY(y));
    context.lineTo(width, toY(y));
  }
  context.stroke();
  return () => {  // above all else
    const write = (text, x, y) => {
      context.strokeText(text, x, y);
      context.fillText(text, x, y);
    };
    context.fillStyle = colours.soft;
    context.strokeStyle = colours.floor;
    context.lineWidth = 3;
    context.font = '11px system-ui, sans-serif';
    context.textAlign = 'center';
    for (let x = Math.ceil(left_m / step_m) * step_m; x <= right_m; x += step_m) {
      if (toX(x) > 40 && toX(x) < width - 10) write(x + ' m', toX(x), height - 5);
    }
    context.textAlign = 'left';
    for (let y = Math.ceil(bottom_m / step_m) * step_m; y <= top_m; y += step_m) {
      if (toY(y) > 14 && toY(y) < height - 18) write(y + ' m', 5, toY(y) + 4);
    }
  };
};

const trackPath = context => {
  context.beginPath();
  for (const {points_um_urad: points} of film.tracks) {
    context.moveTo(toX(points[0] / 1e6), toY(points[1] / 1e6));
    for (let i = 4; i < points.length; i += 4) context.lineTo(toX(points[i] / 1e6), toY(points[i + 1] / 1e6));
  }
};
const drawMap = (context, label, names) => {
  trackPath(context);
  context.strokeStyle = colours.lane;
  context.lineWidth = 1.5;
  context.stroke();
  context.fillStyle = colours.station;
  const half = Math.max(1.5, Math.min(4, view.scale * 0.1));
  for (const station of film.stations) {
    const x = toX(station.x_um / 1e6), y = toY(station.y_um / 1e6);
    context.fillRect(x - half, y - half, 2 * half, 2 * half);
  }
  return () => {
    if (!names || view.scale < 7) return;
    for (const station of film.stations) {
      const x = toX(station.x_um / 1e6), y = toY(station.y_um / 1e6);
      if (x > 0 && y > 0 && x < floor.clientWidth && y < floor.clientHeight)
        label(station.name, x, y + half + 11, colours.soft, false);
    }
  };
};

const boxPath = (context, box) => {
  cornersOf(box).forEach(([x, y], i) => (i ? context.lineTo(toX(x), toY(y)) : context.moveTo(toX(x), toY(y))));
  context.closePath();
};
// All within `margin_m` of the box: its sides moved out, its corners round.
const roundedPath = (context, box, margin_m) => {
  const r = margin_m * view.scale, corners = cornersOf(box).map(([x, y]) => [toX(x), toY(y)]);
  corners.forEach(([x, y], i) => {
    const [px, py] = corners[(i + 3) % 4], out = Math.atan2(x - px, py - y);  // away from the side before this corner
    if (i === 0) context.moveTo(x + r * Math.cos(out), y + r * Math.sin(out));
    context.arc(x, y, r, out, out - Math.PI / 2, true);
  });
  context.closePath();
};

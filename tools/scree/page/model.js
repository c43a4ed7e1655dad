'use strict';
// What the page knows: the lists with their obstacles, the ground, health and truth. Metres, seconds
// from the report's begin, radians; `odom` with x up and y to the left on the map.

/** An obstacle of a list from its row. */
function obstacleOf(row) {
  const [id, kind, confidence, center, extent, yaw, height, vx, vy, points, evidence, corners] = row;
  const outline = [];
  for (let i = 0; i < corners.length; i += 2) outline.push([corners[i], corners[i + 1]]);
  return {
    id, kind, confidence, center, extent, yaw, height, velocity: [vx, vy], points, evidence, outline,
    moves: vx !== 0 || vy !== 0,
  };
}

/** An obstacle as `scree watch --json` prints it. */
function obstacleOfJson(json) {
  const [x, y] = json.center;
  const [c, s] = [Math.cos(json.yaw), Math.sin(json.yaw)];
  const box = [[1, -1], [1, 1], [-1, 1], [-1, -1]].map(([a, b]) => {
    const [u, v] = [a * json.extent[0] / 2, b * json.extent[1] / 2];
    return [x + c * u - s * v, y + s * u + c * v];
  });
  const velocity = json.velocity || [0, 0];
  return {
    ...json, kind: json.kind === 'positive' ? 1 : -1, velocity, evidence: json.evidence || '',
    outline: json.footprint || box, moves: velocity[0] !== 0 || velocity[1] !== 0,
  };
}

function yawOf([w, x, y, z]) {
  return Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

/** A point of a child frame (position p, rotation q) in its parent. */
function placed(p, q, x, y, z) {
  const [w, a, b, c] = q;
  const [tx, ty, tz] = [2 * (b * z - c * y), 2 * (c * x - a * z), 2 * (a * y - b * x)];
  return [p[0] + x + w * tx + b * tz - c * ty, p[1] + y + w * ty + c * tx - a * tz,
          p[2] + z + w * tz + a * ty - b * tx];
}

const wordOf = (obstacle) => obstacle.kind < 0 ? 'hole' : obstacle.moves ? 'mover' : 'rock';
const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

/** Of base64. */
function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflated(text) {
  const stream = new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).arrayBuffer();
}

/** The report that stands in the page. */
async function readReport(text) {
  const buffer = await inflated(text);
  const length = new DataView(buffer).getUint32(0, true);
  const report = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const bytes = ([begin, size]) => buffer.slice(4 + length + begin, 4 + length + begin + size);
  for (const list of report.lists) {
    list.obstacles = list.obstacles.map(obstacleOf);
    list.yaw = yawOf(list.q);
  }
  report.grids.forEach((grid) => { grid.state = new Uint8Array(bytes(grid.state)); });
  if (report.ground) report.ground.heights = heightsOf(new Int16Array(bytes(report.ground.heights)));
  unpackSweeps(report, bytes);
  report.tracks = tracksOf(report.lists);
  return report;
}

function heightsOf(hundredths) {
  return Float32Array.from(hundredths, (h) => h === -32768 ? NaN : h / 100);
}

function unpackSweeps(report, bytes) {
  const { lists, counts, x, y, z } = report.sweeps;
  const [xs, ys, zs] = [x, y, z].map((place) => new Int16Array(bytes(place)));
  let begin = 0;
  lists.forEach((list, i) => {
    const end = begin + counts[i];
    report.lists[list].sweep = { x: xs.subarray(begin, end), y: ys.subarray(begin, end), z: zs.subarray(begin, end) };
    begin = end;
  });
}

/** The history of each obstacle, by its id: where it stands in the lists. */
function tracksOf(lists) {
  const tracks = new Map();
  lists.forEach((list, number) => {
    for (const obstacle of list.obstacles) {
      if (!tracks.has(obstacle.id)) tracks.set(obstacle.id, { id: obstacle.id, lists: [], seen: [] });
      const track = tracks.get(obstacle.id);
      track.lists.push(number);
      track.seen.push(obstacle);
    }
  });
  for (const track of tracks.values()) {
    track.first = lists[track.lists[0]];
    track.last = lists[track.lists[track.lists.length - 1]];
    track.distance = distance(track.seen[0].center, track.first.p);
    track.nearest = Math.min(...track.lists.map((n, i) => distance(track.seen[i].center, lists[n].p)));
    track.latest = track.seen[track.seen.length - 1];
  }
  return tracks;
}

/** The last of sorted items at or before a time; -1 before the first. */
function indexAt(items, t, timeOf = (item) => item.t) {
  let [low, high] = [0, items.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (timeOf(items[middle]) <= t) low = middle + 1; else high = middle;
  }
  return low - 1;
}

function wayOf(lists) {
  let way = 0;
  for (let i = 1; i < lists.length; ++i) way += distance(lists[i].p, lists[i - 1].p);
  return way;
}

/** Truth's obstacles where they are at a list, in the frame of the list. */
function truthAt(report, list) {
  if (!report.truth || !list.truth) return [];
  const [x, y, yaw] = list.truth;
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  const moved = (p) => [x + c * p[0] - s * p[1], y + s * p[0] + c * p[1]];
  return (report.truth.obstacles || []).map((obstacle) => {
    const there = trackShift(obstacle, list.t);
    return { ...obstacle, outline: obstacle.outline.map((p) => moved(there(p))), center: moved(there(obstacle.center)) };
  });
}

/** How a true obstacle that moves has moved since its first place. */
function trackShift(obstacle, t) {
  if (!obstacle.track) return (p) => p;
  const track = obstacle.track;
  const i = Math.max(0, indexAt(track, t, (place) => place[0]));
  const [a, b] = [track[i], track[Math.min(i + 1, track.length - 1)]];
  const share = b[0] > a[0] ? Math.min(1, Math.max(0, (t - a[0]) / (b[0] - a[0]))) : 0;
  const turn = Math.atan2(Math.sin(b[3] - a[3]), Math.cos(b[3] - a[3]));
  const [x, y, yaw] = [a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]), a[3] + share * turn - track[0][3]];
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  return (p) => {
    const [u, v] = [p[0] - track[0][1], p[1] - track[0][2]];
    return [x + c * u - s * v, y + s * u + c * v];
  };
}

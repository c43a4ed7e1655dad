'use strict';
// The live page: what screed says now, over server-sent events.

/** The cells of a grid of `scree view`: rows as "2?3." */
function gridOf(json) {
  const state = new Uint8Array(json.columns * json.rows);
  let next = 0;
  for (const row of json.states) {
    for (const [, count, sign] of row.matchAll(/(\d*)([?.#v])/g)) {
      const end = next + (count === '' ? 1 : Number(count));
      state.fill('?.#v'.indexOf(sign), next, end);
      next = end;
    }
  }
  return { ...json, cell: json.cell_size, state };
}

/** Times of the latest events, for their rate. */
class Rate {
  constructor() { this.times = []; }
  see() {
    const now = performance.now();
    this.times.push(now);
    this.times = this.times.filter((time) => time > now - 3000);
  }
  perSecond() {
    const now = performance.now();
    return this.times.filter((time) => time > now - 3000).length / 3;
  }
  age() { return this.times.length ? (performance.now() - this.times[this.times.length - 1]) / 1000 : Infinity; }
}

class Live {
  constructor() {
    this.trail = [];
    this.pickedId = null;
    this.tab = 'Now';
    this.rates = { list: new Rate(), health: new Rate() };
  }

  // What the map asks for.
  list() { return this.latest; }
  lists() { return this.trail; }
  number() { return this.trail.length - 1; }
  ground() { return this.image; }
  grid() { return this.latestGrid; }
  stop() { return this.zone; }
  chosen() { return this.pickedId; }

  start() {
    document.body.classList.add('live');
    document.getElementById('title').textContent = 'Scree, live';
    this.map = new MapView(document.getElementById('map'), this);
    this.map.onPick = (obstacle) => { this.pickedId = obstacle ? obstacle.id : null; this.fillPanel(); this.map.redraw(); };
    this.map.fit([-12, -12, 12, 12]);
    this.map.shown.unknown = true;
    fillLayers(this.map, ['truth', 'past', 'sweep']);
    document.getElementById('follow').checked = this.map.follow = true;
    fillLegend(document.getElementById('legend'), false);
    fillTabs(['Now', 'Health'], (tab) => { this.tab = tab; this.fillPanel(); });
    this.connect();
    setInterval(() => this.tick(), 250);
  }

  connect() {
    const source = new EventSource('events' + location.search);
    const hear = (kind, take) => source.addEventListener(kind, (event) => take(JSON.parse(event.data)));
    hear('hello', (hello) => { this.zone = hello.stop; this.isConnected = true; });
    hear('list', (json) => this.takeList(json));
    hear('grid', (json) => this.takeGrid(json));
    hear('health', (json) => this.takeHealth(json));
    source.addEventListener('error', () => { this.isConnected = false; });
  }

  takeList(json) {
    const { pose, obstacles, stamp_ns: stamp } = json;
    const list = { stamp, p: pose.p, q: pose.q, yaw: yawOf(pose.q), obstacles: obstacles.map(obstacleOfJson) };
    if (this.latest && (stamp < this.latest.stamp || distance(list.p, this.latest.p) > 3)) this.beginAnew();
    this.latest = list;
    this.rates.list.see();
    const before = this.trail[this.trail.length - 1];
    if (!before || distance(before.p, list.p) > 0.05) this.trail.push({ p: list.p });
    if (this.trail.length > 5000) this.trail.shift();
    this.map.redraw();
    if (this.tab === 'Now') this.fillPanel();
  }

  /** `odom` began anew: screed was started again, or another drive is replayed. */
  beginAnew() {
    this.trail = [];
    this.live = this.image = this.latestGrid = null;
  }

  takeGrid(json) {
    const grid = gridOf(json);
    this.latestGrid = grid;
    if (!this.live || Math.abs(this.live.cell - grid.cell) > 1e-6) this.live = new LiveGround(grid.cell);
    this.live.add(grid);
    this.image = this.live.drawn();
    this.map.redraw();
  }

  takeHealth(health) {
    this.health = health;
    this.rates.health.see();
    if (this.tab === 'Health') this.fillPanel();
  }

  /** What is true of now, worst first. */
  state() {
    if (!this.isConnected) return ['bad', 'No connection to scree view'];
    if (this.rates.health.age() > 2.5) return ['bad', 'screed says nothing: what is shown is old'];
    if (this.health.health !== 'ok') return ['bad', `BLIND: ${this.health.reason}`];
    if (this.rates.list.age() > 0.5) return ['bad', 'The lists are stale'];
    if (this.health.stop) return ['bad', 'STOP: an obstacle is in the zone'];
    return ['ok', 'OK'];
  }

  tick() {
    const [className, words] = this.state();
    const state = document.getElementById('state');
    if (state.textContent !== words) Object.assign(state, { textContent: words, className });
    const figures = [
      [this.rates.list.perSecond().toFixed(1), 'lists a second'], [this.latest ? this.latest.obstacles.length : '–', 'obstacles'],
      [this.health ? `${short(this.health.latency.p50_ms)} ms` : '–', 'latency'], [this.health ? this.health.lists_published : '–', 'lists in all'],
    ];
    document.getElementById('figures').innerHTML = figures.map(([value, text]) => `<span><b>${value}</b> ${text}</span>`).join('');
  }

  fillPanel() {
    const nodes = this.tab === 'Now'
      ? nowTable(this.latest, this.pickedId, (it) => { this.pickedId = it.id; this.map.redraw(); this.fillPanel(); })
      : this.healthNodes();
    document.getElementById('panel').replaceChildren(...nodes);
  }

  healthNodes() {
    const { health } = this;
    if (!health) return [hint('No health yet: does screed run, and with the same lcm.url?', 'empty')];
    const said = (value, digits = 1) => typeof value === 'number' ? value.toFixed(digits) : '–';
    const sensors = ['lidar', 'imu', 'encoder'].map((name) => {
      const it = health[name];
      return { cells: [name, it.state, said(it.rate), it.lost, it.clock] };
    });
    const rows = [
      ['latency p50, p99', `${said(health.latency.p50_ms)}, ${said(health.latency.p99_ms)} ms`],
      ['detector p50, p99', `${said(health.detector_time.p50_ms)}, ${said(health.detector_time.p99_ms)} ms`],
      ['position known to', `${said(health.position_deviation, 3)} m`], ['sweeps, dropped', `${health.sweeps}, ${health.sweeps_dropped}`],
      ['wheel slipped in', `${health.sweeps_slipped} sweeps`], ['processor', `${said(health.processor_temperature)} °C`], ['version', health.version],
    ].map((cells) => ({ cells }));
    const wrong = [...health.setup, health.lines_problem].filter(Boolean).map((text) => ({ cells: [text] }));
    return [
      heading('Sensors'), table(['', 'state', 'a second', 'lost', 'clock'], sensors), heading('Computer'), table(['', ''], rows),
      ...(wrong.length ? [heading('To be set right'), table([''], wrong, 'words')] : []),
    ];
  }
}

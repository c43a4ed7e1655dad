'use strict';
// The page of a report: a slider through time moves everything.

class Report {
  constructor(report) {
    this.report = report;
    this.now = 0;
    this.pickedId = null;
    this.tab = 'Now';
    this.image = report.ground ? drawnGround(report.ground) : null;
    this.span = this.timeSpan();
  }

  // What the map asks for.
  list() { return this.report.lists[this.now]; }
  lists() { return this.report.lists; }
  number() { return this.now; }
  ground() { return this.image; }
  stop() { return this.report.stop; }
  chosen() { return this.pickedId; }
  truth(list) { return truthAt(this.report, list); }
  past() { return [...this.report.tracks.values()].map((track) => track.latest); }
  grid() {
    const at = indexAt(this.report.grids, this.list().t);
    return at < 0 ? null : this.report.grids[at];
  }

  timeSpan() {
    const { lists, health } = this.report;
    const times = [lists[0].t, lists[lists.length - 1].t, ...health.events.flatMap((it) => [it.from, it.to])];
    return [Math.min(...times), Math.max(...times)];
  }

  bounds() {
    const all = this.report.lists.flatMap((list) => [list.p, ...list.obstacles.map((it) => it.center)]);
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    for (const [x, y] of all) {
      [box[0], box[1]] = [Math.min(box[0], x), Math.min(box[1], y)];
      [box[2], box[3]] = [Math.max(box[2], x), Math.max(box[3], y)];
    }
    return [box[0] - 2, box[1] - 2, box[2] + 2, box[3] + 2];
  }

  start() {
    const { report } = this;
    document.getElementById('title').textContent = report.title;
    this.map = new MapView(document.getElementById('map'), this);
    this.map.onPick = (obstacle) => this.pick(obstacle);
    this.map.fit(this.bounds());
    const has = { truth: report.truth, unknown: report.grids.length, ground: report.ground, stop: report.stop, sweep: report.sweeps.lists.length };
    fillLayers(this.map, Object.keys(has).filter((layer) => !has[layer]));
    fillLegend(document.getElementById('legend'), Boolean(report.truth));
    this.charts = [...countSeries(report.lists), ...report.health.series].map(
      (series) => new Chart(series, this.span, report.health.events, (t) => this.goTo(t)));
    this.fillFigures();
    fillTabs(['Now', 'Obstacles', ...(report.truth ? ['Truth'] : []), 'Health'], (tab) => { this.tab = tab; this.fillPanel(); });
    this.listen();
    this.show(0);
  }

  listen() {
    const slider = document.getElementById('slider');
    slider.max = this.report.lists.length - 1;
    slider.addEventListener('input', () => this.show(Number(slider.value)));
    document.getElementById('play').addEventListener('click', () => this.play(!this.playing));
    document.getElementById('back').addEventListener('click', () => this.show(this.now - 1));
    document.getElementById('on').addEventListener('click', () => this.show(this.now + 1));
    new ResizeObserver(() => { drawMarks(document.getElementById('marks'), this.report.lists, this.report.health.events); this.drawCharts(); })
      .observe(document.getElementById('track'));
    document.addEventListener('keydown', (event) => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (['INPUT', 'SELECT'].includes(event.target.tagName) && event.target.type !== 'checkbox') return;
    const act = {
      ArrowLeft: () => this.show(this.now - (event.shiftKey ? 10 : 1)),
      ArrowRight: () => this.show(this.now + (event.shiftKey ? 10 : 1)),
      Home: () => this.show(0),
      End: () => this.show(this.report.lists.length - 1),
      ' ': () => this.play(!this.playing),
      0: () => document.getElementById('fit').click(),
      f: () => document.getElementById('follow').click(),
    }[event.key];
    const isPressed = event.key === ' ' && ['BUTTON', 'INPUT'].includes(event.target.tagName);
    if (!act || isPressed) return;
    event.preventDefault();
    act();
  }

  play(isOn) {
    this.playing = isOn;
    document.getElementById('play').textContent = isOn ? '❚❚ Pause' : '▶ Play';
    if (!isOn) return;
    const { lists } = this.report;
    if (this.now === lists.length - 1) this.show(0);
    let [before, t] = [performance.now(), lists[this.now].t];
    const step = (time) => {
      if (!this.playing) return;
      t += (time - before) / 1000 * Number(document.getElementById('speed').value);
      before = time;
      const at = Math.max(0, indexAt(lists, t));
      if (at !== this.now) this.show(at);
      if (at === lists.length - 1) this.play(false); else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  show(number) {
    this.now = Math.min(this.report.lists.length - 1, Math.max(0, number));
    const list = this.list();
    document.getElementById('slider').value = this.now;
    document.getElementById('clock').textContent =
      `${list.t.toFixed(2)} s · list ${this.now + 1} of ${this.report.lists.length} · ${timeOfDay(this.report, list.t)}`;
    this.sayState(list.t);
    this.map.redraw();
    if (this.tab === 'Now') this.fillPanel(); else this.drawCharts();
  }

  goTo(t) { this.show(Math.max(0, indexAt(this.report.lists, t + 1e-6))); }

  /** What was blind or wrong at this time. */
  sayState(t) {
    const events = this.report.health.events.filter((it) => it.from <= t && t <= it.to && ['blind', 'setup'].includes(it.kind));
    const state = document.getElementById('state');
    state.textContent = events.map((it) => `${it.kind}: ${it.text}`).join(' · ');
    state.className = events.length ? 'bad' : '';
  }

  pick(obstacle) {
    this.pickedId = obstacle ? obstacle.id : null;
    this.map.redraw();
    this.fillPanel();
  }

  /** Shows a list with one of its obstacles, or of the truth's, in the middle. */
  goToObstacle(number, id, isTrue) {
    this.pickedId = isTrue ? null : id;
    this.show(number);
    const all = isTrue ? this.truth(this.list()) : this.list().obstacles;
    const found = all.find((it) => it.id === id);
    if (found) {
      document.getElementById('follow').checked = this.map.follow = false;
      [this.map.view.x, this.map.view.y] = found.center;
      this.map.view.scale = Math.max(this.map.view.scale, 45);
      this.map.redraw();
    }
    this.fillPanel();
  }

  fillPanel() {
    const { report } = this;
    const nodes = {
      Now: () => [...nowTable(this.list(), this.pickedId, (it) => this.pick(it)), ...this.historyOfPicked()],
      Obstacles: () => historyTable(report.tracks, this.pickedId, (id, number) => this.goToObstacle(number, id, false)),
      Truth: () => truthTables(report, (number, id, isTrue) => this.goToObstacle(number, id, isTrue)),
      Health: () => [...healthTables(report.health, (t) => this.goTo(t)), heading('Along the way'), ...this.charts.map((it) => it.canvas)],
    }[this.tab]();
    const panel = document.getElementById('panel');
    const top = panel.scrollTop;
    panel.replaceChildren(...nodes);
    panel.scrollTop = panel.dataset.tab === this.tab ? top : 0;
    panel.dataset.tab = this.tab;
    this.drawCharts();
  }

  drawCharts() {
    const now = this.list().t;
    if (this.tab === 'Health') this.charts.forEach((chart) => chart.draw(now));
    this.pickedCharts?.forEach((chart) => chart.canvas.isConnected && chart.draw(now));
  }

  /** How the chosen obstacle looked from list to list. */
  historyOfPicked() {
    const track = this.report.tracks.get(this.pickedId);
    if (!track) return [hint('Click on an obstacle, on the map or in the list, for its history.')];
    const { lists } = this.report;
    const t = track.lists.map((n) => lists[n].t);
    const of = (name, unit, value) => new Chart({ name, unit, t, v: track.seen.map(value) }, [t[0], t[t.length - 1]], [], (time) => this.goTo(time));
    this.pickedCharts = [
      of('height', 'm', (it) => it.height), of('confidence', '', (it) => it.confidence),
      of('distance', 'm', (it, i) => distance(it.center, lists[track.lists[i]].p)),
    ];
    const words = `In ${track.lists.length} lists, from ${t[0].toFixed(1)} to ${t[t.length - 1].toFixed(1)} s. First told at ${track.distance.toFixed(1)} m, nearest ${track.nearest.toFixed(1)} m.`;
    return [heading(`Obstacle ${track.id}`), hint(words), ...this.pickedCharts.map((it) => it.canvas)];
  }

  fillFigures() {
    const { report } = this;
    const blind = report.health.events.filter((it) => it.kind === 'blind').reduce((sum, it) => sum + it.to - it.from, 0);
    const figures = [
      [`${(this.span[1] - this.span[0]).toFixed(1)} s`, 'long'], [`${wayOf(report.lists).toFixed(1)} m`, 'driven'],
      [report.lists.length, 'lists'], [report.tracks.size, 'obstacles'], [`${blind.toFixed(1)} s`, 'blind'],
    ];
    const all = report.truth?.score.all;
    if (all) figures.push([all.f1 === null ? '–' : all.f1.toFixed(3), report.truth.score.counts ? 'F1' : 'F1, does not count']);
    document.getElementById('figures').replaceChildren(...figures.map(([value, words]) => {
      const span = document.createElement('span');
      span.append(Object.assign(document.createElement('b'), { textContent: value }), ` ${words}`);
      return span;
    }));
  }
}

function timeOfDay(report, t) {
  return new Date(Number(BigInt(report.begin_ns) / 1000000n) + 1000 * t).toISOString().slice(0, 23).replace('T', ' ') + ' UTC';
}

/** How many obstacles each list has. */
function countSeries(lists) {
  const t = lists.map((list) => list.t);
  const gap = lists.map((list, i) => i === 0 ? 0 : 1000 * (list.t - lists[i - 1].t));
  return [{ name: 'obstacles in a list', unit: '', t, v: lists.map((list) => list.obstacles.length) },
          { name: 'from list to list', unit: 'ms', t, v: gap }];
}

function fillLayers(map, without) {
  const box = document.getElementById('layers');
  for (const [key, words] of LAYERS) {
    if (without.includes(key)) continue;
    const label = document.createElement('label');
    const input = Object.assign(document.createElement('input'), { type: 'checkbox', checked: map.shown[key], id: `layer-${key}` });
    input.addEventListener('change', () => { map.shown[key] = input.checked; map.redraw(); });
    label.append(input, ` ${words}`);
    box.append(label);
  }
  const follow = document.getElementById('follow');
  follow.addEventListener('change', () => { map.follow = follow.checked; map.redraw(); });
  map.onMove = () => { follow.checked = map.follow = false; };
  document.getElementById('fit').addEventListener('click', () => {
    follow.checked = map.follow = false;
    map.fit(map.bounds);
  });
}

function fillTabs(names, choose) {
  const tabs = document.getElementById('tabs');
  const buttons = names.map((name) => {
    const button = Object.assign(document.createElement('button'), { textContent: name, id: `tab-${name}` });
    button.setAttribute('role', 'tab');
    button.addEventListener('click', () => {
      buttons.forEach((it) => it.setAttribute('aria-selected', it === button));
      choose(name);
    });
    return button;
  });
  tabs.replaceChildren(...buttons);
  buttons[0].click();
}

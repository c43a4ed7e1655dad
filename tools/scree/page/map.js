'use strict';
// The map: x up, y to the left, as the robot sees it at its start.

const COLOURS = {
  rock: '#0072b2', hole: '#d55e00', mover: '#a03a78', robot: '#00765a', alarm: '#f0e442', ink: '#20222a',
};
const LAYERS = [
  ['ground', 'Ground'], ['unknown', 'Unknown now'], ['way', 'Way driven'], ['sweep', 'Sweep'],
  ['obstacles', 'Obstacles'], ['labels', 'Labels'], ['past', 'Obstacles of all lists'], ['stop', 'Stop zone'], ['truth', 'Truth'],
];

/** Where a place of `odom` lies on the canvas. */
class View {
  constructor() { Object.assign(this, { x: 0, y: 0, scale: 20, width: 1, height: 1 }); }
  across(y) { return this.width / 2 - (y - this.y) * this.scale; }
  down(x) { return this.height / 2 - (x - this.x) * this.scale; }
  at(px, py) { return [this.x - (py - this.height / 2) / this.scale, this.y - (px - this.width / 2) / this.scale]; }
  zoom(factor, px, py) {
    const before = this.at(px, py);
    this.scale = Math.min(400, Math.max(0.5, this.scale * factor));
    const after = this.at(px, py);
    this.x += before[0] - after[0];
    this.y += before[1] - after[1];
  }
  /** Shows a box of ground. */
  fit([x0, y0, x1, y1], margin = 1.08) {
    this.x = (x0 + x1) / 2;
    this.y = (y0 + y1) / 2;
    const [high, wide] = [Math.max(8, x1 - x0) * margin, Math.max(8, y1 - y0) * margin];
    this.scale = Math.min(this.height / high, this.width / wide);
  }
}

class MapView {
  /** @param scene gives what is to be drawn: see Report and Live */
  constructor(canvas, scene) {
    this.canvas = canvas;
    this.scene = scene;
    this.view = new View();
    this.shown = { ground: true, unknown: false, way: true, sweep: true, obstacles: true, labels: true, past: false, stop: true, truth: true };
    this.follow = false;
    this.onPick = () => {};
    this.tip = document.getElementById('tip');
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.listen();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(clientWidth * ratio);
    this.canvas.height = Math.round(clientHeight * ratio);
    const isFirst = this.view.width === 1;
    Object.assign(this.view, { width: clientWidth, height: clientHeight, ratio });
    if (isFirst && this.bounds) this.view.fit(this.bounds);
    this.redraw();
  }

  redraw() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.draw();
    });
  }

  fit(bounds) {
    this.bounds = bounds;
    this.view.fit(bounds);
    this.redraw();
  }

  listen() {
    const canvas = this.canvas;
    let held = null;
    canvas.addEventListener('pointerdown', (event) => {
      held = { x: event.offsetX, y: event.offsetY, moved: false };
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener('pointermove', (event) => {
      if (!held) return this.hover(event.offsetX, event.offsetY);
      const [dx, dy] = [event.offsetX - held.x, event.offsetY - held.y];
      if (!held.moved && Math.hypot(dx, dy) < 4) return;
      this.view.y += dx / this.view.scale;
      this.view.x += dy / this.view.scale;
      held = { x: event.offsetX, y: event.offsetY, moved: true };
      this.onMove?.();
      this.redraw();
    });
    canvas.addEventListener('pointerup', (event) => {
      if (held && !held.moved) this.onPick(this.obstacleAt(event.offsetX, event.offsetY));
      held = null;
    });
    canvas.addEventListener('pointerleave', () => { this.tip.hidden = true; });
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.view.zoom(Math.exp(-event.deltaY * 0.0015), event.offsetX, event.offsetY);
      this.redraw();
    }, { passive: false });
  }

  obstacleAt(px, py) {
    const [x, y] = this.view.at(px, py);
    const near = (obstacle) => Math.max(0.15, obstacle.extent[0] / 2, obstacle.extent[1] / 2) + 4 / this.view.scale;
    const list = this.scene.list();
    const hits = (list ? list.obstacles : []).filter((it) => distance(it.center, [x, y]) < near(it));
    return hits.sort((a, b) => distance(a.center, [x, y]) - distance(b.center, [x, y]))[0] || null;
  }

  hover(px, py) {
    const obstacle = this.obstacleAt(px, py);
    this.tip.hidden = !obstacle;
    this.canvas.style.cursor = obstacle ? 'pointer' : 'grab';
    if (!obstacle) return;
    this.tip.textContent = describe(obstacle, this.scene.list());
    this.tip.style.left = `${Math.min(px + 14, this.view.width - 250)}px`;
    this.tip.style.top = `${Math.min(py + 14, this.view.height - 130)}px`;
  }

  draw() {
    const { view, shown, scene } = this;
    const context = this.canvas.getContext('2d');
    const list = scene.list();
    if (this.follow && list) [view.x, view.y] = list.p;
    context.setTransform(view.ratio || 1, 0, 0, view.ratio || 1, 0, 0);
    context.fillStyle = '#ffffff';
    context.fillRect(0, 0, view.width, view.height);
    hatch(context, view);
    if (shown.ground) drawGround(context, view, scene.ground());
    if (shown.unknown) drawUnknown(context, view, scene.grid());
    drawMetres(context, view);
    if (shown.past) scene.past?.().forEach((it) => outlined(context, view, it.outline, COLOURS[wordOf(it)], { width: 1, fill: 0.06 }));
    if (shown.way) drawWay(context, view, scene);
    if (list) this.drawList(context, list);
    drawScale(context, view);
  }

  drawList(context, list) {
    const { view, shown, scene } = this;
    if (shown.sweep && list.sweep) drawSweep(context, view, list);
    if (shown.stop) drawStop(context, view, list, scene.stop());
    if (shown.truth) drawTruth(context, view, list, scene.truth?.(list) || []);
    if (shown.obstacles) list.obstacles.forEach((it) => drawObstacle(context, view, it, list, scene.chosen()));
    drawRobot(context, view, list);
    if (shown.labels && shown.obstacles) drawLabels(context, view, list);
  }
}

function describe(obstacle, list) {
  const way = distance(obstacle.center, list.p);
  const lines = [
    `${obstacle.id}: ${obstacle.kind > 0 ? 'positive' : 'negative'}${obstacle.moves ? ', moves' : ''}`,
    `${obstacle.height > 0 ? '' : '−'}${Math.abs(obstacle.height).toFixed(2)} m ${obstacle.kind > 0 ? 'above' : 'below'} the ground`,
    `${obstacle.extent[0].toFixed(2)} × ${obstacle.extent[1].toFixed(2)} m, ${way.toFixed(1)} m from the robot`,
    `confidence ${obstacle.confidence.toFixed(2)}, ${obstacle.points} points`,
  ];
  if (obstacle.moves) lines.push(`${Math.hypot(...obstacle.velocity).toFixed(2)} m/s`);
  if (obstacle.evidence && obstacle.evidence !== 'none') lines.push(`evidence: ${obstacle.evidence}`);
  if (list.invented?.includes(obstacle.id)) lines.push('invented: the truth has nothing there');
  return lines.join('\n');
}

/** Background of what was never seen. */
function hatch(context, view) {
  context.fillStyle = '#eceef1';
  context.fillRect(0, 0, view.width, view.height);
  context.strokeStyle = '#dfe2e7';
  context.lineWidth = 1;
  context.beginPath();
  for (let i = -view.height; i < view.width; i += 9) {
    context.moveTo(i, view.height);
    context.lineTo(i + view.height, 0);
  }
  context.stroke();
}

function drawGround(context, view, ground) {
  if (!ground) return;
  context.imageSmoothingEnabled = view.scale * 0.1 < 6;
  const [left, top] = [view.across(ground.y + ground.height), view.down(ground.x + ground.width)];
  context.drawImage(ground.image, left, top, ground.height * view.scale, ground.width * view.scale);
}

/** Cells of the grid that are not known, tinted. */
function drawUnknown(context, view, grid) {
  if (!grid) return;
  grid.image ||= unknownImage(grid);
  context.imageSmoothingEnabled = false;
  const [left, top] = [view.across(grid.origin[1] + grid.rows * grid.cell), view.down(grid.origin[0] + grid.columns * grid.cell)];
  context.drawImage(grid.image, left, top, grid.rows * grid.cell * view.scale, grid.columns * grid.cell * view.scale);
}

function unknownImage({ state, columns, rows }) {
  const image = new ImageData(rows, columns);
  const pixels = new Uint32Array(image.data.buffer);
  const tint = 0x425a143c; // red 60, green 20, blue 90, a quarter opaque
  state.forEach((cell, i) => {
    if (cell === 0) pixels[(columns - 1 - i % columns) * rows + rows - 1 - Math.floor(i / columns)] = tint;
  });
  return canvasOf(image);
}

/** 1, 2 or 5 times a power of ten, at least so long. */
function roundLength(least) {
  const decade = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((factor) => factor * decade).find((length) => length >= least * 0.999);
}

function drawMetres(context, view) {
  const step = roundLength(90 / view.scale);
  const [x1, y1] = view.at(0, 0);
  const [x0, y0] = view.at(view.width, view.height);
  context.strokeStyle = 'rgba(40, 80, 120, 0.16)';
  context.fillStyle = '#4a4f5c';
  context.font = '11px system-ui, "DejaVu Sans", sans-serif';
  context.lineWidth = 1;
  context.beginPath();
  for (let x = Math.ceil(x0 / step) * step; x <= x1; x += step) {
    context.moveTo(0, view.down(x));
    context.lineTo(view.width, view.down(x));
    context.fillText(`x ${+x.toFixed(2)}`, view.width - 44, view.down(x) - 3);
  }
  for (let y = Math.ceil(y0 / step) * step; y <= y1; y += step) {
    context.moveTo(view.across(y), 0);
    context.lineTo(view.across(y), view.height);
    context.fillText(`y ${+y.toFixed(2)}`, view.across(y) + 3, 12);
  }
  context.stroke();
}

function drawScale(context, view) {
  const length = roundLength(70 / view.scale);
  const [right, bottom] = [view.width - 64, view.height - 18];
  const left = right - length * view.scale;
  context.strokeStyle = context.fillStyle = COLOURS.ink;
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(left, bottom - 5);
  context.lineTo(left, bottom);
  context.lineTo(right, bottom);
  context.lineTo(right, bottom - 5);
  context.stroke();
  context.textAlign = 'center';
  context.fillText(`${length} m`, (left + right) / 2, bottom - 5);
  context.textAlign = 'left';
}

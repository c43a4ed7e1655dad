'use strict';
// What stands on the map: way, sweep, obstacles, truth, robot.

function path(context, view, outline) {
  context.beginPath();
  outline.forEach(([x, y], i) => context[i === 0 ? 'moveTo' : 'lineTo'](view.across(y), view.down(x)));
  context.closePath();
}

function outlined(context, view, outline, colour, { width = 2, fill = 0.18, dash = [] } = {}) {
  path(context, view, outline);
  context.globalAlpha = fill;
  context.fillStyle = colour;
  context.fill();
  context.globalAlpha = 1;
  context.setLineDash(dash);
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke();
  context.setLineDash([]);
}

function drawWay(context, view, scene) {
  const lists = scene.lists();
  const now = scene.number();
  const draw = (from, to, colour, width) => {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    for (let i = from; i <= to; ++i) context[i === from ? 'moveTo' : 'lineTo'](view.across(lists[i].p[1]), view.down(lists[i].p[0]));
    context.stroke();
  };
  draw(0, lists.length - 1, 'rgba(0, 118, 90, 0.35)', 2);
  draw(0, now, COLOURS.robot, 2.5);
}

function drawSweep(context, view, list) {
  const { x, y, z } = list.sweep;
  context.fillStyle = 'rgba(20, 90, 80, 0.75)';
  const size = Math.min(3, Math.max(1.2, view.scale * 0.05));
  for (let i = 0; i < x.length; ++i) {
    const [px, py] = placed(list.p, list.q, x[i] / 100, y[i] / 100, z[i] / 100);
    context.fillRect(view.across(py) - size / 2, view.down(px) - size / 2, size, size);
  }
}

/** A place in `base`, seen from above in `odom`. */
function ahead(list, x, y) {
  const [c, s] = [Math.cos(list.yaw), Math.sin(list.yaw)];
  return [list.p[0] + c * x - s * y, list.p[1] + s * x + c * y];
}

function drawStop(context, view, list, stop) {
  if (!stop) return;
  const { length, width } = stop;
  const zone = [[0, width / 2], [length, width / 2], [length, -width / 2], [0, -width / 2]].map(([x, y]) => ahead(list, x, y));
  outlined(context, view, zone, '#6b5a00', { width: 1.5, fill: 0.12, dash: [5, 4] });
}

function drawRobot(context, view, list) {
  const size = Math.max(0.35, 11 / view.scale);
  const arrow = [[1.2, 0], [-0.9, 0.8], [-0.5, 0], [-0.9, -0.8]].map(([x, y]) => ahead(list, x * size, y * size));
  path(context, view, arrow);
  context.fillStyle = COLOURS.robot;
  context.fill();
  context.strokeStyle = '#ffffff';
  context.lineWidth = 1.5;
  context.stroke();
}

function drawObstacle(context, view, obstacle, list, chosen) {
  const colour = COLOURS[wordOf(obstacle)];
  const isInvented = list.invented?.includes(obstacle.id);
  if (isInvented) outlined(context, view, obstacle.outline, COLOURS.alarm, { width: 7, fill: 0.3 });
  if (obstacle.id === chosen) outlined(context, view, obstacle.outline, '#000000', { width: 6, fill: 0 });
  outlined(context, view, obstacle.outline, colour, { width: obstacle.id === chosen ? 3 : 2, fill: 0.2 });
  if (obstacle.moves) drawVelocity(context, view, obstacle, colour);
}

/** Where it will be in a second. */
function drawVelocity(context, view, obstacle, colour) {
  const [x, y] = obstacle.center;
  const [px, py] = [view.across(y), view.down(x)];
  const [qx, qy] = [view.across(y + obstacle.velocity[1]), view.down(x + obstacle.velocity[0])];
  const angle = Math.atan2(qy - py, qx - px);
  context.strokeStyle = context.fillStyle = colour;
  context.lineWidth = 2.5;
  context.beginPath();
  context.moveTo(px, py);
  context.lineTo(qx, qy);
  context.stroke();
  context.beginPath();
  context.moveTo(qx + 7 * Math.cos(angle), qy + 7 * Math.sin(angle));
  for (const turn of [2.4, -2.4]) context.lineTo(qx + 7 * Math.cos(angle + turn), qy + 7 * Math.sin(angle + turn));
  context.fill();
}

function drawTruth(context, view, list, truth) {
  for (const obstacle of truth) {
    const isMissed = list.missed?.includes(obstacle.id);
    if (isMissed) outlined(context, view, obstacle.outline, '#ffffff', { width: 6, fill: 0 });
    outlined(context, view, obstacle.outline, '#000000', { width: isMissed ? 3 : 1.2, fill: 0, dash: isMissed ? [] : [3, 3] });
    if (!isMissed) continue;
    const [px, py] = [view.across(obstacle.center[1]), view.down(obstacle.center[0])];
    context.strokeStyle = '#000000';
    context.lineWidth = 2.5;
    context.beginPath();
    context.moveTo(px - 6, py - 6);
    context.lineTo(px + 6, py + 6);
    context.moveTo(px + 6, py - 6);
    context.lineTo(px - 6, py + 6);
    context.stroke();
  }
}

/** Each label beside its obstacle; one that would cover another is left out. */
function drawLabels(context, view, list) {
  context.font = '600 12px system-ui, "DejaVu Sans", sans-serif';
  const taken = [];
  for (const obstacle of list.obstacles) {
    const text = `${obstacle.id}: ${obstacle.height < 0 ? '−' : '+'}${Math.abs(obstacle.height).toFixed(2)}`;
    const width = context.measureText(text).width;
    const right = Math.max(...obstacle.outline.map(([, y]) => view.across(y)));
    const top = Math.min(...obstacle.outline.map(([x]) => view.down(x)));
    const box = [right + 3, top - 4, right + 3 + width, top + 10];
    if (taken.some((it) => box[0] < it[2] && it[0] < box[2] && box[1] < it[3] && it[1] < box[3])) continue;
    taken.push(box);
    context.strokeStyle = 'rgba(255, 255, 255, 0.9)';
    context.lineWidth = 3.5;
    context.strokeText(text, box[0], box[3] - 2);
    context.fillStyle = COLOURS[wordOf(obstacle)];
    context.fillText(text, box[0], box[3] - 2);
  }
}

/** What the signs of the map mean. */
function fillLegend(element, hasTruth) {
  const box = (colour, more = '') => `<svg width="22" height="14"><rect x="2" y="2" width="18" height="10" fill="${colour}" fill-opacity="0.2" stroke="${colour}" stroke-width="2" ${more}/></svg>`;
  const rows = [
    [box(COLOURS.rock), 'positive (rock)'], [box(COLOURS.hole), 'negative (hole, edge)'],
    [box(COLOURS.mover), 'moves; arrow: one second'],
    ['<svg width="22" height="14"><path d="M11 1 L17 13 L11 10 L5 13Z" fill="#00765a"/></svg>', 'robot and its way'],
    ['<svg width="22" height="14"><rect x="2" y="2" width="18" height="10" fill="#eceef1" stroke="#b6bac4"/><path d="M4 12L12 2M10 12L18 2" stroke="#c9cdd6"/></svg>', 'never seen'],
    ['<svg width="22" height="14"><rect x="2" y="2" width="18" height="10" fill="rgba(60,20,90,0.26)"/></svg>', 'unknown now (layer)'],
  ];
  if (hasTruth) {
    rows.push([box('#000000', 'fill-opacity="0" stroke-dasharray="3 3" stroke-width="1.2"'), 'truth']);
    rows.push(['<svg width="22" height="14"><rect x="2" y="2" width="18" height="10" fill="none" stroke="#000" stroke-width="2.5"/><path d="M8 4L14 10M14 4L8 10" stroke="#000" stroke-width="2"/></svg>', 'missed now']);
    rows.push([`<svg width="22" height="14"><rect x="2" y="2" width="18" height="10" fill="none" stroke="${COLOURS.alarm}" stroke-width="4"/></svg>`, 'invented now (yellow rim)']);
  }
  element.innerHTML = rows.map(([sign, words]) => `<div>${sign}<span>${words}</span></div>`).join('');
}

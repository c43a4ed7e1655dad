'use strict';
// Numbers along the way, and the marks over the slider.

function prepared(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const context = canvas.getContext('2d');
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { context, width, height };
}

const short = (value) => {
  const size = Math.abs(value);
  return size >= 1000 ? value.toFixed(0) : size >= 10 ? +value.toFixed(1) + '' : +value.toPrecision(3) + '';
};

/** One series over time, with a cursor. Bounds of time are those of the whole report. */
class Chart {
  constructor(series, span, events, onTime) {
    Object.assign(this, { series, span, events });
    this.canvas = document.createElement('canvas');
    this.canvas.setAttribute('aria-label', series.name);
    this.canvas.addEventListener('click', (event) => {
      const share = (event.offsetX - Chart.LEFT) / (this.canvas.clientWidth - Chart.LEFT - 6);
      onTime(span[0] + share * (span[1] - span[0]));
    });
  }

  draw(now) {
    const { context, width, height } = prepared(this.canvas);
    const { t, v, name, unit } = this.series;
    const high = Math.max(...v, 0), low = Math.min(...v, 0);
    const range = high - low || 1;
    const across = (time) => Chart.LEFT + (time - this.span[0]) / (this.span[1] - this.span[0] || 1) * (width - Chart.LEFT - 6);
    const down = (value) => height - 8 - (value - low) / range * (height - 32);
    context.font = '12px system-ui, "DejaVu Sans", sans-serif';
    this.drawBlind(context, across, height);
    context.fillStyle = '#666a75';
    context.fillText(short(high), 0, down(high) + 4);
    context.fillText(short(low), 0, down(low) + 3);
    context.strokeStyle = '#d9dbe1';
    context.strokeRect(Chart.LEFT, down(high), width - Chart.LEFT - 6, down(low) - down(high));
    context.strokeStyle = COLOURS.rock;
    context.lineWidth = 1.4;
    context.beginPath();
    t.forEach((time, i) => context[i === 0 ? 'moveTo' : 'lineTo'](across(time), down(v[i])));
    context.stroke();
    context.fillStyle = COLOURS.ink;
    const at = indexAt(t, now, (time) => time);
    const value = at >= 0 ? `${short(v[at])}${unit ? ' ' + unit : ''}` : '';
    context.fillText(name, Chart.LEFT, 13);
    context.textAlign = 'right';
    context.fillText(value, width - 6, 13);
    context.fillRect(across(now) - 0.75, 18, 1.5, height - 24);
  }

  drawBlind(context, across, height) {
    context.fillStyle = 'rgba(240, 228, 66, 0.55)';
    for (const event of this.events) {
      if (event.kind !== 'blind') continue;
      context.fillRect(across(event.from), 20, Math.max(2, across(event.to) - across(event.from)), height - 28);
    }
  }
}
Chart.LEFT = 46;

/** Over the slider: when it was blind, what contradicted the settings, what was missed and invented. */
function drawMarks(canvas, lists, events) {
  const { context, width, height } = prepared(canvas);
  if (lists.length < 2) return;
  const pad = 8;
  const end = lists[lists.length - 1].t, begin = lists[0].t;
  const across = (t) => pad + Math.min(1, Math.max(0, (t - begin) / (end - begin || 1))) * (width - 2 * pad);
  for (const event of events) {
    const [from, to] = [across(event.from), across(event.to)];
    if (event.kind === 'blind') {
      context.fillStyle = COLOURS.alarm;
      context.fillRect(from, 0, Math.max(3, to - from), height);
      context.strokeStyle = '#000';
      context.strokeRect(from, 0.5, Math.max(3, to - from), height - 1);
    } else if (event.kind === 'setup') {
      context.fillStyle = COLOURS.mover;
      context.fillRect(from, height - 4, Math.max(3, to - from), 4);
    }
  }
  const most = Math.max(1, ...lists.map((list) => (list.missed?.length || 0)), ...lists.map((list) => list.invented?.length || 0));
  const wide = Math.max(1, (width - 2 * pad) / lists.length);
  lists.forEach((list) => {
    const draw = (count, colour, isUp) => {
      if (!count) return;
      const tall = Math.max(2, (height / 2) * count / most);
      context.fillStyle = colour;
      context.fillRect(across(list.t) - wide / 2, isUp ? height / 2 - tall : height / 2, wide, tall);
    };
    draw(list.missed?.length, '#000000', true);
    draw(list.invented?.length, COLOURS.hole, false);
  });
}

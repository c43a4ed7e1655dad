'use strict';
// The hillshade, as draw/height_raster.cpp draws it: lit from the upper left, deeper is darker.

/** The mean within `radius` cells of each cell; NaN where nothing is known. */
function smoothed(heights, columns, rows, radius) {
  const stride = columns + 1;
  const sums = new Float64Array(stride * (rows + 1));
  const counts = new Int32Array(stride * (rows + 1));
  for (let row = 0; row < rows; ++row) {
    let [sum, count] = [0, 0];
    for (let column = 0; column < columns; ++column) {
      const height = heights[row * columns + column];
      if (height === height) { sum += height; ++count; }
      const at = (row + 1) * stride + column + 1;
      sums[at] = sums[at - stride] + sum;
      counts[at] = counts[at - stride] + count;
    }
  }
  const means = new Float32Array(columns * rows);
  for (let row = 0; row < rows; ++row) {
    const [below, above] = [Math.max(0, row - radius) * stride, Math.min(rows, row + radius + 1) * stride];
    for (let column = 0; column < columns; ++column) {
      const [left, right] = [Math.max(0, column - radius), Math.min(columns, column + radius + 1)];
      const count = counts[above + right] - counts[above + left] - counts[below + right] + counts[below + left];
      const sum = sums[above + right] - sums[above + left] - sums[below + right] + sums[below + left];
      means[row * columns + column] = count > 0 ? sum / count : NaN;
    }
  }
  return means;
}

/** How many cells away a height has a part in the brightness. */
const reachOfShade = (cell) => Math.max(1, Math.round(0.8 / cell));

/** Brightness of each cell, 0 to 1; NaN where nothing is known. */
function hillshade(heights, columns, rows, cell) {
  const around = smoothed(heights, columns, rows, reachOfShade(cell));
  const bright = new Float32Array(columns * rows).fill(NaN);
  for (let row = 0; row < rows; ++row) {
    const [up, down] = [row + 1 < rows ? columns : 0, row > 0 ? columns : 0];
    for (let column = 0; column < columns; ++column) {
      const i = row * columns + column;
      const height = heights[i];
      if (height !== height) continue;
      const of = (k) => heights[k] === heights[k] ? heights[k] : height;
      const slopeX = (of(column + 1 < columns ? i + 1 : i) - of(column > 0 ? i - 1 : i)) / (2 * cell);
      const slopeY = (of(i + up) - of(i - down)) / (2 * cell);
      const lit = (-0.5 * slopeX - 0.5 * slopeY + 0.7071) / Math.sqrt(1 + slopeX * slopeX + slopeY * slopeY);
      const relief = Math.min(0.15, Math.max(-0.5, 0.9 * (height - around[i])));
      bright[i] = Math.min(1, Math.max(0.05, 0.2 + 0.85 * Math.max(0, lit) + relief));
    }
  }
  return bright;
}

/** A picture of brightness, x up and y to the left. */
function pictureOf(bright, columns, rows) {
  const image = new ImageData(rows, columns);
  const pixels = new Uint32Array(image.data.buffer);
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const value = bright[row * columns + column];
      if (value !== value) continue;
      const grey = Math.round(255 * value);
      pixels[(columns - 1 - column) * rows + rows - 1 - row] = 0xff000000 | grey << 16 | grey << 8 | grey;
    }
  }
  return image;
}

const newCanvas = (width, height) => Object.assign(document.createElement('canvas'), { width, height });

function canvasOf(picture) {
  const canvas = newCanvas(picture.width, picture.height);
  canvas.getContext('2d').putImageData(picture, 0, 0);
  return canvas;
}

/** The ground of a report, ready to be drawn. */
function drawnGround(ground) {
  const { x, y, cell, columns, rows, heights } = ground;
  const image = canvasOf(pictureOf(hillshade(heights, columns, rows, cell), columns, rows));
  return { x, y, width: columns * cell, height: rows * cell, image };
}

/** The ground that grids tell while they come: as many metres around the robot as `reach`. */
class LiveGround {
  constructor(cell, reach = 60) {
    this.cell = cell;
    this.size = Math.round(2 * reach / cell);
    this.heights = null;
    this.image = newCanvas(this.size, this.size);
  }

  /** Moves the area so that the robot is well inside; what is known stays. */
  center(x, y) {
    const half = this.size / 2;
    const [column, row] = [Math.round(x / this.cell) - half, Math.round(y / this.cell) - half];
    if (this.heights && Math.abs(column - this.column) < half / 2 && Math.abs(row - this.row) < half / 2) return;
    const heights = new Float32Array(this.size * this.size).fill(NaN);
    if (this.heights) {
      for (let r = 0; r < this.size; ++r) {
        const from = r + row - this.row;
        if (from < 0 || from >= this.size) continue;
        for (let c = 0; c < this.size; ++c) {
          const at = c + column - this.column;
          if (at >= 0 && at < this.size) heights[r * this.size + c] = this.heights[from * this.size + at];
        }
      }
    }
    [this.heights, this.column, this.row] = [heights, column, row];
    this.shade(0, 0, this.size, this.size);
  }

  add(grid) {
    this.center(grid.pose.p[0], grid.pose.p[1]);
    const { size, heights } = this;
    const column = Math.round(grid.origin[0] / this.cell) - this.column;
    const row = Math.round(grid.origin[1] / this.cell) - this.row;
    let next = 0;
    grid.state.forEach((state, i) => {
      if (state === 0) return;
      const height = grid.pose.p[2] + grid.ground[next++] / 100;
      const [c, r] = [column + i % grid.columns, row + Math.floor(i / grid.columns)];
      if (c >= 0 && c < size && r >= 0 && r < size) heights[r * size + c] = height;
    });
    this.shade(column, row, grid.columns, grid.rows);
  }

  /** Draws anew what has changed with the heights of these cells. */
  shade(column, row, columns, rows) {
    const { size, heights, cell } = this;
    const reach = reachOfShade(cell);
    const within = (at) => Math.min(size, Math.max(0, at));
    const span = (begin, count, margin) => [within(begin - margin), within(begin + count + margin)];
    const [[left, right], [below, above]] = [span(column, columns, reach), span(row, rows, reach)];
    // What lies around has a part in it.
    const [[c0, c1], [r0, r1]] = [span(column, columns, 2 * reach), span(row, rows, 2 * reach)];
    if (left === right || below === above) return;
    const part = new Float32Array((c1 - c0) * (r1 - r0));
    for (let r = r0; r < r1; ++r) part.set(heights.subarray(r * size + c0, r * size + c1), (r - r0) * (c1 - c0));
    const picture = pictureOf(hillshade(part, c1 - c0, r1 - r0, cell), c1 - c0, r1 - r0);
    this.image.getContext('2d').putImageData(
      picture, size - r1, size - c1, r1 - above, c1 - right, above - below, right - left);
  }

  drawn() {
    const metres = this.size * this.cell;
    return { x: this.column * this.cell, y: this.row * this.cell, width: metres, height: metres, image: this.image };
  }
}

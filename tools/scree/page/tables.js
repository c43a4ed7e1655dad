'use strict';
// Tables of the panel. Each row that leads somewhere is a click away from it.

const signed = (value) => `${value < 0 ? '−' : '+'}${Math.abs(value).toFixed(2)}`;
const kindCell = (word) => ({ text: { rock: '▲ rock', hole: '▼ hole', mover: '▶ moves' }[word], className: word });

/** @param columns names; rows: { cells, go, key } */
function table(columns, rows, className = '') {
  const element = document.createElement('table');
  element.className = className;
  const head = element.createTHead().insertRow();
  for (const column of columns) head.appendChild(Object.assign(document.createElement('th'), { textContent: column }));
  const body = element.createTBody();
  for (const row of rows) {
    const line = body.insertRow();
    for (const cell of row.cells) {
      const isPlain = typeof cell !== 'object' || cell === null;
      const td = line.insertCell();
      td.textContent = isPlain ? cell ?? '–' : cell.text;
      if (!isPlain) td.className = cell.className;
    }
    if (row.chosen) line.classList.add('chosen');
    if (!row.go) continue;
    line.classList.add('go');
    line.tabIndex = 0;
    line.addEventListener('click', row.go);
    line.addEventListener('keydown', (event) => { if (event.key === 'Enter') row.go(); });
  }
  return element;
}

const heading = (text) => Object.assign(document.createElement('h2'), { textContent: text });
const hint = (text, className = 'hint') => Object.assign(document.createElement('p'), { textContent: text, className });

/** The list at this time, nearest first. */
function nowTable(list, chosen, pick) {
  if (!list) return [hint('No list yet.', 'empty')];
  const rows = [...list.obstacles].sort((a, b) => distance(a.center, list.p) - distance(b.center, list.p)).map((it) => ({
    cells: [it.id, kindCell(wordOf(it)), distance(it.center, list.p).toFixed(1), signed(it.height),
            `${it.extent[0].toFixed(1)}×${it.extent[1].toFixed(1)}`, it.confidence.toFixed(2)],
    chosen: it.id === chosen,
    go: () => pick(it),
  }));
  const nodes = [heading(`List of ${list.obstacles.length} obstacle${list.obstacles.length === 1 ? '' : 's'}`)];
  if (rows.length === 0) nodes.push(hint('Looked, and nothing there.', 'empty'));
  else nodes.push(table(['id', 'kind', 'away m', 'height m', 'size m', 'conf.'], rows));
  return nodes;
}

/** Every obstacle with its history. */
function historyTable(tracks, chosen, go) {
  const rows = [...tracks.values()].sort((a, b) => a.first.t - b.first.t).map((track) => ({
    cells: [track.id, kindCell(wordOf(track.latest)), signed(track.latest.height), track.first.t.toFixed(1), track.distance.toFixed(1),
            track.nearest.toFixed(1), track.lists.length],
    chosen: track.id === chosen,
    go: () => go(track.id, track.lists[0]),
  }));
  return [hint('Each obstacle by its id, in the order of its first list. A click goes there.'),
          table(['id', 'kind', 'height m', 'first s', 'at m', 'nearest m', 'lists'], rows)];
}

/** What the truth says was missed or invented, the worst first. */
function truthTables(report, go) {
  const { asked, invented } = judged(report);
  const score = report.truth.score;
  const missed = [...asked.values()].filter((it) => it.missed > 0).sort((a, b) => b.missed - a.missed);
  const percent = (value) => value === null || value === undefined ? '–' : value.toFixed(3);
  const covered = Math.floor(100 * score.coverage);
  const doubt = score.counts ? [] : [hint(`The lists cover ${covered} % of the drive: this score does not count.`)];
  const scores = ['all', 'positive', 'negative'].filter((kind) => score[kind]).map((kind) => ({
    cells: [kind, percent(score[kind].f1), percent(score[kind].precision), percent(score[kind].recall),
            score[kind].true_positives, score[kind].false_positives, score[kind].false_negatives],
  }));
  const missedRows = missed.map((it) => ({
    cells: [it.id, kindCell(it.kind > 0 ? 'rock' : 'hole'), it.shape || '–', signed(it.height), `${it.missed} of ${it.asked}`, it.range.toFixed(1)],
    go: () => go(it.list, it.id, true),
  }));
  const inventedRows = [...invented.values()].sort((a, b) => b.count - a.count).map((it) => ({
    cells: [it.id, kindCell(it.word), signed(it.height), it.count, it.t.toFixed(1), it.range.toFixed(1)],
    go: () => go(it.list, it.id, false),
  }));
  return [
    heading('Score'), ...doubt, table(['', 'F1', 'precision', 'recall', 'right', 'invented', 'missed'], scores),
    heading(`Missed: ${missed.length} of ${asked.size} that were asked for`),
    missedRows.length ? table(['id', 'kind', 'shape', 'height m', 'lists missed', 'at m'], missedRows) : hint('None.', 'empty'),
    heading(`Invented: ${invented.size}`),
    inventedRows.length ? table(['id', 'kind', 'height m', 'lists', 'first s', 'at m'], inventedRows) : hint('None.', 'empty'),
  ];
}

/** How each true obstacle fared, and each detection that is a false positive. */
function judged(report) {
  const [asked, invented] = [new Map(), new Map()];
  const truths = new Map((report.truth.obstacles || []).map((it) => [it.id, it]));
  report.lists.forEach((list, number) => {
    if (!list.truth) return;
    const there = new Map(list.missed.length ? truthAt(report, list).map((it) => [it.id, it]) : []);
    const entry = (id) => {
      if (!asked.has(id)) asked.set(id, { ...truths.get(id), asked: 0, missed: 0 });
      return asked.get(id);
    };
    list.right.forEach(([id]) => { ++entry(id).asked; });
    for (const id of list.missed) {
      const it = entry(id);
      ++it.asked;
      if (it.missed++ === 0) Object.assign(it, { list: number, range: distance(there.get(id).center, list.p) });
    }
    for (const id of list.invented) {
      const seen = list.obstacles.find((it) => it.id === id);
      if (!invented.has(id)) invented.set(id, { id, word: wordOf(seen), height: seen.height, list: number, t: list.t, range: distance(seen.center, list.p), count: 0 });
      ++invented.get(id).count;
    }
  });
  return { asked, invented };
}

/** What happened when, and what was counted. */
function healthTables(health, goTo) {
  const rows = health.events.map((event) => ({
    cells: [event.kind, `${event.from.toFixed(1)} – ${event.to.toFixed(1)}`, event.text],
    go: () => goTo(event.from),
  }));
  const notes = health.notes.map(([what, value]) => ({ cells: [what, value] }));
  const nodes = [heading('What happened')];
  nodes.push(rows.length ? table(['', 'seconds', ''], rows, 'words') : hint('Nothing: never blind, nothing contradicts the settings.', 'empty'));
  if (notes.length) nodes.push(heading('Counted'), table(['', ''], notes, 'words'));
  return nodes;
}

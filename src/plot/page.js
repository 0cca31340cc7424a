"use strict";
/* The waveforms of `run`: a Dygraph for each panel, all with one range. Whatever the number of rows,
 * a graph is given few: of each pixel column the first, the last, and the lowest and highest of each
 * signal. */
const BLOCK = 256;  // rows whose extremes are known beforehand
const MAX_MARKS = 100;
const PREFIX = ["a", "f", "p", "n", "\u00b5", "m", "", "k", "M", "G", "T"];
const PALETTE = {
  light: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a52a3", "#5f6368"],
  dark: ["#56b4e9", "#e69f00", "#00b386", "#cc79a7", "#f0e442", "#ee7733", "#a890d8", "#bdc1c6"],
};

const by = (id) => document.getElementById(id);
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/* ---- Numbers ------------------------------------------------------------------------------- */

function quantity(value, unit, digits = 5) {
  if (!Number.isFinite(value)) return "\u2013";
  const plain = unit === "" || unit === "\u00b0" || unit === "dB" || /[\^ ]/.test(unit);
  const power = value === 0 || plain ? 0 : Math.floor(Math.log10(Math.abs(value) * (1 + 1e-12)) / 3);
  const rounded = Number(value.toPrecision(digits));
  if (plain && (Math.abs(rounded) >= 1e7 || (rounded !== 0 && Math.abs(rounded) < 1e-5))) {
    return `${rounded.toExponential()} ${unit}`.trim();
  }
  if (power < -6 || power > 4) return `${rounded.toExponential()} ${unit}`;
  const mantissa = Number((value / 1000 ** power).toPrecision(digits));
  return `${mantissa} ${PREFIX[power + 6]}${unit}`.trim();
}

/* As many digits as the range needs. */
function tick(value, unit, range) {
  const size = Math.abs(value) / Math.max(range, 1e-300);
  return quantity(Math.abs(value) < 1e-9 * range ? 0 : value, unit,
                  Math.min(12, 3 + Math.max(0, Math.ceil(Math.log10(size + 1)))));
}

/* ---- Data ---------------------------------------------------------------------------------- */

function decode(text, Type) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return new Type(bytes.buffer);
}

/* Where the lowest and the highest value of each block is. */
function findExtremes(value) {
  const n = Math.ceil(value.length / BLOCK);
  const low = new Uint32Array(n), high = new Uint32Array(n);
  for (let k = 0; k < n; k++) {
    const end = Math.min(value.length, (k + 1) * BLOCK);
    low[k] = high[k] = k * BLOCK;
    for (let i = k * BLOCK; i < end; i++) {
      if (value[i] < value[low[k]] || Number.isNaN(value[low[k]])) low[k] = i;
      if (value[i] > value[high[k]] || Number.isNaN(value[high[k]])) high[k] = i;
    }
  }
  return {low, high};
}

/* Of a sweep one run is shown; each is decoded when it is looked at first. */
const runs = [{at: run.at, signals: run.signals, bars: run.bars, jumps: run.jumps}, ...run.others];
let at, start, stop;
function choose(index) {
  const one = runs[index];
  if (one.values === undefined) {
    one.at = decode(one.at, Float64Array);
    one.values = one.signals.map(({values}) => decode(values, run.bits === 64 ? Float64Array : Float32Array));
    one.extremes = one.values.map(findExtremes);
    sumUp(one.bars, one.at[0]);
    for (const signal of one.signals) signal.values = null;
  }
  at = one.at;
  start = at[0];
  stop = at[at.length - 1];
  run.bars = one.bars;
  run.jumps = one.jumps;
  run.signals.forEach((signal, k) => {
    signal.value = one.values[k];
    signal.extremes = one.extremes[k];
  });
}
choose(0);

/* The first of ascending times at or behind one. */
function firstFrom(times, time) {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1; else high = middle;
  }
  return low;
}
const rowOf = (time) => firstFrom(at, time);

/* Adds the rows of the lowest and highest value among [from, end). */
function addExtremes(rows, signal, from, end) {
  const {value, extremes} = signal;
  let low = from, high = from;
  const look = (i) => {
    if (value[i] < value[low] || Number.isNaN(value[low])) low = i;
    if (value[i] > value[high] || Number.isNaN(value[high])) high = i;
  };
  for (let i = from; i < end;) {
    if (i % BLOCK === 0 && i + BLOCK <= end) {
      look(extremes.low[i / BLOCK]);
      look(extremes.high[i / BLOCK]);
      i += BLOCK;
    } else {
      look(i++);
    }
  }
  rows.push(low, high);
}

/* The rows that show all there is to see of some signals between two times. */
function chooseRows(signals, from, to, columns) {
  const first = Math.max(0, rowOf(from) - 1), end = Math.min(at.length, rowOf(to) + 2);
  if (end - first <= 4 * columns) return Array.from({length: end - first}, (_, i) => first + i);
  const chosen = [];
  let row = first;
  for (let k = 1; k <= columns && row < end; k++) {
    const next = k === columns ? end : Math.min(end, rowOf(place(from, to, k / columns)));
    if (next <= row) continue;
    const rows = [row, next - 1];
    for (const signal of signals) addExtremes(rows, signal, row, next);
    rows.sort((a, b) => a - b);
    for (const r of rows) if (chosen[chosen.length - 1] !== r) chosen.push(r);
    row = next;
  }
  return chosen;
}

/* A time by its part of the axis, and the other way round. */
const place = (from, to, part) =>
  run.axis.log ? from * (to / from) ** part : from + part * (to - from);
const partOf = (from, to, time) =>
  run.axis.log ? Math.log(time / from) / Math.log(to / from) : (time - from) / (to - from);

/* ---- What is shown ------------------------------------------------------------------------- */

const view = {from: start, to: stop, cursor: {a: null, b: null}, marks: run.marks};
const panels = run.panels.map((panel, index) => {
  const signals = run.signals.filter((signal) => signal.panel === index);
  signals.forEach((signal, k) => { signal.color = k % PALETTE.light.length; });
  return {...panel, signals, graph: null, box: null, title: null};
});
const theme = () => document.documentElement.dataset.theme;
const shownOf = (panel) => panel.signals.filter((signal) => signal.shown);

function rowsOf(panel) {
  const shown = shownOf(panel);
  const columns = Math.max(200, panel.box.clientWidth - 90);
  const data = chooseRows(shown, view.from, view.to, columns).map(
    (row) => [at[row], ...shown.map((signal) => signal.value[row])]);
  panel.n = data.length;
  return data;
}

/* The part of the axis where two columns lie on each other away from 0. */
function overlap(data, i, k, tolerance) {
  let sum = 0, before = false;
  data.forEach((row, r) => {
    const now = Math.abs(row[i] - row[k]) <= tolerance;
    const away = Math.max(Math.abs(row[i]), Math.abs((data[r - 1] ?? row)[i])) > tolerance;
    if (before && now && away) sum += row[0] - data[r - 1][0];
    before = now;
  });
  return sum / (view.to - view.from);
}

/* A curve that others lie on later is wider, so that its colour shows beside theirs. */
function widthsOf(data, n) {
  let low = Infinity, high = -Infinity;
  for (const row of data) {
    for (let i = 1; i <= n; i++) {
      if (row[i] < low) low = row[i];
      if (row[i] > high) high = row[i];
    }
  }
  return Array.from({length: n}, (_, i) => {
    let width = 1.5;
    for (let k = i + 2; k <= n && width < 4; k++) {
      if (overlap(data, i + 1, k, 1e-3 * (high - low)) > 0.02) width += 1.5;
    }
    return width;
  });
}

function optionsOf(panel) {
  const shown = shownOf(panel), data = rowsOf(panel);
  const labels = shown.map((signal, k) => `${k} ${signal.name}`);
  const widths = widthsOf(data, shown.length);
  return {
    file: data,
    labels: [run.axis.name, ...labels],
    series: Object.fromEntries(labels.map((label, k) => [label, {strokeWidth: widths[k]}])),
    colors: shown.map((signal) => PALETTE[theme()][signal.color]),
    dateWindow: [view.from, view.to],
    gridLineColor: css("--grid"),
    axisLineColor: css("--line"),
  };
}

let drawing = false;
function draw() {
  drawing = true;
  const used = panels.filter((panel) => shownOf(panel).length > 0);
  for (const panel of panels) {
    const visible = used.includes(panel);
    panel.box.hidden = panel.title.hidden = !visible;
    if (visible) panel.graph.updateOptions(optionsOf(panel));
  }
  drawing = false;
  drawBars(used[0]);
  by("range").textContent =
    `${quantity(view.from, run.axis.unit, 6)} to ${quantity(view.to, run.axis.unit, 6)}`;
  writeTable();
}

/* Shows the times from `from` to `to`, as far as there are any, in the next frame. */
let waiting = false;
function show(from, to) {
  from = Math.max(start, from);
  to = Math.min(stop, to);
  const least = 1e-12 * Math.max(Math.abs(start), Math.abs(stop));
  if (!(to - from > least)) return;
  view.from = from;
  view.to = to;
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => { waiting = false; draw(); });
}

function showAll() {
  for (const panel of panels) panel.graph.updateOptions({valueRange: null}, true);
  show(start, stop);
}

/* ---- Lines and bars ------------------------------------------------------------------------ */

function line(context, area, x, color, dash) {
  context.strokeStyle = color;
  context.setLineDash(dash);
  context.beginPath();
  context.moveTo(x, area.y);
  context.lineTo(x, area.y + area.h);
  context.stroke();
}

/* A level of one panel, or a place of the axis; its text is in one panel. */
function drawLine(context, area, graph, mark, index, here) {
  context.fillStyle = css("--text");
  if (mark.level) {
    const y = Math.round(graph.toDomYCoord(mark.at)) + 0.5;
    if (!here || y < area.y || y > area.y + area.h) return;
    context.strokeStyle = css("--text");
    context.setLineDash([4, 4]);
    context.beginPath();
    context.moveTo(area.x, y);
    context.lineTo(area.x + area.w, y);
    context.stroke();
  } else if (mark.at >= view.from && mark.at <= view.to) {
    const x = Math.round(area.x + area.w * partOf(view.from, view.to, mark.at)) + 0.5;
    line(context, area, x, css("--text"), [4, 4]);
    context.textAlign = x > area.x + area.w / 2 ? "right" : "left";
    const beside = context.textAlign === "right" ? -5 : 5;
    if (here) context.fillText(mark.text, x + beside, area.y + 14 + 14 * (index % 3));
  }
}

function drawUnderlay(context, area, graph, panel) {
  const xOf = (time) => Math.round(area.x + area.w * partOf(view.from, view.to, time)) + 0.5;
  const visible = (time) => time >= view.from && time <= view.to;
  context.save();
  context.lineWidth = 1;
  if (view.marks) {
    const events = run.bars.flatMap((bar) => bar.times).filter(visible);
    if (events.length <= MAX_MARKS) {
      for (const time of events) line(context, area, xOf(time), css("--quiet"), [3, 3]);
    }
    for (const time of run.jumps.filter(visible)) line(context, area, xOf(time), css("--text"), []);
  }
  run.lines.forEach((mark, k) =>
    drawLine(context, area, graph, mark, k, mark.panel === panels.indexOf(panel)));
  for (const name of ["a", "b"]) {
    const time = view.cursor[name];
    if (time !== null && visible(time)) line(context, area, xOf(time), css(`--${name}`), []);
  }
  context.restore();
}

/* The time that a bar's element conducts before each of its changes. */
function sumUp(bars, from) {
  for (const bar of bars) {
    let sum = 0, since = from;
    bar.sums = bar.times.map((time, k) => {
      if (bar.on === (k % 2 === 0)) sum += time - since;
      since = time;
      return sum;
    });
  }
}

/* The same before any time. */
function conducted(bar, time) {
  const k = firstFrom(bar.times, time);
  const on = bar.on === (k % 2 === 0), since = k > 0 ? bar.times[k - 1] : start;
  return (k > 0 ? bar.sums[k - 1] : 0) + (on ? time - since : 0);
}

/* Where changes crowd, a bar's shade tells the part of the time in which the element conducts. */
function drawBars(panel) {
  const canvas = by("bars");
  canvas.hidden = run.bars.length === 0 || !panel;
  if (canvas.hidden) return;
  const area = panel.graph.getArea(), ratio = window.devicePixelRatio || 1, height = 20;
  const width = canvas.clientWidth;
  canvas.style.height = `${height * run.bars.length}px`;
  canvas.width = width * ratio;
  canvas.height = height * run.bars.length * ratio;
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  context.font = '12px "DejaVu Sans", sans-serif';
  context.textAlign = "right";
  context.textBaseline = "middle";
  run.bars.forEach((bar, k) => {
    context.globalAlpha = 1;
    context.fillStyle = css("--text");
    context.fillText(bar.name, area.x - 8, height * (k + 0.5), area.x - 10);
    context.fillStyle = css("--bar");
    let before = conducted(bar, view.from), time = view.from;
    for (let x = 0; x < area.w; x++) {
      const next = place(view.from, view.to, (x + 1) / area.w), sum = conducted(bar, next);
      const part = Math.min(1, (sum - before) / (next - time));
      context.globalAlpha = 0.25 + 0.75 * Math.max(0, part);
      if (part > 1e-9) context.fillRect(area.x + x, height * k + 3, 1, height - 6);
      before = sum;
      time = next;
    }
  });
}

/* ---- The read-out -------------------------------------------------------------------------- */

function valueAt(signal, time) {
  const row = rowOf(time);
  if (row === 0 || at[row] === time) return signal.value[Math.min(row, at.length - 1)];
  const part = (time - at[row - 1]) / (at[row] - at[row - 1]);
  return signal.value[row - 1] + part * (signal.value[row] - signal.value[row - 1]);
}

/* Of straight lines between rows: mean, rms, least and largest value. */
function between(signal, from, to) {
  let sum = 0, squares = 0, time = from, value = valueAt(signal, from), least = value, largest = value;
  const go = (next, other) => {
    sum += 0.5 * (next - time) * (other + value);
    squares += (next - time) * (value * value + value * other + other * other) / 3;
    least = Math.min(least, other);
    largest = Math.max(largest, other);
    time = next;
    value = other;
  };
  for (let row = rowOf(from); row < at.length && at[row] < to; row++) go(at[row], signal.value[row]);
  go(to, valueAt(signal, to));
  return [sum / (to - from), Math.sqrt(squares / (to - from)), least, largest];
}

function cell(row, text, kind = "td", name = "") {
  const made = document.createElement(kind);
  made.textContent = text;
  made.className = name;
  row.append(made);
}

function writeTable() {
  const {a, b} = view.cursor, table = by("cursors"), unit = run.axis.unit;
  const both = a !== null && b !== null && a !== b;
  table.replaceChildren();
  if (a === null) return;
  const head = table.insertRow();
  cell(head, run.axis.name, "th");
  cell(head, `A ${quantity(a, unit, 6)}`, "th", "a");
  if (b !== null) cell(head, `B ${quantity(b, unit, 6)}`, "th", "b");
  if (both) {
    const rate = unit === "s" ? ` (${quantity(1 / Math.abs(b - a), "Hz", 4)})` : "";
    cell(head, `B \u2212 A ${quantity(b - a, unit, 6)}${rate}`, "th");
    for (const name of ["mean", "rms", "min", "max"]) cell(head, name, "th");
  }
  for (const signal of run.signals.filter((one) => one.shown)) {
    const row = table.insertRow(), of = panels[signal.panel].unit;
    cell(row, signal.name);
    cell(row, quantity(valueAt(signal, a), of));
    if (b !== null) cell(row, quantity(valueAt(signal, b), of));
    if (both) {
      cell(row, quantity(valueAt(signal, b) - valueAt(signal, a), of));
      const found = between(signal, Math.min(a, b), Math.max(a, b));
      for (const value of found) cell(row, quantity(value, of));
    }
  }
}

/* ---- Setting up ---------------------------------------------------------------------------- */

function makeGraph(panel) {
  const unit = panel.unit;
  const model = {...Dygraph.defaultInteractionModel, dblclick: showAll};
  panel.graph = new Dygraph(panel.box, [[start, 0], [stop, 0]], {
    labels: [run.axis.name, "-"],
    legend: "never",
    interactionModel: model,
    highlightCircleSize: 0,
    yRangePad: 8,
    axes: {
      x: {
        logscale: run.axis.log,
        axisLabelFormatter: (value) => tick(value, run.axis.unit, view.to - view.from),
        axisLabelWidth: 90,
        pixelsPerLabel: 100,
      },
      y: {
        axisLabelFormatter: (value, granularity, options, graph) => {
          const [low, high] = graph.yAxisRange();
          return tick(value, unit, high - low);
        },
        axisLabelWidth: 76,
      },
    },
    underlayCallback: (context, area, graph) => drawUnderlay(context, area, graph, panel),
    drawCallback: (graph) => {
      const [from, to] = graph.xAxisRange();
      if (!drawing && (from !== view.from || to !== view.to)) show(from, to);
    },
    clickCallback: (event, time) => {
      view.cursor[event.shiftKey ? "b" : "a"] = Math.min(stop, Math.max(start, time));
      draw();
    },
  });
  panel.box.addEventListener("wheel", (event) => {
    const area = panel.graph.getArea();
    const part = (event.clientX - panel.box.getBoundingClientRect().left - area.x) / area.w;
    const factor = 1.2 ** Math.sign(event.deltaY);
    show(place(view.from, view.to, part * (1 - factor)),
         place(view.from, view.to, part + (1 - part) * factor));
    event.preventDefault();
  }, {passive: false});
}

function makeList() {
  panels.forEach((panel) => {
    const title = document.createElement("h2");
    title.textContent = panel.unit ? `${panel.quantity} (${panel.unit})` : panel.quantity;
    by("signals").append(title);
    for (const signal of panel.signals) {
      const label = document.createElement("label");
      const box = document.createElement("input"), swatch = document.createElement("span");
      box.type = "checkbox";
      box.checked = signal.shown;
      box.addEventListener("change", () => { signal.shown = box.checked; draw(); });
      swatch.className = "swatch";
      signal.swatch = swatch;
      label.append(box, swatch, signal.name);
      by("signals").append(label);
    }
  });
}

/* The slider of a sweep: another run in the same range, as far as it goes. */
function setUpRuns() {
  const slider = by("run");
  by("runs").hidden = runs.length < 2;
  slider.max = runs.length - 1;
  const change = () => {
    const whole = view.from === start && view.to === stop;
    choose(Number(slider.value));
    by("label").textContent = run.labels[slider.value];
    if (whole || !(Math.max(view.from, start) < Math.min(view.to, stop))) [view.from, view.to] = [start, stop];
    draw();
  };
  by("label").textContent = run.labels[0];
  slider.addEventListener("input", change);
}

function setTheme(name) {
  document.documentElement.dataset.theme = name;
  for (const signal of run.signals) {
    signal.swatch.style.background = PALETTE[name][signal.color];
  }
}

function setUp() {
  const room = window.innerHeight - 130 - 20 * run.bars.length;
  const height = Math.max(170, Math.min(460, room / panels.length - 20));
  for (const panel of panels) {
    panel.title = document.createElement("div");
    panel.title.className = "quantity";
    panel.title.textContent = panel.unit ? `${panel.quantity} (${panel.unit})` : panel.quantity;
    panel.box = document.createElement("div");
    panel.box.className = "panel";
    panel.box.style.height = `${height}px`;
    by("graphs").append(panel.title, panel.box);
    makeGraph(panel);
  }
  makeList();
  if (runs.length > 1) setUpRuns();
  setTheme(theme());
  by("marks").checked = view.marks;
  by("marks").addEventListener("change", () => { view.marks = by("marks").checked; draw(); });
  by("all").addEventListener("click", showAll);
  by("theme").addEventListener("click", () => {
    setTheme(theme() === "dark" ? "light" : "dark");
    draw();
  });
  window.addEventListener("resize", () => {
    for (const panel of panels) panel.graph.resize();
    draw();
  });
  draw();
  document.body.dataset.ready = "yes";
}

setUp();

// draw.js - pictures in SVG: curves over time, conduction bars, the plane of a pair.
'use strict';

const COLOURS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#000000', '#8a6d00'];
const WIDTH = 640, LEFT = 64, RIGHT = 12;
const PREFIXES = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'µ'], [1e-9, 'n'], [1e-12, 'p']];

const escapeText = (text) => text.replace(/[&<>"]/g, (c) => ({'&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;'}[c]));

/** [factor, prefix] with which the largest of these numbers is between 1 and 1000. */
function prefixFor(largest) {
    return PREFIXES.find(([factor]) => largest >= 0.9995 * factor) || [1, ''];
}

/** "4.7 mA" */
function quantity(value, unit, digits = 4) {
    const [factor, prefix] = prefixFor(Math.abs(value));
    return `${+(value / factor).toPrecision(digits)} ${prefix}${unit}`;
}

/** Round numbers from low to high, about `count` of them. */
function ticks(low, high, count) {
    const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
    const step = power * [1, 2, 5, 10].find((k) => k * power >= raw);
    const found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k * step);
    return found;
}

/** The range of some columns, with room above and below. */
function rangeOf(columns, keep) {
    let low = Infinity, high = -Infinity;
    for (const column of columns) {
        for (let k = 0; k < column.length; k++) {
            if (keep && !keep(k)) continue;
            if (column[k] < low) low = column[k];
            if (column[k] > high) high = column[k];
        }
    }
    if (!(low <= high)) return [0, 1];
    // what rounding leaves is 0
    if (high - low < 1e-9 * Math.max(Math.abs(low), Math.abs(high)) || Math.max(-low, high) < 1e-15) {
        const around = Math.max(Math.abs(high), 1e-12);
        return [Math.min(low, 0) - 0.1 * around, Math.max(high, 0) + 0.1 * around];
    }
    const room = 0.06 * (high - low);
    return [low - room, high + room];
}

/** The path of a curve between two times and a point beyond. Of each column of pixels the first, lowest, highest and
 *  last point are kept. */
function pathOf({time, value}, from, to, x, y) {
    let path = '', column = null, first = 0, last = 0, low = 0, high = 0;
    const point = (k) => `${path ? 'L' : 'M'}${x(time[k]).toFixed(1)} ${y(value[k]).toFixed(1)}`;
    const flush = () => {
        for (const k of [...new Set([first, low, high, last])].sort((a, b) => a - b)) path += point(k);
    };
    for (let k = 0; k < time.length; k++) {
        if (time[k + 1] < from || time[k - 1] > to) continue;
        const here = Math.floor(x(time[k]));
        if (here !== column) {
            if (column !== null) flush();
            column = here;
            first = last = low = high = k;
        }
        last = k;
        if (value[k] < value[low]) low = k;
        if (value[k] > value[high]) high = k;
    }
    if (column !== null) flush();
    return path;
}

const textAt = (x, y, anchor, text, more = '') =>
    `<text x="${x}" y="${y}" text-anchor="${anchor}" ${more}>${escapeText(text)}</text>`;

/** A panel: curves {name, unit, time, value, dashed} over time from `from` to `to`. */
function panel(curves, from, to, height = 170) {
    const inside = (curve) => (k) => curve.time[k] >= from && curve.time[k] <= to;
    const ranges = curves.map((curve) => rangeOf([curve.value], inside(curve)));
    const low = Math.min(...ranges.map((r) => r[0])), high = Math.max(...ranges.map((r) => r[1]));
    const x = (t) => LEFT + (WIDTH - LEFT - RIGHT) * (t - from) / (to - from);
    const y = (v) => height - 8 - (height - 30) * (v - low) / (high - low);
    const [factor, prefix] = prefixFor(Math.max(Math.abs(low), Math.abs(high)));
    let out = '';
    for (const tick of ticks(low / factor, high / factor, 4)) {
        const at = y(tick * factor).toFixed(1);
        out += `<path d="M${LEFT} ${at}H${WIDTH - RIGHT}" class="${Math.abs(tick) < 1e-9 ? 'zero' : 'grid'}"/>`;
        out += textAt(LEFT - 6, +at + 4, 'end', String(+tick.toPrecision(6)));
    }
    out += textAt(4, 14, 'start', prefix + curves[0].unit);
    curves.forEach((curve, k) => {
        const colour = COLOURS[(curve.colour === undefined ? k : curve.colour) % COLOURS.length];
        out += `<path d="${pathOf(curve, from, to, x, y)}" class="curve" stroke="${colour}"` +
            `${curve.dashed ? ' stroke-dasharray="5 4"' : ''} data-name="${escapeText(curve.name)}"/>`;
    });
    let at = LEFT;
    curves.forEach((curve, k) => {
        if (curve.dashed) return;
        out += textAt(at, 14, 'start', curve.name, `fill="${COLOURS[(curve.colour === undefined ? k : curve.colour) % COLOURS.length]}"`);
        at += 8 * curve.name.length + 16;
    });
    return frame(out, height);
}

function frame(inside, height) {
    return `<svg viewBox="0 0 ${WIDTH} ${height}" role="img"><clipPath id="inside"><rect x="${LEFT}" y="0" ` +
        `width="${WIDTH - LEFT - RIGHT}" height="${height}"/></clipPath>${inside}</svg>`;
}

/** A bar for each element: spans [[from, to], ...] in which it conducts; the time axis is below. */
function bars(elements, from, to) {
    const x = (t) => LEFT + (WIDTH - LEFT - RIGHT) * Math.min(1, Math.max(0, (t - from) / (to - from)));
    const [factor, prefix] = prefixFor(to);
    let out = '', at = 4;
    for (const {name, spans} of elements) {
        out += textAt(LEFT - 6, at + 10, 'end', name) + `<path d="M${LEFT} ${at + 6}H${WIDTH - RIGHT}" class="grid"/>`;
        for (const [start, end] of spans) {
            if (end < from || start > to) continue;
            out += `<rect x="${x(start).toFixed(1)}" y="${at}" width="${Math.max(0.6, x(end) - x(start)).toFixed(1)}" height="12" class="bar"/>`;
        }
        at += 17;
    }
    for (const tick of ticks(from / factor, to / factor, 6)) {
        const place = x(tick * factor).toFixed(1);
        out += `<path d="M${place} ${at}v4" class="zero"/>` + textAt(place, at + 16, 'middle', String(+tick.toPrecision(6)));
    }
    out += textAt(WIDTH - RIGHT, at + 30, 'end', `time (${prefix}s)`);
    return frame(out, at + 34);
}

/** The (w, lambda) plane of a diode: the two half axes of its rule, and where the run was. */
function plane(name, w, lambda) {
    const size = 190, edge = 26;
    // a diode with a resistance or a forward drop leaves its corner on the side of negative w
    const [wLeast, wMost] = rangeOf([w]), [lLeast, lMost] = rangeOf([lambda]);
    const wHigh = Math.max(wMost, -0.3 * wLeast), lHigh = Math.max(lMost, -0.3 * lLeast);
    const wLow = Math.min(wLeast, -0.12 * wHigh), lLow = Math.min(lLeast, -0.12 * lHigh);
    const shown = (values, high, factor) => {
        const most = values.reduce((soFar, value) => Math.max(soFar, value), 0);
        return most > 1e-6 * high && most > 1e-12 ? (most / factor).toPrecision(3) : '0'; // what rounding leaves
    };
    const x = (v) => edge + (size - 2 * edge) * (v - wLow) / (wHigh - wLow);
    const y = (v) => size - edge - (size - 2 * edge) * (v - lLow) / (lHigh - lLow);
    const [wFactor, wPrefix] = prefixFor(wHigh), [lFactor, lPrefix] = prefixFor(lHigh);
    const dots = new Map(); // one for each pixel
    for (let k = 0; k < w.length; k++) dots.set(`${Math.round(x(w[k]))} ${Math.round(y(lambda[k]))}`, true);
    let out = `<path d="M${x(wHigh)} ${y(0)}H${x(0)}V${y(lHigh)}" class="rule"/>`;
    out += `<path d="${[...dots.keys()].map((dot) => `M${dot}h0`).join('')}" class="dot"/>`;
    out += textAt(x(wHigh), y(0) + 16, 'end', `w (${wPrefix}V)`) + textAt(x(0) + 8, 20, 'start', `λ (${lPrefix}A)`);
    out += textAt(x(wHigh), y(0) - 6, 'end', shown(w, wHigh, wFactor));
    out += textAt(x(0) + 8, y(lHigh) + 14, 'start', shown(lambda, lHigh, lFactor));
    out += textAt(4, size - 4, 'start', name, 'font-weight="bold"');
    return `<svg viewBox="0 0 ${size} ${size}" class="plane" role="img">${out}</svg>`;
}

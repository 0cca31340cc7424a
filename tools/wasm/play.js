// play.js - the panel of a lesson: its netlist, sliders, and what a run of it shows. Needs threads.js and draw.js.
'use strict';

const SUFFIXES = [[1e6, 'Meg'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'u'], [1e-9, 'n'], [1e-12, 'p']];
const byId = (id) => document.getElementById(id);
const lesson = JSON.parse(byId('lesson').textContent);
const play = {result: null, runs: 0, frame: 0, later: 0, since: 0, changed: false, first: true};

// ---- The netlist -------------------------------------------------------------------------------

/** A number as SPICE writes it. */
function written(value) {
    const [factor, suffix] = SUFFIXES.find(([f]) => Math.abs(value) >= 0.9995 * f) || [1, ''];
    return value === 0 ? '0' : `${+(value / factor).toPrecision(3)}${suffix}`;
}

/** The netlist with this card in the place of the one of the same name, or besides. */
function withCard(netlist, card) {
    const words = card.split(/\s+/), escaped = (word) => word.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');
    const name = words.slice(0, words[0].toLowerCase() === '.model' ? 2 : 1).map(escaped).join('\\s+');
    const place = new RegExp(`^${name}(?![\\w.]).*$`, 'im');
    return place.test(netlist) ? netlist.replace(place, () => card) : netlist.replace(/^\.end\b|$(?![\s\S])/im, (end) => `${card}\n${end}`);
}

/** Beside .tran the search for a steady state of .pss can wait: it may need thousands of periods. */
function withoutSearch(netlist) {
    return /^\.tran\b/im.test(netlist) ? netlist.replace(/^\.pss\b.*$/gim, '*') : netlist;
}

/** All voltages and currents are wanted, whatever is saved. */
function withAllSignals(netlist) {
    return withCard(withCard(netlist.replace(/^\.(save|probe)\b.*$/gim, '*'), '.save all'), '.probe alli');
}

/** Diodes and switches, with their nodes. */
function elementsOf(netlist) {
    return netlist.split('\n').slice(1).map((line) => line.toLowerCase().match(/^([ds]\w*)\s+(\S+)\s+(\S+)/))
        .filter((found) => found).map(([, name, anode, cathode]) => ({name, anode, cathode}));
}

/** The netlist for implicit Euler, whose fixed steps find no steady state: {netlist, states}. Where the run begins in the
 *  steady state, states are the signals whose values it begins with, each with its name on .ic. */
function forEuler(netlist) {
    const text = withAllSignals(netlist.replace(/^\.pss\b.*$/gim, '*'));
    if (!/\buic=steady\b/i.test(text)) return {netlist: text, states: []};
    const states = text.toLowerCase().split('\n').slice(1).map((line) => line.match(/^([cl]\w*)\s+(\S+)\s+(\S+)/)).filter((found) => found)
        .map(([, name, a, b]) => name[0] === 'l' ? {name: `i(${name})`, plus: `i(${name})`, minus: null}
            : {name: b === '0' ? `v(${a})` : `v(${a},${b})`, plus: `v(${a})`, minus: `v(${b})`});
    return {netlist: text.replace(/\buic=steady\b/i, 'uic'), states};
}

// ---- A result ---------------------------------------------------------------------------------------

/** The values of v(a), v(a,b), i(x), or of a sum or difference of such. */
function column(result, expression) {
    const terms = expression.replace(/\s/g, '').match(/[-+]?[a-z]\w*\([^()]*\)/gi) || [];
    const sum = new Float64Array(result.time.length);
    for (const term of terms) {
        const sign = term[0] === '-' ? -1 : 1, name = term.replace(/^[-+]/, '').toLowerCase();
        const pair = name.match(/^v\(([^,]+),([^,]+)\)$/);
        for (const [signal, factor] of pair ? [[`v(${pair[1]})`, sign], [`v(${pair[2]})`, -sign]] : [[name, sign]]) {
            const from = result.signals[signal];
            if (!from && signal !== 'v(0)') return null;
            for (let k = 0; from && k < sum.length; k++) sum[k] += factor * from[k];
        }
    }
    return terms.length ? sum : null;
}

/** For each element that conducts or blocks, the spans in which it conducts. */
function conduction(result, elements) {
    const stop = result.time[result.time.length - 1], events = new Map();
    for (const {element, time, state} of result.report.events) {
        if (!events.has(element)) events.set(element, []);
        events.get(element).push([time, state === 'on']);
    }
    const names = [...new Set([...elements.map((element) => element.name), ...events.keys()])];
    return names.map((name) => {
        const changes = events.get(name) || [], current = result.signals[`i(${name})`];
        let on = changes.length ? !changes[0][1] : !!current && current.some((i) => Math.abs(i) > 1e-12);
        let since = result.time[0];
        const spans = [];
        for (const [time, state] of changes) {
            if (on && !state) spans.push([since, time]);
            if (!on && state) since = time;
            on = state;
        }
        if (on) spans.push([since, stop]);
        return {name, spans};
    });
}

/** The modes of a run, by how long they last: [{mode, visits, share}, ...]. */
function modesOf(bodies, start, stop) {
    const edges = [...new Set([start, stop, ...bodies.flatMap(({spans}) => spans.flat())])].sort((a, b) => a - b);
    const found = new Map(), nothing = bodies.length ? 'none' : 'nothing changes sides';
    let before = null;
    for (let k = 0; k + 1 < edges.length; k++) {
        const middle = (edges[k] + edges[k + 1]) / 2;
        const mode = bodies.filter(({spans}) => spans.some(([a, b]) => a <= middle && middle < b)).map(({name}) => name).join(', ') || nothing;
        const entry = found.get(mode) || {mode, visits: 0, share: 0};
        entry.visits += mode === before ? 0 : 1;
        entry.share += (edges[k + 1] - edges[k]) / (stop - start);
        found.set(mode, entry);
        before = mode;
    }
    return [...found.values()].sort((a, b) => b.share - a.share);
}

/** Jumps of states, and what is known of the steady state, in words. */
function happenings({jumps = [], steady}) {
    const lines = jumps.slice(0, 12).map(({time, states, impulses, energy_lost: lost}) => {
        const changes = Object.entries(states).map(([name, {before, after}]) => {
            const unit = name[0] === 'l' ? 'A' : 'V';
            return `${name} jumps from ${quantity(before, unit)} to ${quantity(after, unit)}`;
        });
        const passed = Object.entries(impulses).map(([name, {charge, flux}]) =>
            charge === undefined ? `flux of ${name} ${quantity(flux, 'Wb')}` : `charge of ${name} ${quantity(charge, 'C')}`);
        return `At ${quantity(time, 's')}: ${[...changes, ...passed].join(', ')}; ${quantity(lost, 'J')} are lost.`;
    });
    if (jumps.length > 12) lines.push(`${jumps.length - 12} more jumps.`);
    if (steady) {
        const factors = steady.multipliers.map(({re, im}) => +re.toPrecision(6) + (im ? ` ${im < 0 ? '-' : '+'} ${Math.abs(+im.toPrecision(6))}j` : ''));
        lines.push(`The steady state, of period ${quantity(steady.period, 's')}, is ${steady.verdict}.`,
            factors.length ? `Its factors: ${factors.join(', ')}.` : 'It has no factor other than 0.');
    }
    return lines;
}

// ---- What is shown -------------------------------------------------------------------------------

function showHappenings(report) {
    byId('happenings').innerHTML = happenings(report).map((line) => `<p>${escapeText(line)}</p>`).join('');
}

function showMessages(text) {
    byId('messages').textContent = text.trim();
    byId('messages').classList.toggle('notes', !/(^|: )(error|warning): /m.test(text));
}

function showWaveforms(result, euler) {
    const time = result.time, from = lesson.from === null ? time[0] : lesson.from;
    const to = Math.min(lesson.to === null ? Infinity : lesson.to, time[time.length - 1]);
    let html = '';
    for (const group of lesson.panels) {
        for (const unit of ['V', 'A']) { // each unit has a panel of its own
            const names = group.filter((name) => (name[0].toLowerCase() === 'i' ? 'A' : 'V') === unit);
            const curves = names.map((name, colour) => ({name, unit, colour, time, value: column(result, name)}));
            if (euler) {
                curves.push(...names.map((name, colour) => ({name, unit, colour, dashed: true, time: euler.time, value: column(euler, name)})));
            }
            const known = curves.filter((curve) => curve.value);
            if (known.length) html += panel(known, from, to);
        }
    }
    const elements = elementsOf(byId('netlist').value), bodies = conduction(result, elements);
    byId('waveforms').innerHTML = html + bars(bodies, from, to);
    byId('planes').innerHTML = elements.filter(({name}) => name[0] === 'd').map(({name, anode, cathode}) => {
        const w = column(result, `v(${cathode},${anode})`), lambda = result.signals[`i(${name})`];
        return w && lambda ? plane(name, w, lambda) : '';
    }).join('');
    byId('planes').parentElement.hidden = byId('planes').innerHTML === '';
    showHappenings(result.report);
    byId('modes').innerHTML = '<tr><th>conducts, or is on</th><th>times</th><th>of the time</th></tr>' +
        modesOf(bodies, time[0], time[time.length - 1]).slice(0, 16).map(({mode, visits, share}) =>
            `<tr><td>${escapeText(mode)}</td><td>${visits}</td><td>${(100 * share).toFixed(1)} %</td></tr>`).join('');
}

// ---- What is asked -------------------------------------------------------------------------------

/** The steady state, and what theory says, are slower than a run: they wait until the sliders rest. */
function askTheory(netlist) {
    play.theory = play.theory || new Engine(showTheory, showMessages);
    play.theory.ask({kind: 'theory', netlist, search: withoutSearch(netlist) !== netlist ? withAllSignals(netlist) : null});
}

function showTheory({steady, equations, check}, {netlist}) {
    if (netlist !== play.shown || play.engine.busy || play.changed) return; // it is of an older netlist
    if (steady) showMessages(steady.messages);
    if (steady && steady.status === 0) showHappenings(steady.report);
    byId('equations').textContent = equations;
    byId('check').innerHTML = (check.parts || []).map((part) => `<p>${escapeText(part.summary)}</p><table>` +
        Object.entries(part.verdicts).map(([question, {answer, sentence}]) =>
            `<tr><th>${escapeText(question)}</th><td class="${escapeText(answer)}">${escapeText(sentence)}</td></tr>`).join('') +
        '</table>').join('');
    document.body.dataset.theory = 'yes';
}

function askRun() {
    const netlist = byId('netlist').value;
    play.runs++;
    play.engine.ask({kind: 'run', shown: netlist, since: play.since || performance.now(), netlist: withAllSignals(withoutSearch(netlist)),
        euler: byId('euler').checked ? forEuler(netlist) : null,
        steps: +byId('steps').value});
    play.since = 0;
    play.changed = false;
}

function showRun({result, euler, h}, {shown, since, steps}) {
    play.result = result;
    play.euler = euler;
    play.shown = shown;
    byId('results').classList.toggle('stale', result.status !== 0);
    if (result.status === 0 && h > 0) {
        byId('stepsize').textContent = `${steps} steps, h = ${quantity(h, 's', 3)}`;
        showWaveforms(result, euler && euler.status === 0 ? euler : null);
        if (!play.engine.busy && !play.changed) play.later = setTimeout(askTheory, 200, shown);
    }
    showMessages(result.messages + (euler && euler.status ? `\nimplicit Euler: ${euler.messages}` : ''));
    play.millis = performance.now() - since;
    byId('millis').textContent = `${play.first ? 'started' : 'answered'} in ${play.millis.toFixed(0)} ms`;
    play.first = false;
    if (!play.engine.busy && !play.changed) document.body.dataset.ready = 'yes';
}

/** What is shown is no longer that of the netlist. */
function change() {
    clearTimeout(play.later);
    play.changed = true;
    document.body.dataset.ready = document.body.dataset.theory = 'no';
}

/** One run for all that was moved since the last picture: a slider may send more than the screen shows. */
function request() {
    change();
    play.since = play.since || performance.now();
    play.frame = play.frame || requestAnimationFrame(() => {
        play.frame = 0;
        askRun();
    });
}

// ---- What is moved -------------------------------------------------------------------------------

function addSlider({label, unit, card, from, to, log, value}) {
    const row = document.createElement('label'), shown = document.createElement('output');
    const range = Object.assign(document.createElement('input'), {type: 'range', min: 0, max: 1000, step: 1});
    const toPlace = (v) => 1000 * (log ? Math.log(v / from) / Math.log(to / from) : (v - from) / (to - from));
    const valueAt = (place) => log ? from * (to / from) ** (place / 1000) : from + (to - from) * place / 1000;
    const show = (v) => { shown.textContent = quantity(v, unit, 3); };
    range.value = toPlace(value);
    show(value);
    range.addEventListener('input', () => {
        const now = Math.abs(valueAt(+range.value)) < 1e-12 * Math.abs(to) ? 0 : valueAt(+range.value);
        show(now);
        byId('netlist').value = withCard(byId('netlist').value, card.replace('{}', written(now)));
        request();
    });
    row.append(label, range, shown);
    byId('sliders').append(row);
}

function begin() {
    byId('netlist').value = lesson.netlist;
    byId('netlist').rows = Math.min(24, lesson.netlist.split('\n').length);
    lesson.sliders.forEach(addSlider);
    byId('netlist').addEventListener('input', () => {
        change();
        clearTimeout(play.typing);
        play.typing = setTimeout(request, 250);
    });
    byId('euler').addEventListener('change', request);
    byId('steps').addEventListener('input', () => { byId('euler').checked = true; request(); });
    byId('again').addEventListener('click', () => {
        byId('sliders').innerHTML = '';
        lesson.sliders.forEach(addSlider);
        byId('euler').checked = false;
        byId('netlist').value = lesson.netlist;
        request();
    });
    play.engine = new Engine(showRun, showMessages);
    request();
}

begin();

// threads.js - the engine in threads of its own: the page stays quick while one computes. Needs dalcs-engine.js.
'use strict';

/** All that a thread does. It is read as text there, and sees nothing of the page. */
function engineThread(startEngine) {
    'use strict';
    const started = startEngine();

    /** {status, messages, time, signals, report} of a netlist. */
    function simulate(call, heap, netlist, method, step) {
        let status = call('engine_read', 'number', netlist);
        if (status === 0) status = call('engine_run', 'number', method, step);
        const nRows = status === 0 ? call('engine_n_rows', 'number') : 0;
        const nSignals = nRows ? call('engine_n_signals', 'number') : 0;
        const scale = nRows ? call('engine_scale', 'number') / 8 : 0, values = nRows ? call('engine_values', 'number') / 8 : 0;
        const memory = heap(), signals = {};
        for (let j = 0; j < nSignals; j++) {
            const column = signals[call('engine_signal', 'string', j)] = new Float64Array(nRows);
            for (let k = 0; k < nRows; k++) column[k] = memory[values + k * nSignals + j];
        }
        return {status, messages: call('engine_messages', 'string'), time: memory.slice(scale, scale + nRows), signals,
            report: status === 0 ? JSON.parse(call('engine_report', 'string')) : {events: []}};
    }

    const answers = {
        /** A run, and where `euler` is given one with implicit Euler in so many steps, from the same states. */
        run(call, heap, {netlist, method = '', step = 0, euler, steps}) {
            const result = simulate(call, heap, netlist, method, step), {status, time} = result;
            const h = time.length > 1 ? (time[time.length - 1] - time[0]) / steps : 0;
            if (!euler || status !== 0 || h === 0) return {result, h, euler: null};
            const first = (signal) => (result.signals[signal] || [0])[0];
            const start = euler.states.map((state) => `${state.name}=${first(state.plus) - first(state.minus)}`);
            const card = start.length ? `.ic ${start.join(' ')}\n` : '';
            const text = euler.netlist.replace(/^\.end\b|$(?![\s\S])/im, (end) => card + end);
            return {result, h, euler: simulate(call, heap, text, 'euler', h)};
        },
        /** What takes longer: the steady state where there is a second netlist, the equations, what theory says. */
        theory(call, heap, {netlist, search}) {
            const steady = search ? simulate(call, heap, search, '', 0) : null;
            call('engine_read', 'number', netlist);
            return {steady, equations: call('engine_equations', 'string'), check: JSON.parse(call('engine_check', 'string'))};
        },
    };

    async function answer(question) {
        const engine = await started;
        const call = (name, kind, ...values) =>
            engine.ccall(name, kind, values.map((value) => typeof value === 'string' ? 'string' : 'number'), values);
        const found = answers[question.kind](call, () => engine.HEAPF64, question);
        const columns = [found.result, found.euler, found.steady].filter((result) => result)
            .flatMap(({time, signals}) => [time, ...Object.values(signals)]);
        postMessage(found, columns.map(({buffer}) => buffer));
    }

    onmessage = ({data}) => answer(data).catch((error) => postMessage(`The simulator stopped: ${error}`));
    started.then(() => postMessage('started'), (error) => postMessage(`The simulator did not start: ${error}`));
}

/** A thread with the engine. Of the questions that are asked while it works the newest alone is answered.
 *
 *  Nothing can interrupt a run inside of the engine. So if an old question has taken as long as a thread needs to start,
 *  the thread is ended, and a new one takes the newest question: at worst the answer comes twice as late as the better of
 *  the two choices would give it. Each thread that was ended without an answer doubles this time for the next one, so
 *  that a slider that is moved on and on shows pictures of slow runs, too. */
class Engine {
    constructor(answered, failed) {
        Object.assign(this, {answered, failed, asked: null, next: null, patience: Infinity, timer: 0, threads: 0, unanswered: 0});
        this.begin();
    }

    begin() {
        // A page that is opened as a file may load no script into a thread; a blob of its own it may.
        const text = `let _scriptDir; (${engineThread})(${dalcsEngine});`;
        const address = URL.createObjectURL(new Blob([text], {type: 'text/javascript'}));
        const begun = performance.now();
        this.threads++;
        this.started = false;
        const worker = this.worker = new Worker(address);
        worker.onerror = ({message}) => this.failed(`The simulator did not start: ${message}`);
        worker.onmessage = ({data}) => {
            if (worker !== this.worker) return; // it has been ended
            if (data === 'started') {
                URL.revokeObjectURL(address);
                this.started = true;
                this.since = performance.now();
                this.patience = this.since - begun;
                this.hurry();
            } else if (typeof data === 'string') { // the thread is of no more use, the next one may be
                this.failed(data);
                this.asked = null;
                if (this.started) this.replace();
            } else {
                const question = this.asked;
                this.asked = null;
                this.unanswered = 0;
                this.send();
                this.answered(data, question);
            }
        };
    }

    /** Asks, and forgets a question that waits. */
    ask(question) {
        this.next = question;
        if (this.asked) this.hurry();
        else this.send();
    }

    /** Is there a question without an answer? */
    get busy() {
        return !!(this.asked || this.next);
    }

    send() {
        clearTimeout(this.timer);
        this.timer = 0;
        if (!this.next) return;
        this.asked = this.next;
        this.next = null;
        this.since = performance.now();
        this.worker.postMessage(this.asked);
    }

    /** Ends the thread if it still works on an old question when its time is over. */
    hurry() {
        if (!this.started || !this.next || this.timer) return;
        const time = this.patience * 2 ** this.unanswered - (performance.now() - this.since);
        this.timer = setTimeout(() => {
            this.unanswered++;
            this.replace();
        }, time);
    }

    replace() {
        this.worker.terminate();
        this.begin();
        this.send();
    }
}

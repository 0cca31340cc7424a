/* audit_gates_expected.c - what the law of a gate says that it has to put out, by its inputs and what it remembers. */
#include "audit_gate.h"

#include <math.h>

unsigned audit_gate_flashes(const struct dalcs_audit_gates *a, const struct dalcs_logic_gate *g,
                            struct dalcs_audit *audit, double t) {
    unsigned flashes = 0;
    for (int i = 0; i < g->n_inputs; i++) {
        const struct dalcs_logic_input *input = &g->input[i];
        if (input->from == DALCS_GATE_COMPARATOR &&
            dalcs_logic_run_flashed(a->logic, input->index)) {
            const struct dalcs_radau_part *part = &a->radau->part[a->place[input->index].part];
            const bool begins =
                part->kind == DALCS_PART_STEPPED && part->segment.t >= t - a->radau->resolution;
            flashes |= dalcs_audit_has_cause(audit, part->index, t, begins)
                           ? 1u << (i < AUDIT_GATE_BITS ? i : AUDIT_GATE_BITS - 1)
                           : 0u;
        }
    }
    return flashes;
}

static bool has(const struct audit_gate *s, int input) {
    return (s->flashes >> input & 1u) != 0;
}

struct audit_verdict audit_gate_of_inputs(const struct dalcs_audit_gates *a,
                                          const struct dalcs_logic_gate *g) {
    struct audit_verdict v = {.is_known = true};
    int n = 0;
    int n_high = 0;
    for (int i = 0; i < g->n_inputs; i++) {
        if (g->input[i].from != DALCS_GATE_OPEN) {
            n++;
            n_high += audit_gate_reads(a, &g->input[i], &v.is_known) ? 1 : 0;
        }
    }
    v.q = g->kind == DALCS_GATE_AND   ? n_high == n
          : g->kind == DALCS_GATE_XOR ? n_high % 2 == 1
          : g->kind == DALCS_GATE_ONE ? n_high == 1
                                      : n_high > 0;
    return v;
}

/* After a clock, from a table: data and reset, 0 0, 1 0, 0 1, 1 1. */
static bool after_clock(enum dalcs_logic_kind kind, bool q, bool data, bool reset) {
    const bool jk[] = {q, true, false, !q};
    const bool sr[] = {q, true, false, false};
    const int at = (data ? 1 : 0) + (reset ? 2 : 0);
    switch (kind) {
    case DALCS_GATE_TOGGLE:
        return data ? !q : q;
    case DALCS_GATE_JK:
        return jk[at];
    case DALCS_GATE_SR:
    case DALCS_GATE_SR_LATCH:
        return sr[at];
    default:
        return data;
    }
}

struct audit_verdict audit_gate_of_memory(const struct dalcs_audit_gates *a,
                                          const struct dalcs_logic_gate *g, struct audit_gate *s) {
    const bool is_latch = g->kind == DALCS_GATE_LATCH;
    struct audit_verdict v = {.is_known = s->flashes == 0};
    const bool clears =
        audit_gate_reads(a, &g->input[is_latch ? 1 : DALCS_GATE_CLEAR], &v.is_known);
    const bool sets = audit_gate_reads(a, &g->input[is_latch ? 0 : DALCS_GATE_PRESET], &v.is_known);
    const bool clock = !is_latch && audit_gate_reads(a, &g->input[DALCS_GATE_CLOCK], &v.is_known);
    const bool data = !is_latch && audit_gate_reads(a, &g->input[DALCS_GATE_DATA], &v.is_known);
    const bool has_reset =
        g->kind == DALCS_GATE_JK || g->kind == DALCS_GATE_SR || g->kind == DALCS_GATE_SR_LATCH;
    const bool is_open = dalcs_gate_is_transparent(g);
    const bool reset = has_reset ? audit_gate_reads(a, &g->input[DALCS_GATE_RESET], &v.is_known)
                                 : !is_open && (clears || sets);
    const bool acts = is_open ? clock : clock && !s->clock && s->was_seen;
    const bool next = !is_latch && after_clock(g->kind, s->q, data, reset);
    v.q = !clears && (sets || next);
    v.is_held = !clears && !sets && !acts;
    v.is_forced = clears || sets;
    if (!is_open && acts && !sets && !clears && (data != s->data || reset != s->reset)) {
        v.is_known = false; /* did they, or what forced it, change before the clock? */
    }
    if (is_open && !acts && s->clock && (data != s->data || reset != s->reset)) {
        v.is_known = false; /* after the gate closed? */
    }
    if (clock && !is_open && !s->was_seen) {
        v.is_known = false; /* has it risen at the start, or was it high before? */
    }
    s->clock = clock;
    s->data = data;
    s->reset = reset;
    return v;
}

struct audit_verdict audit_gate_of_counter(const struct dalcs_audit_gates *a,
                                           const struct dalcs_logic_gate *g, struct audit_gate *s,
                                           bool now) {
    struct audit_verdict v = {.is_known = true};
    const bool clock = audit_gate_reads(a, &g->input[0], &v.is_known);
    const bool clears = audit_gate_reads(a, &g->input[1], &v.is_known);
    const bool rises = (clock && !s->clock && s->was_seen) || s->flashes == 1u;
    if (s->flashes > 2u) {
        s->count = -1; /* which was first? */
    } else if (clears || s->flashes == 2u) {
        s->count = 0;
    } else if (rises && s->reset && s->count == 0) { /* did that end before the clock? */
        s->count = g->delay[1] > 0.0 ? -1 : now ? 1 : 0;
    } else if (rises && s->count >= 0) {
        s->count = s->count % g->cycles + 1;
    } else if (rises && g->delay[1] == 0.0 && now && !s->q && !s->is_lost) {
        s->count = 1;
    }
    if (clock && !s->was_seen) {
        s->count = -1; /* has it risen at the start, or was it high before? */
    }
    v.is_known = v.is_known && s->count >= 0;
    v.q = s->count > 0 && s->count <= g->n_high;
    s->clock = clock;
    s->reset = clears;
    return v;
}

/* From a clock on to where the next one counts, and what shows it has been shown. */
static double whole_pulse(const struct dalcs_audit_gates *a, const struct dalcs_logic_gate *g,
                          double length) {
    return g->pulse.lead + length + g->pulse.recovery + 4.0 * a->radau->resolution;
}

struct audit_verdict audit_gate_of_monostable(const struct dalcs_audit_gates *a,
                                              const struct dalcs_logic_gate *g,
                                              struct audit_gate *s, double t) {
    struct audit_verdict v = {.is_known = true};
    const bool clock = audit_gate_reads(a, &g->input[DALCS_GATE_CLOCK], &v.is_known);
    const bool clears = audit_gate_reads(a, &g->input[DALCS_GATE_CLEAR], &v.is_known);
    const double length = g->sampled >= 0 ? fmax(0.0, s->before) : g->pulse.length;
    while (s->count > 0 && s->ends <= t + 4.0 * a->radau->resolution) {
        s->count = s->count == 1 && !g->pulse.is_retriggered ? 2 : 0;
        s->ends += g->pulse.recovery;
    }
    if (s->count < 0 && s->ends <= t) {
        s->count = 0;
    }
    const bool rises = (clock && !s->clock && s->was_seen) || has(s, DALCS_GATE_CLOCK);
    if (clears || has(s, DALCS_GATE_CLEAR)) {
        s->count = 0;
    } else if (clock && !s->was_seen) {
        s->count = -1; /* has it risen at the start, or was it high before? */
        s->ends = g->sampled >= 0 ? INFINITY : t + whole_pulse(a, g, length);
    } else if (rises && s->count < 0 && !g->pulse.is_retriggered) {
        s->ends = fmax(s->ends, t + whole_pulse(a, g, length));
    } else if (rises && (s->count == 0 || g->pulse.is_retriggered)) {
        s->count = 1;
        s->ends = t + g->pulse.lead + length;
    }
    v.is_known = v.is_known && s->count >= 0;
    v.is_forced = clears || has(s, DALCS_GATE_CLEAR);
    v.q = s->count == 1;
    s->clock = clock;
    return v;
}

/* May there be pulses of no width? What has a delay shows none. */
static bool is_instant(const struct dalcs_audit_gates *a, const struct dalcs_logic_input *input) {
    return input->from == DALCS_GATE_GATE &&
           !dalcs_gate_has_delay(&a->circuit->control.gate[input->index]);
}

bool audit_gate_may_have_missed(const struct dalcs_audit_gates *a,
                                const struct dalcs_logic_gate *g) {
    bool may = false;
    for (int i = 0; i < g->n_inputs; i++) {
        may = may || is_instant(a, &g->input[i]);
    }
    return may;
}

bool audit_gate_may_be_undone(const struct dalcs_audit_gates *a, const struct dalcs_logic_gate *g,
                              const struct audit_verdict *v) {
    const bool has_both = g->kind >= DALCS_GATE_FLIP_FLOP && g->kind <= DALCS_GATE_SR_LATCH;
    return has_both && !v->is_held && !v->is_forced &&
           is_instant(a, &g->input[v->q ? DALCS_GATE_CLEAR : DALCS_GATE_PRESET]);
}

enum dalcs_status audit_gate_expect(struct audit_gate *s, bool q, double due) {
    if (q == s->q) {
        return DALCS_OK;
    }
    s->q = q;
    if (s->n_due > s->first_due && s->due[s->n_due - 1] >= due) {
        s->n_due--; /* back before it is there */
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_grow(&s->due, &s->capacity, s->n_due + 1, sizeof(*s->due)));
    s->due[s->n_due++] = due;
    return DALCS_OK;
}

/* audit_gates.c - gates and flip-flops, decided a second time.
 *
 * Each gate is held to its own law (doc/netlist.md): what it shows is what its inputs say, or said its delay before. Inputs
 * are the comparators' positions, which are audited as those of all switches, and what other gates show, in the sources
 * that the circuit has. Nothing of the network or its queue is asked. What depends on an order within one instant (data
 * that change with their clock, a pulse of no width that sets a latch) is taken as it is shown. */
#include "audit_gates.h"

#include <stdlib.h>
#include <string.h>

struct audit_gate {
    bool q;           /* decided */
    bool clock, data; /* when it was looked at last */
    bool is_lost;     /* behind a delay something depended on an order within an instant */
    bool shown;       /* what it has to show by now */
    int device;       /* the source that shows q, or its complement; -1: neither is wired */
    double *due;      /* [n_due] s: what it has to show changes */
    size_t first_due, n_due, capacity;
};

static int device_named(const struct dalcs_circuit *c, const char *name) {
    for (int d = 0; d < c->n_devices; d++) {
        if (strcmp(c->device[d].name, name) == 0) {
            return d;
        }
    }
    return -1;
}

enum dalcs_status dalcs_audit_gates_start(struct dalcs_audit_gates *a,
                                          const struct dalcs_circuit *circuit,
                                          const struct dalcs_radau *radau) {
    *a = (struct dalcs_audit_gates){.circuit = circuit, .radau = radau};
    if (circuit->n_gates == 0) {
        return DALCS_OK;
    }
    a->gate = dalcs_alloc((size_t)circuit->n_gates, sizeof(*a->gate));
    a->place = dalcs_alloc((size_t)circuit->n_comparators + 1, sizeof(*a->place));
    enum dalcs_status status = a->gate != NULL && a->place != NULL ? DALCS_OK : DALCS_E_NOMEM;
    for (int k = 0; status == DALCS_OK && k < circuit->n_comparators; k++) {
        status = dalcs_logic_find_comparator(circuit, radau, k, &a->place[k]) ? DALCS_OK
                                                                              : DALCS_E_INTERNAL;
    }
    for (int k = 0; status == DALCS_OK && k < circuit->n_gates; k++) {
        a->gate[k].device = device_named(circuit, circuit->gate[k].name);
        a->gate[k].is_lost = true; /* until it is looked at for the first time */
    }
    if (status != DALCS_OK) {
        dalcs_audit_gates_finish(a);
    }
    return status;
}

void dalcs_audit_gates_finish(struct dalcs_audit_gates *a) {
    for (int k = 0; a->gate != NULL && k < a->circuit->n_gates; k++) {
        free(a->gate[k].due);
    }
    free(a->gate);
    free(a->place);
    *a = (struct dalcs_audit_gates){0};
}

static int shown_by(const struct dalcs_logic_gate *g) {
    return g->output[0] >= 0 ? g->output[0] : g->output[1];
}

/* In the source that shows q or its complement: the last level that was written. */
static bool shows(const struct dalcs_audit_gates *a, int k) {
    const struct dalcs_logic_gate *g = &a->circuit->gate[k];
    const struct dalcs_stimulus *s = &a->circuit->stimulus[shown_by(g)];
    const double last = s->u.pwl.v[s->u.pwl.n - 1];
    return (last > 0.5 * (g->low + g->high)) == (g->output[0] >= 0);
}

/* *is_known: not what a gate says that nothing shows. */
static bool reads(const struct dalcs_audit_gates *a, const struct dalcs_logic_input *input,
                  bool *is_known) {
    bool bit = false;
    if (input->from == DALCS_GATE_COMPARATOR) {
        const struct dalcs_logic_place *p = &a->place[input->index];
        bit = dalcs_osnsp_is_on(&a->radau->part[p->part].component->osnsp, p->pair);
    } else if (input->from == DALCS_GATE_GATE) {
        const bool is_shown = shown_by(&a->circuit->gate[input->index]) >= 0;
        *is_known = *is_known && is_shown;
        bit = is_shown && shows(a, input->index);
    }
    return bit != input->is_inverted;
}

/* What the inputs say; held: they leave it as it was, as far as can be told. */
struct verdict {
    bool q, is_held, is_known;
};

static struct verdict of_inputs(const struct dalcs_audit_gates *a,
                                const struct dalcs_logic_gate *g) {
    struct verdict v = {.is_known = true};
    int n = 0;
    int n_high = 0;
    for (int i = 0; i < DALCS_GATE_INPUTS; i++) {
        if (g->input[i].from != DALCS_GATE_OPEN) {
            n++;
            n_high += reads(a, &g->input[i], &v.is_known) ? 1 : 0;
        }
    }
    v.q = g->kind == DALCS_GATE_AND   ? n_high == n
          : g->kind == DALCS_GATE_XOR ? n_high % 2 == 1
                                      : n_high > 0;
    return v;
}

static struct verdict of_memory(const struct dalcs_audit_gates *a, const struct dalcs_logic_gate *g,
                                struct audit_gate *s) {
    const bool is_latch = g->kind == DALCS_GATE_LATCH;
    struct verdict v = {.is_known = true};
    const bool clears = reads(a, &g->input[is_latch ? 1 : DALCS_GATE_CLEAR], &v.is_known);
    const bool sets = reads(a, &g->input[is_latch ? 0 : DALCS_GATE_PRESET], &v.is_known);
    const bool clock = !is_latch && reads(a, &g->input[DALCS_GATE_CLOCK], &v.is_known);
    const bool data = !is_latch && reads(a, &g->input[DALCS_GATE_DATA], &v.is_known);
    const bool rises = clock && !s->clock;
    v.q = !clears && (sets || data);
    v.is_held = !clears && !sets && !rises;
    if (rises && !sets && !clears && data != s->data) {
        v.is_known = false; /* did the data change before the clock? */
    }
    s->clock = clock;
    s->data = data;
    return v;
}

/* May a pulse of no width have set it? */
static bool reads_gates(const struct dalcs_logic_gate *g) {
    bool does = false;
    for (int i = 0; i < DALCS_GATE_INPUTS; i++) {
        does = does || g->input[i].from == DALCS_GATE_GATE;
    }
    return does;
}

static enum dalcs_status expect(struct audit_gate *s, bool q, double due) {
    if (q == s->q) {
        return DALCS_OK;
    }
    s->q = q;
    DALCS_TRY(dalcs_grow(&s->due, &s->capacity, s->n_due + 1, sizeof(*s->due)));
    s->due[s->n_due++] = due;
    return DALCS_OK;
}

/* What it has to show by t. *is_near: it changes about then, and which side t is on is rounding. */
static void go_to(struct audit_gate *s, double t, double near, bool *is_near) {
    *is_near = false;
    while (s->first_due < s->n_due && s->due[s->first_due] <= t + near) {
        *is_near = *is_near || s->due[s->first_due] > t - near;
        s->shown = !s->shown;
        s->first_due++;
    }
    if (s->first_due == s->n_due) {
        s->first_due = s->n_due = 0;
    }
}

/* Gate k at t; is_wrong: it does not show what it has to. */
static enum dalcs_status look_at(struct dalcs_audit_gates *a, int k, double t, bool *is_wrong) {
    const struct dalcs_logic_gate *g = &a->circuit->gate[k];
    struct audit_gate *s = &a->gate[k];
    const bool has_memory = g->kind == DALCS_GATE_LATCH || g->kind == DALCS_GATE_FLIP_FLOP;
    const bool now = shows(a, k);
    struct verdict v = has_memory ? of_memory(a, g, s) : of_inputs(a, g);
    const bool is_open = !v.is_known || (v.is_held && reads_gates(g));
    *is_wrong = false;
    if (s->is_lost && !has_memory && v.is_known) { /* what it showed stands until it decides else */
        s->is_lost = false;
        s->q = s->shown = now;
        s->first_due = s->n_due = 0;
    } else if (s->is_lost && has_memory && g->delay == 0.0) {
        s->is_lost = false;
        s->q = s->shown = now;
    }
    if (s->is_lost) {
        return DALCS_OK;
    }
    if (g->delay == 0.0) {
        const bool q = is_open ? now : v.is_held ? s->q : v.q;
        s->q = s->shown = q;
        *is_wrong = q != now;
        return DALCS_OK;
    }
    s->is_lost = is_open;
    bool is_near;
    DALCS_TRY(expect(s, v.is_held ? s->q : v.q, t + g->delay));
    go_to(s, t, 4.0 * a->radau->resolution, &is_near);
    *is_wrong = !is_open && !is_near && s->shown != now;
    return DALCS_OK;
}

enum dalcs_status dalcs_audit_gates_look(struct dalcs_audit_gates *a, struct dalcs_audit *audit,
                                         double t) {
    for (int k = 0; a->gate != NULL && k < a->circuit->n_gates; k++) {
        if (shown_by(&a->circuit->gate[k]) >= 0) {
            bool is_wrong;
            DALCS_TRY(look_at(a, k, t, &is_wrong));
            if (is_wrong && a->gate[k].device >= 0) {
                dalcs_audit_add_position(audit, a->gate[k].device, 1.0, t);
            }
        }
    }
    return DALCS_OK;
}

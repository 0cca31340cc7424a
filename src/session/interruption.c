/* interruption.c - coils whose current an ideal switch cuts off.
 *
 * The current stops at once, and the voltage is an impulse: a jump like any other, but hardly ever what
 * was meant. A real switch would burn. The circuit's graph shows which switch it was: what conducts
 * after the jump makes its two nodes one. The coils connect the nodes that remain. One that jumps is cut off
 * by a switch that has just opened and lies with it on a loop of coils and of what has just opened: around any other
 * loop its flux could not go. */
#include "impulses.h"
#include "losses_run.h"

#include "branch_graph.h"
#include "union_find.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A flux below this part of the largest is rounding. */
static const double noticeable = 1e-9;

/* A coil, a switch or a diode of the graph. */
struct member {
    const char *name;
    int pair;             /* of a switch; -1 */
    double before, after; /* A, of a coil */
};

struct cut {
    struct dalcs_run *r;
    const struct dalcs_euler_jump *jump;
    int n; /* of the graph */
    struct member *member;
    struct dalcs_branch *branch;
    int *block; /* [n] */
};

/* Was the pair closed until this instant? At the start nothing was yet. */
static bool was_closed(const struct dalcs_run *r, const struct dalcs_euler_jump *j, int pair) {
    const struct dalcs_event_log *log = &r->s->results.recorder.log;
    if (!log->keep || !r->s->results.recorder.have_before ||
        dalcs_mode_has(log->seen[j->system], pair)) {
        return true;
    }
    const char *name = r->s->network.system[j->system].pair[pair].element;
    for (size_t k = log->n_events; k > 0 && log->event[k - 1].time >= j->time; k--) {
        if (!log->event[k - 1].on && strcmp(log->event[k - 1].element, name) == 0) {
            return true;
        }
    }
    return false;
}

/* The first pair of this element, looked for from `from` on and then around: they have the order of the devices. -1: it
 * has none here. */
static int pair_of(const struct dalcs_system *s, const char *name, int from) {
    for (int k = 0; k < s->n_pairs; k++) {
        int d = from + k < s->n_pairs ? from + k : from + k - s->n_pairs;
        if (strcmp(s->pair[d].element, name) == 0 && !s->pair[d].is_breakdown) {
            return d;
        }
    }
    return -1;
}

static bool is_open(const struct dalcs_system *s, const uint64_t *mode, int pair) {
    bool breaks_down =
        pair + 1 < s->n_pairs && s->pair[pair + 1].is_breakdown && dalcs_mode_has(mode, pair + 1);
    return !dalcs_mode_has(mode, pair) && !breaks_down;
}

static bool leaks(const struct dalcs_circuit *c, const struct dalcs_device *d) {
    return isfinite(dalcs_device_roff(c, d));
}

static void add(struct cut *cut, const struct dalcs_device *d, struct member member) {
    cut->member[cut->n] = member;
    cut->branch[cut->n++] = (struct dalcs_branch){d->node[0], d->node[1], INFINITY, INFINITY};
}

/* Coils and what has just opened become branches; what conducts makes its nodes one. */
static void sort_devices(struct cut *cut, int *whole) {
    static const double no_inputs[1] = {1.0}; /* columns only */
    const struct dalcs_circuit *c = &cut->r->s->circuit;
    const struct dalcs_network *n = &cut->r->s->network;
    const struct dalcs_euler_jump *j = cut->jump;
    const struct dalcs_system *s = &n->system[j->system];
    int next_pair = 0;
    int next_state = 0;
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        bool has_state = d->kind == DALCS_CAPACITOR || d->kind == DALCS_INDUCTOR;
        const struct dalcs_state *x = has_state ? &n->state[next_state++] : NULL;
        bool has_sides = d->kind == DALCS_DIODE || d->kind == DALCS_SWITCH;
        int pair = has_sides && !leaks(c, d) ? pair_of(s, d->name, next_pair) : -1;
        bool opens = pair >= 0 && is_open(s, j->mode, pair);
        next_pair = pair >= 0 ? pair + 1 : next_pair;
        if (d->kind == DALCS_INDUCTOR) {
            struct member coil = {.name = d->name, .pair = -1};
            if (x->probe.system == j->system && dalcs_probe_is_known(&x->probe, j->n_known)) {
                coil.before = dalcs_probe_value(&x->probe, j->before, no_inputs);
                coil.after = dalcs_probe_value(&x->probe, j->after, no_inputs);
            }
            add(cut, d, coil);
        } else if (opens && was_closed(cut->r, j, pair)) {
            add(cut, d, (struct member){d->name, d->kind == DALCS_SWITCH ? pair : -1, 0.0, 0.0});
        } else if (!opens && d->kind != DALCS_ISOURCE && d->kind != DALCS_VCCS &&
                   d->kind != DALCS_CCCS) {
            (void)dalcs_union_join(whole, d->node[0], d->node[1]);
        }
    }
    for (int k = 0; k < cut->n; k++) {
        cut->branch[k].tail = dalcs_union_find(whole, cut->branch[k].tail);
        cut->branch[k].head = dalcs_union_find(whole, cut->branch[k].head);
    }
}

/* The coil that jumps farthest of those on a loop with member k; NULL: none does. */
static const struct member *coil_with(const struct cut *cut, int k) {
    const struct member *coil = NULL;
    double most = 0.0;
    for (int i = 0; i < cut->n; i++) {
        double change = fabs(cut->member[i].after - cut->member[i].before);
        bool is_on_loop = cut->block[k] >= 0 && cut->block[i] == cut->block[k];
        if (is_on_loop && cut->branch[k].tail != cut->branch[k].head && change > most) {
            most = change;
            coil = &cut->member[i];
        }
    }
    return coil;
}

/* What the jumps of currents cost, J: capacitors may have jumped at the same time. */
static double loss_of_currents(const struct dalcs_system *s, const struct dalcs_euler_jump *j) {
    double loss = 0.0;
    for (int x = 0; x < s->n_x; x++) {
        for (int k = s->storage.p[x]; s->column_is_current[x] && k < s->storage.p[x + 1]; k++) {
            int of = s->storage.j[k];
            loss += 0.5 * s->storage.x[k] * (j->after[x] - j->before[x]) *
                    (j->after[of] - j->before[of]);
        }
    }
    return loss;
}

static enum dalcs_status warn(struct dalcs_run *r, const struct dalcs_euler_jump *j, int pair,
                              const struct member *coil) {
    const struct dalcs_system *s = &r->s->network.system[j->system];
    const char *name = s->pair[pair].element;
    if (dalcs_names_find(&r->interrupting, name) >= 0) {
        return DALCS_OK;
    }
    double flux = fabs(j->flux[pair]);
    const char *impulse =
        flux > 0.0 ? dalcs_arena_printf(&r->s->arena, " with a voltage impulse of %.6g Wb", flux)
                   : ""; /* a diode in series has it */
    if (impulse == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_diag_add(
        &r->s->diag, DALCS_WARNING, dalcs_place_of(&r->s->circuit, name),
        "a diode or a capacitor would let the current go on, Roff= would bound the voltage",
        "opening at t = %.9g s, '%s' interrupts the current of '%s': it jumps from %.6g A "
        "to %.6g A%s, and %.6g J are lost",
        j->time, name, coil->name, coil->before, coil->after, impulse, loss_of_currents(s, j));
    return dalcs_names_add(&r->interrupting, name, 0);
}

static enum dalcs_status warn_of_cuts(struct cut *cut) {
    for (int k = 0; k < cut->n; k++) {
        const struct member *coil = cut->member[k].pair >= 0 ? coil_with(cut, k) : NULL;
        if (coil != NULL) {
            DALCS_TRY(warn(cut->r, cut->jump, cut->member[k].pair, coil));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status find_cuts(struct dalcs_run *r, const struct dalcs_euler_jump *j) {
    const struct dalcs_circuit *c = &r->s->circuit;
    size_t n_devices = (size_t)c->n_devices;
    struct dalcs_arena work = {0};
    struct dalcs_branch_graph graph;
    struct cut cut = {.r = r,
                      .jump = j,
                      .member = dalcs_arena_alloc(&work, n_devices, sizeof(*cut.member)),
                      .branch = dalcs_arena_alloc(&work, n_devices, sizeof(*cut.branch)),
                      .block = dalcs_arena_alloc(&work, n_devices, sizeof(int))};
    int *whole = dalcs_arena_alloc(&work, (size_t)c->n_nodes, sizeof(int));
    enum dalcs_status status = DALCS_E_NOMEM;
    if (cut.member != NULL && cut.branch != NULL && cut.block != NULL && whole != NULL) {
        dalcs_union_reset(whole, c->n_nodes);
        sort_devices(&cut, whole);
        status = dalcs_branch_graph_setup(&graph, &work, c->n_nodes, cut.n, cut.branch);
    }
    if (status == DALCS_OK) {
        (void)dalcs_branch_graph_blocks(&graph, cut.block);
        status = warn_of_cuts(&cut);
    }
    dalcs_arena_finish(&work);
    return status;
}

/* A system file has no graph: the impulses are read. */
static enum dalcs_status judge_by_flux(struct dalcs_run *r, const struct dalcs_euler_jump *j,
                                       int farthest) {
    const struct dalcs_system *s = &r->s->network.system[j->system];
    const struct member coil = {s->column[farthest].element, -1, j->before[farthest],
                                j->after[farthest]};
    double largest = 0.0;
    for (int d = 0; d < s->n_pairs; d++) {
        largest = fmax(largest, fabs(j->flux[d]));
    }
    for (int d = 0; d < s->n_pairs; d++) {
        if (s->pair[d].kind == DALCS_PAIR_SWITCH && fabs(j->flux[d]) > noticeable * largest) {
            DALCS_TRY(warn(r, j, d, &coil));
        }
    }
    return DALCS_OK;
}

/* The state of a coil that jumps farthest, -1: no current jumps. */
static int farthest_current(const struct dalcs_system *s, const struct dalcs_euler_jump *j) {
    int farthest = -1;
    double most = 0.0;
    for (int x = 0; x < s->n_x; x++) {
        double change = s->column_is_current[x] ? fabs(j->after[x] - j->before[x]) : 0.0;
        farthest = change > most ? x : farthest;
        most = fmax(most, change);
    }
    return farthest;
}

static bool has_quiet_switch(const struct dalcs_run *r, const struct dalcs_system *s,
                             const uint64_t *mode) {
    bool has = false;
    for (int d = 0; d < s->n_pairs && !has; d++) {
        has = s->pair[d].kind == DALCS_PAIR_SWITCH && !dalcs_mode_has(mode, d) &&
              dalcs_names_find(&r->interrupting, s->pair[d].element) < 0;
    }
    return has;
}

enum dalcs_status dalcs_note_jump(void *user, const struct dalcs_euler_jump *j) {
    struct dalcs_run *r = user;
    const struct dalcs_system *s = &r->s->network.system[j->system];
    int farthest = farthest_current(s, j);
    if (farthest >= 0 && has_quiet_switch(r, s, j->mode)) {
        DALCS_TRY(r->s->circuit.n_devices > 0 ? find_cuts(r, j) : judge_by_flux(r, j, farthest));
    }
    if (r->transient.impulses != NULL) {
        dalcs_impulses_note(r->transient.impulses, j);
    }
    if (r->transient.losses != NULL) {
        DALCS_TRY(dalcs_losses_run_jump(r->transient.losses, j));
    }
    return dalcs_event_log_jump(&r->s->results.recorder.log, j);
}

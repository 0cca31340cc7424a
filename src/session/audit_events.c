/* audit_events.c - compares events and jumps of the report with both sides of the instant. */
#include "audit_reader.h"

#include "audit_told.h"

/* Instructions of a comparison, about, and of a device in it; of an instant at which something happens, and what
 * comparisons may cost of it. */
static const double look_work = 1500.0, device_work = 300.0, instant_work = 10000.0, share = 0.005;

/* Instants of which something is told that are compared whatever that costs. */
enum { FEW = 4 };

/* Of the report, that are looked at for what was told last of a device; and of a jump, states: each takes work in proportion
 * to the circuit. */
enum { MOST_EVENTS = 64, MOST_STATES = 32 };

static int device_of(const struct dalcs_circuit *c, const char *name) {
    int k = c->n_devices - 1;
    while (k >= 0 && strcmp(c->device[k].name, name) != 0) {
        k--;
    }
    return k;
}

static int part_of(const struct dalcs_audit_run *a, int device) {
    const int k = device >= 0 ? a->run->s->network.readout->device_system[device] : -1;
    return k >= 0 && a->radau->part[k].kind == DALCS_PART_STEPPED ? k : -1;
}

/* The values before t, if the part's segment ended at t, and after. */
static void read_both(const struct dalcs_audit_run *a, int part, double t) {
    dalcs_audit_look_before(a->audit, part, !a->part[part].was_left);
    dalcs_audit_look_behind(a->audit, part, t);
}

/* ---- Events --------------------------------------------------------------------------------------- */

/* What was told last of a device, of the first n events and not too long ago; NULL: nothing was. */
static const struct dalcs_event *last_event(const struct dalcs_audit_run *a, const char *name,
                                            size_t n) {
    const struct dalcs_event_log *r = &a->run->s->results.recorder.log;
    const size_t first = r->n_events > MOST_EVENTS ? r->n_events - MOST_EVENTS : 0;
    const struct dalcs_event *last = NULL;
    for (size_t k = n; k > first && last == NULL; k--) {
        last = strcmp(r->event[k - 1].element, name) == 0 ? &r->event[k - 1] : NULL;
    }
    return last;
}

/* One with breakdown has events of two branches. */
static bool has_one_pair(const struct dalcs_audit_run *a, int device) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    const struct dalcs_device *d = &c->device[device];
    return d->kind == DALCS_SWITCH || !isfinite(c->models.of_diode[d->model].vrev);
}

static void check_event(const struct dalcs_audit_run *a, int device, double t) {
    const struct dalcs_event_log *r = &a->run->s->results.recorder.log;
    const char *name = a->run->s->circuit.device[device].name;
    const struct dalcs_event *last = last_event(a, name, r->n_events);
    if (last == NULL) {
        return;
    }
    const struct dalcs_event *past = last_event(a, name, (size_t)(last - r->event));
    if (past != NULL && past->on == last->on && has_one_pair(a, device)) {
        dalcs_audit_add_to(a->audit, DALCS_AUDIT_EVENT, device, 1.0,
                           t); /* one between is not told */
        return;
    }
    const bool is_new = last >= r->event + a->told.n_events;
    const double late = is_new ? fabs(last->time - t) : 0.0;
    if (late > 4.0 * a->radau->resolution) { /* over the time that it took from the one before */
        dalcs_audit_add_to(a->audit, DALCS_AUDIT_EVENT, device,
                           late / fmax(t - a->told.time, a->radau->resolution), t);
    } else {
        dalcs_audit_check_event(a->audit, device, last->on, t);
    }
}

static void check_events(struct dalcs_audit_run *a, double t) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    for (int i = 0; i < a->n_stepped; i++) {
        const int part = a->stepped[i];
        if (!a->part[part].was_left || a->part[part].stretch.stored == NULL) {
            continue;
        }
        const double end = a->radau->part[part].segment.t_end;
        dalcs_audit_look_behind(a->audit, part, t + dalcs_audit_run_chance(a) * (end - t));
        for (int k = 0; k < c->n_devices; k++) {
            const bool is_here = a->run->s->network.readout->device_system[k] == part;
            const bool is_card =
                strchr(c->device[k].name, '(') == NULL; /* else a part of another */
            if (is_here && is_card &&
                (c->device[k].kind == DALCS_SWITCH || c->device[k].kind == DALCS_DIODE)) {
                check_event(a, k, t);
            }
        }
    }
}

/* ---- Jumps ---------------------------------------------------------------------------------------- */

/* The same element in another of these jumps, from one on or up to one; NULL: it is in none. */
static const struct dalcs_jump_state *state_in(const struct dalcs_event_log *r, size_t from,
                                               size_t to, const char *name) {
    const struct dalcs_jump_state *found = NULL;
    for (size_t k = from; k < to; k++) {
        for (size_t i = 0; i < r->jump[k].n_states; i++) {
            found = strcmp(r->jump[k].state[i].element, name) == 0 ? &r->jump[k].state[i] : found;
        }
    }
    return found;
}

static void check_jump(struct dalcs_audit_run *a, size_t number, double t) {
    const struct dalcs_event_log *r = &a->run->s->results.recorder.log;
    const struct dalcs_jump *jump = &r->jump[number];
    const size_t apart = 1 + (jump->n_states - 1) / MOST_STATES;
    for (size_t i = (size_t)(dalcs_audit_run_chance(a) * (double)apart); i < jump->n_states;
         i += apart) {
        const struct dalcs_jump_state *x = &jump->state[i];
        const int device = device_of(&a->run->s->circuit, x->element);
        const int part = part_of(a, device);
        const bool is_coarse = part >= 0 && dalcs_segment_is_coarse(&a->radau->part[part]);
        if (part < 0 || is_coarse || (t > 0.0 && !a->part[part].was_left)) {
            continue;
        }
        read_both(a, part, t);
        const struct dalcs_jump_state *past = state_in(r, a->told.n_jumps, number, x->element);
        const bool is_last = state_in(r, number + 1, r->n_jumps, x->element) == NULL;
        const struct dalcs_audit_jump claim = {.device = device,
                                               .before = x->before,
                                               .after = x->after,
                                               .knows_before = t > 0.0 && past == NULL,
                                               .knows_after = is_last,
                                               .is_alone =
                                                   r->n_jumps == a->told.n_jumps + 1 && t > 0.0,
                                               .energy_lost = jump->energy_lost};
        dalcs_audit_check_told_jump(a->audit, part, &claim, t);
    }
}

/* ---- At an instant -------------------------------------------------------------------------------- */

void dalcs_audit_run_told_now(struct dalcs_audit_run *a, double t) {
    const struct dalcs_event_log *r = &a->run->s->results.recorder.log;
    struct audit_told *told = &a->told;
    const int n = a->run->s->circuit.n_devices;
    const bool is_full = a->run->options->audit == DALCS_AUDIT_FULL;
    told->credit += share * instant_work;
    if (is_full || told->n_looked < FEW || told->credit >= told->threshold) {
        for (size_t k = told->n_jumps; k < r->n_jumps; k++) {
            check_jump(a, k, t);
        }
        if (t > 0.0 && r->n_events_dropped == 0) {
            check_events(a, t);
        }
        told->n_looked++;
        const double work = look_work + device_work * n;
        told->credit -= work;
        told->threshold = 2.0 * work * dalcs_audit_run_chance(a);
    }
    dalcs_audit_run_tell(a, t);
}

void dalcs_audit_run_tell(struct dalcs_audit_run *a, double t) {
    a->told.n_events = a->run->s->results.recorder.log.n_events;
    a->told.n_jumps = a->run->s->results.recorder.log.n_jumps;
    a->told.time = t;
}

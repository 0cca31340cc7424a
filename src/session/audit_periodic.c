/* audit_periodic.c - what .ac behind .pss has found, piece after piece of the period. */
#include "audit_periodic.h"

#include "congruential.h"
#include "magnitudes.h"
#include "pi.h"
#include "rounding.h"

#include <math.h>

/* By default the laws of so many pieces of a period are asked, and as many events. */
enum { MOST_PIECES = 4 };

/* ---- Events -------------------------------------------------------------------------------------- */

/* Pairs of a device; 0: of one that is no switch and no diode of two sides. */
static int n_simple(const struct dalcs_circuit *c, const struct dalcs_device *d) {
    const bool is_diode = d->kind == DALCS_DIODE && !isfinite(c->models.of_diode[d->model].vrev);
    const bool is_switch =
        d->kind == DALCS_SWITCH && !isfinite(c->models.of_switch[d->model].ilimit);
    return d->behaviour == NULL && (is_diode || is_switch) ? 1 : 0;
}

/* Which diodes and switches have another side behind; others are causes that no guard tells. */
static void find_changes(struct dalcs_audit_periodic *a, struct dalcs_response_event *e,
                         const struct dalcs_orbit_segment *before,
                         const struct dalcs_orbit_segment *behind) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    const struct dalcs_system *s = a->look.response->flow->system;
    int n_changed = 0;
    for (int k = 0; k < s->n_pairs; k++) {
        n_changed += dalcs_mode_has(before->mode, k) != dalcs_mode_has(behind->mode, k) ? 1 : 0;
    }
    for (int d = 0; d < c->n_devices; d++) {
        const int pair =
            a->of.are_there[d] && n_simple(c, &c->device[d]) > 0 ? a->readout->first_pair[d] : -1;
        const bool was = pair >= 0 && dalcs_mode_has(before->mode, pair);
        const bool is = pair >= 0 && dalcs_mode_has(behind->mode, pair);
        a->of.change[d] = (signed char)(is - was);
        n_changed -= is != was ? 1 : 0;
    }
    e->has_other_causes = n_changed > 0 || a->log->gates != NULL;
}

static bool has_edge(const struct dalcs_circuit *c, double t) {
    bool any = false;
    for (int k = 0; k < c->n_stimuli && !any; k++) {
        any = dalcs_stimulus_jumps_at(&c->stimulus[k], t);
    }
    return any;
}

/* From the end of a piece to the beginning of another one, at t before it and at `begin` behind: 0 of the period's end. */
static void look_across(struct dalcs_audit_periodic *a, struct dalcs_periodic_side *behind,
                        bool is_inside, double t, double begin) {
    const double complex back = cexp(-I * fmod(a->look.w * t, dalcs_two_pi));
    struct dalcs_response_event e = {
        .is = {&a->end.is, &behind->is}, .late = a->look.late * back, .changes = a->of.change};
    for (int d = 0; d < a->readout->n_devices; d++) {
        a->of.change[d] = 0;
    }
    if (!is_inside) {
        dalcs_periodic_values_orbit(a, t, DALCS_LEFT, &a->end);
        dalcs_periodic_values_orbit(a, begin, DALCS_RIGHT, behind);
        if (a->end.segment == NULL || behind->segment == NULL) {
            a->laws.n_not_checked++;
            return;
        }
        e.at[0] = &a->end.at;
        e.at[1] = &behind->at;
        e.is_at_edge = has_edge(&a->run->s->circuit, t) || has_edge(&a->run->s->circuit, begin);
        find_changes(a, &e, a->end.segment, behind->segment);
        dalcs_periodic_means_note_jump(a, behind);
    }
    dalcs_response_audit_event(&a->laws, &e);
}

/* ---- Pieces -------------------------------------------------------------------------------------- */

/* At a node that is drawn, between the start and the end. */
static enum dalcs_status look_inside(struct dalcs_audit_periodic *a,
                                     const struct dalcs_piece_passed *passed) {
    const struct dalcs_collocation *method = a->look.response->flow->stages.method;
    const int node = 1 + (int)(dalcs_congruential_chance(&a->seed) * (method->s - 1));
    const double t = passed->piece->t + method->node[node] * passed->piece->map->h;
    dalcs_periodic_values_orbit(a, t, DALCS_LEFT, &a->start);
    if (a->start.segment == NULL) {
        a->laws.n_not_checked++;
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_response_audit_settle(&a->laws, t, &a->start.at));
    dalcs_periodic_values_small(a, passed, node, true, &a->start.is);
    dalcs_response_audit_look(&a->laws, a->look.w, &a->start.is);
    return DALCS_OK;
}

/* Does nothing happen between a piece and the next one? Charge may jump through a diode that is open before and behind. */
static bool goes_on(const struct dalcs_periodic_flow *flow, const struct dalcs_flow_piece *piece) {
    return piece->end == NULL && piece + 1 < flow->pieces.piece + flow->pieces.n &&
           piece[1].jump == NULL &&
           dalcs_mode_is(piece->map->mode, piece[1].map->mode, flow->stages.n_words);
}

/* The first time all events are looked at, later some, and the end of the period. */
static bool is_event_drawn(struct dalcs_audit_periodic *a, int piece) {
    const int n = a->look.response->flow->pieces.n;
    return a->seen[a->look.part].looks == 0 || piece + 1 == n ||
           a->run->options->audit == DALCS_AUDIT_FULL ||
           dalcs_congruential_chance(&a->seed) * n < (double)MOST_PIECES;
}

static enum dalcs_status look_at(struct dalcs_audit_periodic *a,
                                 const struct dalcs_piece_passed *passed) {
    const struct dalcs_periodic_flow *flow = a->look.response->flow;
    const struct dalcs_flow_piece *piece = passed->piece;
    const int k = (int)(piece - flow->pieces.piece);
    const bool goes = goes_on(flow, piece);
    const bool is_drawn =
        a->run->options->audit == DALCS_AUDIT_FULL ||
        dalcs_congruential_chance(&a->seed) * flow->pieces.n < (double)MOST_PIECES;
    if (k == 0) {
        dalcs_periodic_values_small(a, passed, 0, false, &a->first.is);
    } else if (a->look.last != NULL) {
        dalcs_periodic_values_small(a, passed, 0, false, &a->start.is);
        look_across(a, &a->start, goes_on(flow, a->look.last), piece->t, piece->t);
    }
    if (k > 0 && a->look.late != 0.0) {
        dalcs_periodic_means_add_impulse(a, k - 1, a->look.late, piece->t);
    }
    DALCS_TRY(dalcs_periodic_means_add_piece(a, passed));
    DALCS_TRY(is_drawn ? look_inside(a, passed) : DALCS_OK);
    a->look.event = k;
    a->look.late = passed->late;
    a->look.last = (goes ? is_drawn : is_event_drawn(a, k)) ? piece : NULL;
    if (a->look.last != NULL) {
        dalcs_periodic_values_small(a, passed, flow->stages.layout.n_nodes - 1, false, &a->end.is);
    }
    return DALCS_OK;
}

static void passed(void *user, const struct dalcs_piece_passed *passed) {
    struct dalcs_audit_periodic *a = user;
    if (a->look.status == DALCS_OK) {
        a->look.status = look_at(a, passed);
    }
}

/* ---- Frequencies --------------------------------------------------------------------------------- */

void dalcs_audit_periodic_begin(struct dalcs_audit_periodic *a, int part,
                                struct dalcs_periodic_response *response, double w, int sideband) {
    const long number = a->look.number + 1;
    const double other = w + sideband * dalcs_two_pi / response->flow->period;
    a->look = (struct dalcs_periodic_look){
        .part = part, .number = number, .response = response, .w = w, .other = other};
    a->laws.worst = (struct dalcs_response_finding){0};
    a->laws.small.volts = a->laws.small.amperes = 0.0;
    dalcs_periodic_values_choose(a);
    if (a->seen[part].jump == NULL) {
        a->seen[part].jump = dalcs_arena_alloc(&a->arena, (size_t)response->flow->pieces.n,
                                               sizeof *a->seen[part].jump);
        a->look.status = a->seen[part].jump != NULL ? DALCS_OK : DALCS_E_NOMEM;
    }
    response->listener.user = a;
    response->listener.passed = passed;
}

enum dalcs_status dalcs_audit_periodic_end(struct dalcs_audit_periodic *a,
                                           struct dalcs_periodic_response *response,
                                           double frequency) {
    response->listener.passed = NULL;
    DALCS_TRY(a->look.status);
    if (response->resting != NULL) { /* there is no linear response, and a warning will say so */
        return DALCS_OK;
    }
    if (a->look.last != NULL) {
        look_across(a, &a->first, false, response->flow->period, 0.0);
        dalcs_periodic_means_add_impulse(a, a->look.event, a->look.late, response->flow->period);
    }
    a->seen[a->look.part].looks++;
    DALCS_TRY(dalcs_audit_response_tell(a->run, &a->laws, frequency));
    return dalcs_periodic_means_check(a, frequency);
}

bool dalcs_audit_periodic_asks(struct dalcs_audit_periodic *a, int k) {
    return a->readout != NULL && dalcs_audit_response_draws(&a->rows, k);
}

enum dalcs_status dalcs_audit_periodic_row(struct dalcs_audit_periodic *a, double frequency,
                                           const double *row) {
    dalcs_audit_response_read(&a->rows);
    return dalcs_audit_response_row(&a->rows, frequency, row);
}

/* ---- Start --------------------------------------------------------------------------------------- */

bool dalcs_audit_periodic_is_asked(const struct dalcs_run *r) {
    return r->options->audit != DALCS_AUDIT_OFF && r->s->network.readout != NULL;
}

enum dalcs_status dalcs_audit_periodic_start(struct dalcs_audit_periodic *a,
                                             const struct dalcs_audit_periodic_asked *asked) {
    struct dalcs_run *r = asked->run;
    const size_t n_stimuli = (size_t)r->s->circuit.n_stimuli;
    *a = (struct dalcs_audit_periodic){.run = r, .log = asked->log};
    if (!dalcs_audit_periodic_is_asked(r) || !asked->log->is_exact) {
        return DALCS_OK;
    }
    a->readout = r->s->network.readout;
    a->source = dalcs_arena_alloc(&a->arena, n_stimuli + 1, sizeof *a->source);
    DALCS_TRY(a->source != NULL ? DALCS_OK : DALCS_E_NOMEM);
    for (size_t k = 0; k < n_stimuli; k++) {
        a->source[k] = asked->log->sources.of(asked->log->sources.user, (int)k);
    }
    DALCS_TRY(dalcs_periodic_values_make(a));
    a->seen = dalcs_arena_alloc(&a->arena, (size_t)asked->log->n_parts, sizeof *a->seen);
    DALCS_TRY(a->seen != NULL ? DALCS_OK : DALCS_E_NOMEM);
    for (size_t k = 0; k < a->work.n_columns; k++) {
        a->work.weight[k] = 0.5 + dalcs_congruential_chance(&a->seed);
    }
    DALCS_TRY(dalcs_audit_response_rows(&a->rows, r, asked->euler, asked->of, asked->n));
    const struct dalcs_response_devices devices = {a->of.are_there, a->of.are_restless};
    DALCS_TRY(
        dalcs_response_audit_start(&a->laws, &r->s->circuit, &devices, &a->first.at, r->tolerance));
    a->laws.source = a->source;
    a->laws.rounding *= dalcs_beyond; /* a period is a product of as many maps as it has pieces */
    a->laws.orbit.tolerance = asked->orbit_tolerance;
    return DALCS_OK;
}

void dalcs_audit_periodic_finish(struct dalcs_audit_periodic *a) {
    dalcs_response_audit_finish(&a->laws);
    dalcs_audit_response_finish(&a->rows);
    HASH_CLEAR(hh, a->means);
    dalcs_arena_finish(&a->arena);
    *a = (struct dalcs_audit_periodic){0};
}

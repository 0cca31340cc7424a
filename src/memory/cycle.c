/* cycle.c - segments of a period, put together to one affine map and what it is held to. */
#include "cycle.h"

#include "affine.h"
#include "clearance.h"
#include "extremes.h"
#include "present.h"
#include "quads.h"
#include "recurrence.h"
#include "rounding.h"
#include "transition.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Spans of a period, and doubles of all conditions on its start, at most. */
enum { MOST_SEGMENTS = 32, MOST_DOUBLES = 1 << 16 };

/* Fewer segments that recur in a row are looked at no further: between two events there are some in most periods. */
enum { FEWEST_IN_A_ROW = 4 };

/* Fewer periods are not worth the look at the conditions. */
static const double fewest_periods = 2.0;

/* Segments until it is tried again, after it was in vain, at most. */
enum { MOST_PATIENCE = 64 };

struct cycle_segment {
    struct dalcs_stage_brief *brief;
    struct dalcs_leap_moment began;
    struct dalcs_affine_rows last;      /* states at its end */
    struct dalcs_affine_rows condition; /* what must not be negative */
    bool is_composed; /* the following are known, of the period that begins with it */
    struct dalcs_affine_rows period_last;
    struct dalcs_affine_quads period_condition; /* in parts of the states' scales */
    int n_events;
    struct dalcs_leap_event *event; /* of that period */
};

struct dalcs_cycle {
    double period; /* s; 0: there is none */
    int at;        /* the present one */
    int in_a_row;  /* segments that recurred, up to the present one */
    int n;
    bool is_closed; /* they have come back to the first */
    int n_taken;    /* of those whose rows are known: one after the other, in the next period */
    struct cycle_segment segment[MOST_SEGMENTS];
    uint64_t *mode;    /* [MOST_SEGMENTS][n_words] */
    double *tail;      /* [n_in - n_x] inputs of all steps that are no states */
    double *x, *later; /* [n_x] work, as are these */
    double *near, *most;
    int waits, patience;
    struct dalcs_leap leap;
};

/* ---- Room -------------------------------------------------------------------------------------- */

/* The only part that steps, if its periods may be put together; NULL: none. Pairs of formulas are told of
 * otherwise than others. */
static struct dalcs_radau_part *find_cycling(const struct dalcs_radau *r) {
    struct dalcs_radau_part *only = NULL;
    int n_stepped = 0;
    for (int k = 0; k < r->n_parts; k++) {
        if (r->part[k].kind == DALCS_PART_STEPPED) {
            only = &r->part[k];
            n_stepped++;
        }
    }
    bool may_be = n_stepped == 1 && only->component->system->n_x > 0 && only->commands.n > 0 &&
                  r->options.fixed_step == 0.0;
    for (int d = 0; may_be && d < only->component->system->n_pairs; d++) {
        may_be = !only->component->system->pair[d].is_formula;
    }
    return may_be ? only : NULL;
}

enum dalcs_status dalcs_cycle_setup(struct dalcs_radau *r) {
    struct dalcs_radau_part *part = r->cycling = find_cycling(r);
    if (part == NULL) {
        return DALCS_OK;
    }
    struct dalcs_arena *arena = &part->arena;
    const size_t n_x = (size_t)part->component->system->n_x;
    const size_t n_modes = MOST_SEGMENTS * (size_t)part->component->osnsp.n_words;
    struct dalcs_cycle *cycle = part->memory.cycle = dalcs_arena_alloc(arena, 1, sizeof(*cycle));
    if (cycle == NULL) {
        return DALCS_E_NOMEM;
    }
    cycle->patience = 1;
    cycle->leap.system = part->component->system;
    cycle->tail = dalcs_arena_alloc(arena, (size_t)part->stages.n_in - n_x, sizeof(double));
    cycle->x = dalcs_arena_alloc(arena, n_x, sizeof(double));
    cycle->later = dalcs_arena_alloc(arena, n_x, sizeof(double));
    cycle->near = dalcs_arena_alloc(arena, n_x, sizeof(double));
    cycle->most = dalcs_arena_alloc(arena, n_x, sizeof(double));
    cycle->mode = dalcs_arena_alloc(arena, n_modes, sizeof(uint64_t));
    bool complete = cycle->tail != NULL && cycle->x != NULL && cycle->later != NULL &&
                    cycle->near != NULL && cycle->most != NULL && cycle->mode != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

static void forget(struct dalcs_radau_part *part) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    for (int k = 0; k < cycle->n; k++) {
        struct cycle_segment *segment = &cycle->segment[k];
        free(segment->last.row);
        free(segment->condition.row);
        free(segment->period_last.row);
        free(segment->period_condition.number);
        free(segment->event);
        *segment = (struct cycle_segment){0};
    }
    cycle->n = 0;
    cycle->n_taken = 0;
    part->memory.cycles = cycle->is_closed = false;
}

void dalcs_cycle_finish(struct dalcs_radau_part *part) {
    if (part->memory.cycle != NULL) {
        forget(part);
        part->memory.cycle = NULL;
    }
}

/* ---- The segments of a period ------------------------------------------------------------------ */

/* The commands that moved at part->segment.t; false: something else began the segment, or too many. */
static bool find_moves(const struct dalcs_radau_part *part, struct dalcs_leap_moment *moment) {
    bool is_exact = false;
    moment->n_moves = 0;
    for (int k = 0; k < part->commands.n; k++) {
        const struct dalcs_command *m = &part->commands.command[k];
        int way = m->is_on ? 0 : 1;
        double time = m->n[way] > 0 ? dalcs_command_time(m, way, m->n[way] - 1) : -1.0;
        if (!(fabs(time - part->segment.t) <= dalcs_rounded * part->segment.t)) {
            continue;
        }
        if (moment->n_moves == DALCS_MOST_MOVES) {
            return false;
        }
        moment->move[moment->n_moves].command = m;
        moment->move[moment->n_moves++].way = way;
        is_exact = is_exact || time == part->segment.t;
    }
    return is_exact;
}

/* Inputs beside the states are the same in all steps: no source is on a ramp. */
static bool is_tail(const struct dalcs_radau_part *part, bool is_first) {
    const struct dalcs_excitation *e = &part->excitation;
    double *tail = part->memory.cycle->tail;
    int n_x = part->component->system->n_x;
    const double *in = part->segment.in + n_x;
    size_t bytes = (size_t)(part->stages.n_in - n_x) * sizeof(double);
    for (int f = 0; f < e->n_functions; f++) {
        if (e->function[f].shape != DALCS_EXCITATION_LEVEL && in[1 + f] != 0.0) {
            return false;
        }
    }
    if (is_first) {
        memcpy(tail, in, bytes);
    }
    return memcmp(tail, in, bytes) == 0;
}

/* sign * row `which` of a brief map - bound, for this tail. */
static double *put_row(const struct dalcs_radau_part *part, const struct dalcs_stage_brief *brief,
                       int which, double sign, double bound, double *row) {
    int n_x = part->component->system->n_x;
    double constant = dalcs_stage_brief_row(&part->stages, brief, which, part->segment.in, row);
    for (int k = 0; k < n_x; k++) {
        row[k] *= sign;
    }
    row[n_x] = sign * constant - bound;
    return row + n_x + 1;
}

static enum dalcs_status take_last(const struct dalcs_radau_part *part,
                                   struct cycle_segment *segment) {
    int n_x = part->component->system->n_x;
    double *row = dalcs_alloc((size_t)n_x * (size_t)(n_x + 1), sizeof(double));
    segment->last = (struct dalcs_affine_rows){n_x, row};
    for (int x = 0; x < n_x && row != NULL; x++) {
        row = put_row(part, segment->brief, x, 1.0, 0.0, row);
    }
    return row != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* What recurrence.c asks of the step: of states at its end and their drift, of guards. */
static enum dalcs_status take_conditions(const struct dalcs_radau_part *part,
                                         struct cycle_segment *segment) {
    const struct dalcs_system *s = part->component->system;
    int n_nodes = part->stages.layout.n_nodes;
    int n_guards = s->n_pairs + part->stages.n_watched;
    size_t most = (size_t)(4 * s->n_x + n_guards * n_nodes);
    double *row = dalcs_alloc(most * (size_t)(s->n_x + 1), sizeof(double));
    segment->condition.row = row;
    if (row == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int x = 0; x < s->n_x; x++) {
        double most_last;
        double most_drift;
        dalcs_recurrence_limits(part, segment->brief, x, &most_last, &most_drift);
        for (double sign = -1.0; sign <= 1.0; sign += 2.0) {
            row = put_row(part, segment->brief, x, sign, -most_last, row);
            row = put_row(part, segment->brief, s->n_x + x, sign, -most_drift, row);
        }
    }
    int which = 2 * s->n_x;
    for (int g = 0; g < n_guards; g++) {
        double sign;
        double bound;
        if (dalcs_guards_clearance(part, g, &sign, &bound)) {
            for (int k = 0; k < n_nodes; k++) {
                row = put_row(part, segment->brief, which++, sign, bound, row);
            }
        }
    }
    segment->condition.n = (int)((row - segment->condition.row) / (s->n_x + 1));
    return DALCS_OK;
}

/* The present segment is the next one of a period. */
static void append(struct dalcs_radau_part *part, const struct dalcs_leap_moment *began) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    size_t n_words = (size_t)part->component->osnsp.n_words;
    memcpy(cycle->mode + (size_t)cycle->n * n_words, part->component->osnsp.mode,
           n_words * sizeof(uint64_t));
    cycle->segment[cycle->n++] =
        (struct cycle_segment){.brief = dalcs_transition_known(part)->span.brief, .began = *began};
}

static bool is_segment(const struct dalcs_radau_part *part, int k,
                       const struct dalcs_leap_moment *began) {
    const struct cycle_segment *segment = &part->memory.cycle->segment[k];
    bool is = segment->brief == dalcs_transition_known(part)->span.brief &&
              segment->began.n_moves == began->n_moves;
    for (int i = 0; i < began->n_moves && is; i++) {
        is = segment->began.move[i].command == began->move[i].command &&
             segment->began.move[i].way == began->move[i].way;
    }
    return is;
}

static enum dalcs_status take_rows(struct dalcs_radau_part *part) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    struct cycle_segment *segment = &cycle->segment[cycle->at];
    DALCS_TRY(take_last(part, segment));
    DALCS_TRY(take_conditions(part, segment));
    cycle->n_taken++;
    part->memory.cycles = cycle->n_taken == cycle->n;
    return DALCS_OK;
}

enum dalcs_status dalcs_cycle_note(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    /* A ledger of energies needs every segment. */
    bool recurred = r->base->observer == NULL && part->segment.brief != NULL &&
                    part->segment.brief == dalcs_transition_known(part)->span.brief;
    cycle->in_a_row = recurred ? cycle->in_a_row + 1 : 0;
    if (cycle->in_a_row < FEWEST_IN_A_ROW) {
        if (cycle->n > 0) {
            forget(part);
        }
        return DALCS_OK;
    }
    if (cycle->n == 0) {
        cycle->period = dalcs_commands_period(&part->commands);
    }
    struct dalcs_leap_moment began;
    if (!(cycle->period > 0.0 && is_tail(part, cycle->n == 0) && find_moves(part, &began))) {
        forget(part);
        return DALCS_OK;
    }
    int next = cycle->is_closed ? (cycle->at + 1) % cycle->n : 0;
    if (cycle->n > 0 && is_segment(part, next, &began)) {
        cycle->is_closed = true;
        cycle->at = next;
        return cycle->n_taken < cycle->n ? take_rows(part) : DALCS_OK;
    }
    if (cycle->is_closed || cycle->n == MOST_SEGMENTS) {
        forget(part);
    }
    append(part, &began);
    return DALCS_OK;
}

/* ---- One map for a period ---------------------------------------------------------------------- */

/* Divides a condition by what a change of the states by their scales may make of it; false: no change does. */
static bool normalise(int n_x, const double *scale, long double *row) {
    long double most = 0.0L;
    for (int k = 0; k < n_x; k++) {
        most += fabsl(row[k]) * scale[k];
    }
    for (int k = 0; k <= n_x && most > 0.0L; k++) {
        row[k] /= most;
    }
    return most > 0.0L || row[n_x] < 0.0L;
}

/* The conditions of a segment on the states at the start of the period, from where `inner` leads. */
static void add_conditions(const struct dalcs_radau_part *part, const struct cycle_segment *of,
                           const long double *inner, long double *work,
                           struct dalcs_affine_quads *all) {
    int n_x = part->component->system->n_x;
    dalcs_affine_compose(n_x, &of->condition, inner, work);
    for (int i = 0; i < of->condition.n; i++) {
        const long double *row = work + i * (n_x + 1);
        if (normalise(n_x, part->scales.column, work + i * (n_x + 1))) {
            dalcs_affine_quads_put(n_x, row, all);
        }
    }
}

static void compose_maps(const struct dalcs_radau_part *part, int first, long double *inner,
                         long double *work) {
    const struct dalcs_cycle *cycle = part->memory.cycle;
    struct cycle_segment *segment = &part->memory.cycle->segment[first];
    int n_x = part->component->system->n_x;
    size_t bytes = (size_t)n_x * (size_t)(n_x + 1) * sizeof(*inner);
    for (int k = 0; k < n_x * (n_x + 1); k++) {
        inner[k] = k % (n_x + 2) == 0 ? 1.0L : 0.0L;
    }
    for (int i = 0; i < cycle->n; i++) {
        const struct cycle_segment *of = &cycle->segment[(first + i) % cycle->n];
        add_conditions(part, of, inner, work, &segment->period_condition);
        dalcs_affine_compose(n_x, &of->last, inner, work);
        memcpy(inner, work, bytes);
    }
    dalcs_affine_quads_fill_up(n_x, &segment->period_condition);
    dalcs_affine_round(n_x, n_x, inner, segment->period_last.row);
}

/* What changes sides where the k-th segment ends and the next begins. */
static void list_changes(const struct dalcs_radau_part *part, int k, struct cycle_segment *of) {
    const struct dalcs_cycle *cycle = part->memory.cycle;
    int n_words = part->component->osnsp.n_words;
    int next = (k + 1) % cycle->n;
    const uint64_t *from = cycle->mode + k * n_words;
    const uint64_t *to = cycle->mode + next * n_words;
    for (int d = 0; d < part->component->system->n_pairs; d++) {
        bool is_on = dalcs_mode_has(to, d);
        if (is_on != dalcs_mode_has(from, d)) {
            of->event[of->n_events++] =
                (struct dalcs_leap_event){&cycle->segment[next].began, d, is_on};
        }
    }
}

/* What is known of the period that begins with the present segment. false: it is too large. */
static enum dalcs_status compose_period(const struct dalcs_radau_part *part, bool *done) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    struct cycle_segment *segment = &cycle->segment[cycle->at];
    const struct dalcs_system *s = part->component->system;
    size_t width = (size_t)s->n_x + 1;
    int n = 0;
    int most = s->n_x;
    for (int k = 0; k < cycle->n; k++) {
        n += cycle->segment[k].condition.n;
        most = most < cycle->segment[k].condition.n ? cycle->segment[k].condition.n : most;
    }
    *done = (size_t)n * width * (size_t)cycle->n <= MOST_DOUBLES;
    if (!*done) {
        return DALCS_OK;
    }
    segment->period_last.row = dalcs_alloc((size_t)s->n_x * width, sizeof(double));
    segment->period_condition.number =
        dalcs_alloc((size_t)dalcs_quads_of(n) * width, sizeof(double));
    segment->event = dalcs_alloc((size_t)(s->n_pairs * cycle->n), sizeof(*segment->event));
    long double *inner = dalcs_alloc((size_t)(s->n_x + most) * width, sizeof(*inner));
    if (segment->period_last.row == NULL || segment->period_condition.number == NULL ||
        segment->event == NULL || inner == NULL) {
        free(inner);
        return DALCS_E_NOMEM;
    }
    segment->period_last.n = s->n_x;
    compose_maps(part, cycle->at, inner, inner + (size_t)s->n_x * width);
    for (int i = 0; i < cycle->n; i++) {
        list_changes(part, (cycle->at + i) % cycle->n, segment);
    }
    segment->is_composed = true;
    free(inner);
    return DALCS_OK;
}

/* ---- Periods ----------------------------------------------------------------------------------- */

/* How far states may move from x, cycle->most; false: not at all. */
static bool look_around(const struct dalcs_radau_part *part, const double *x) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    int n_x = part->component->system->n_x;
    double room = dalcs_affine_quads_least(n_x, &cycle->segment[cycle->at].period_condition, x);
    for (int k = 0; k < n_x; k++) {
        cycle->near[k] = x[k];
        cycle->most[k] = room * part->scales.column[k];
    }
    return room > 0.0;
}

/* Takes the states of the present segment to those that it has periods later, as many as may be, and from
 * which a period holds, too. */
static long go_on(const struct dalcs_radau_part *part, long most) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    const double *map = cycle->segment[cycle->at].period_last.row;
    int n_x = part->component->system->n_x;
    double *states[2] = {cycle->x, cycle->later};
    long n = 0;
    memcpy(states[0], part->x, (size_t)n_x * sizeof(double));
    bool holds = look_around(part, states[0]);
    while (holds && n < most) {
        n += dalcs_affine_pass(n_x, map, cycle->near, cycle->most, most - n, states);
        holds = n < most && look_around(part, states[1]);
        if (holds) {
            dalcs_affine_swap(states);
            n++;
        }
    }
    memcpy(part->x, states[0], (size_t)n_x * sizeof(double));
    return n;
}

/* Currents need no closer look: no state has a lever on them, as far as is known (current_error.c). */
static bool has_no_lever(const struct dalcs_radau_part *part) {
    bool none = true;
    for (int k = 0; k < part->memory.cycle->n && part->stages.n_levered > 0 && none; k++) {
        none = *dalcs_stage_note(part->memory.cycle->segment[k].brief->entry) > 0;
    }
    return none;
}

/* Periods until the present segment begins before `until` for the last time, and ends before an edge or the
 * stop time. */
static double periods_until(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                            double until) {
    double near = 4.0 * r->resolution;
    double edge = dalcs_smaller(part->excitation.next_edge, r->options.stop);
    double room = dalcs_smaller(until - near - part->segment.t, edge - near - part->segment.t_end);
    return floor(room / part->memory.cycle->period);
}

/* s; when the present segment begins n periods later. */
static double start_later(struct cycle_segment *segment, long n) {
    for (int i = 0; i < segment->began.n_moves; i++) {
        segment->began.move[i].n = segment->began.move[i].command->n[segment->began.move[i].way];
    }
    return dalcs_leap_time(&segment->began, n - 1);
}

/* The present segment, with part->x as its state, n periods later. */
static void put_off(struct dalcs_radau *r, struct dalcs_radau_part *part, long n) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    struct cycle_segment *segment = &cycle->segment[cycle->at];
    cycle->leap.n_periods = n;
    cycle->leap.n_steps = n * cycle->n;
    cycle->leap.n_events = segment->n_events;
    cycle->leap.event = segment->event;
    for (int k = 0; k < cycle->n; k++) {
        struct dalcs_leap_moment *began = &cycle->segment[k].began;
        for (int i = 0; i < began->n_moves; i++) {
            began->move[i].n = began->move[i].command->n[began->move[i].way];
        }
    }
    part->segment.t = start_later(segment, n);
    dalcs_commands_leap(&part->commands, n);
    part->segment.t_end = dalcs_radau_limit(r, part);
    memcpy(part->segment.in, part->x, (size_t)part->component->system->n_x * sizeof(double));
    dalcs_recurrence_begin(part);
    r->steps += cycle->leap.n_steps;
    r->leapt_steps += cycle->leap.n_steps;
}

/* Takes the states of the present segment as many periods on as they may be, *n. */
static enum dalcs_status pass_periods(const struct dalcs_radau *r, double until, double most,
                                      long *n) {
    struct dalcs_radau_part *part = r->cycling;
    struct dalcs_cycle *cycle = part->memory.cycle;
    *n = 0;
    if (cycle->waits > 0) {
        cycle->waits--;
        return DALCS_OK;
    }
    most = dalcs_smaller(most, periods_until(r, part, until));
    if (!(most >= fewest_periods)) {
        return DALCS_OK;
    }
    bool done = true;
    if (!cycle->segment[cycle->at].is_composed) {
        DALCS_TRY(compose_period(part, &done));
    }
    *n = done && has_no_lever(part) ? go_on(part, (long)most) : 0;
    if (*n == 0) {
        cycle->waits = cycle->patience;
        cycle->patience = cycle->patience < MOST_PATIENCE ? 2 * cycle->patience : MOST_PATIENCE;
        return DALCS_OK;
    }
    cycle->patience = 1;
    return DALCS_OK;
}

enum dalcs_status dalcs_cycle_leap(struct dalcs_radau *r, double until, long most_steps,
                                   const struct dalcs_leap **leap) {
    struct dalcs_radau_part *part = r->cycling;
    struct dalcs_cycle *cycle = part->memory.cycle;
    long n;
    *leap = NULL;
    DALCS_TRY(pass_periods(r, until, 1.0 + (double)most_steps / cycle->n, &n));
    if (n > 0) {
        put_off(r, part, n);
        *leap = &cycle->leap;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_cycle_try(const struct dalcs_radau *r, double until, long most_periods,
                                  double *x, double *t) {
    struct dalcs_radau_part *part = r->cycling;
    const size_t bytes = (size_t)part->component->system->n_x * sizeof(double);
    long n;
    memcpy(x, part->x, bytes);
    enum dalcs_status status = pass_periods(r, until, (double)most_periods, &n);
    for (int k = 0; k < part->component->system->n_x; k++) {
        const double before = x[k];
        x[k] = part->x[k];
        part->x[k] = before;
    }
    *t = n > 0 ? start_later(&part->memory.cycle->segment[part->memory.cycle->at], n) : INFINITY;
    return status;
}

int dalcs_cycle_n_segments(const struct dalcs_cycle *cycle) {
    return cycle->n;
}

double dalcs_cycle_period(const struct dalcs_cycle *cycle) {
    return cycle->period;
}

const double *dalcs_cycle_map(const struct dalcs_radau_part *part) {
    return part->memory.cycle->segment[part->memory.cycle->at].period_last.row;
}

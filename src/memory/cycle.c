/* cycle.c - the segments of a period, one after the other, and what each is held to. */
#include "cycle_internal.h"

#include "clearance.h"
#include "present.h"
#include "quads.h"
#include "recurrence.h"
#include "rounding.h"
#include "transition.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Fewer segments that recur in a row do not count: between two events there are some in most periods. */
enum { FEWEST_IN_A_ROW = 4 };

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
    const size_t n_modes = DALCS_CYCLE_MOST_SEGMENTS * (size_t)part->component->osnsp.n_words;
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
        struct dalcs_cycle_segment *segment = &cycle->segment[k];
        free(segment->last.row);
        free(segment->condition.row);
        free(segment->period_last.row);
        free(segment->period_condition.number);
        free(segment->event);
        *segment = (struct dalcs_cycle_segment){0};
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
                                   struct dalcs_cycle_segment *segment) {
    int n_x = part->component->system->n_x;
    double *row = dalcs_alloc((size_t)n_x * (size_t)(n_x + 1), sizeof(double));
    segment->last = (struct dalcs_affine_rows){n_x, row};
    for (int x = 0; x < n_x && row != NULL; x++) {
        row = put_row(part, segment->brief, x, 1.0, 0.0, row);
    }
    return row != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* What recurrence.c reads of the step: of states at its end and their drift, of guards. */
static enum dalcs_status take_conditions(const struct dalcs_radau_part *part,
                                         struct dalcs_cycle_segment *segment) {
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
    cycle->segment[cycle->n++] = (struct dalcs_cycle_segment){
        .brief = dalcs_transition_known(part)->span.brief, .began = *began};
}

static bool is_segment(const struct dalcs_radau_part *part, int k,
                       const struct dalcs_leap_moment *began) {
    const struct dalcs_cycle_segment *segment = &part->memory.cycle->segment[k];
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
    struct dalcs_cycle_segment *segment = &cycle->segment[cycle->at];
    DALCS_TRY(take_last(part, segment));
    DALCS_TRY(take_conditions(part, segment));
    cycle->n_taken++;
    part->memory.cycles = cycle->n_taken == cycle->n;
    return DALCS_OK;
}

enum dalcs_status dalcs_cycle_note(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    /* A ledger of energies needs every segment. */
    bool recurred = r->base->listener.observer == NULL && part->segment.brief != NULL &&
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
    if (cycle->is_closed || cycle->n == DALCS_CYCLE_MOST_SEGMENTS) {
        forget(part);
    }
    append(part, &began);
    return DALCS_OK;
}

/* orbit_near.c - the least that lambda and w of diodes come to between two events of their own. */
#include "orbit_near.h"

#include "magnitudes.h"
#include "step_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of a polynomial that is searched for its least value; each makes the interval shorter by the golden section. */
enum { CUTS = 40 };

/* A diode as the run goes on. */
struct dalcs_near_pair {
    double before;    /* V or A: lambda or w at the last node; before the first one infinite */
    bool falls;       /* since the node before that */
    double peak;      /* the largest since the last low, or since it has this side */
    int last;         /* of p->near.low, since it has this side; -1: none */
    double own[2];    /* w and lambda at their largest */
    bool has_crossed; /* at the end of the last segment */
    bool goes_along;  /* with another that has crossed there */
    bool was_away;    /* before the lows that are looked at, between which it stayed near */
    double begins;    /* V or A: at the first node of the period */

    struct dalcs_near_event {
        double t, rate; /* s; V/s or A/s of its guard, 0: there is none */
        bool was_on;
    } crossed,
        event; /* at the end of the last segment; its own last one, if no command has acted on it since */
};

static int n_pairs_of(const struct dalcs_orbit_part *p) {
    return p->rates.part->component->system->n_pairs;
}

static bool is_diode(const struct dalcs_orbit_part *p, int pair) {
    return p->rates.part->component->system->pair[pair].kind == DALCS_PAIR_DIODE;
}

static enum dalcs_status add_low(struct dalcs_orbit_part *p, int pair, double t, double value) {
    struct dalcs_orbit_near *near = &p->near;
    struct dalcs_near_pair *of = &near->pair[pair];
    DALCS_TRY(dalcs_grow(&near->low, &near->capacity, (size_t)near->n + 1, sizeof *near->low));
    near->low[near->n] = (struct dalcs_orbit_low){.pair = pair,
                                                  .on = dalcs_mode_has(near->mode, pair),
                                                  .is_first = of->last < 0,
                                                  .t = t,
                                                  .value = value,
                                                  .above = {of->peak, INFINITY}};
    if (of->last >= 0) {
        near->low[of->last].above[1] = of->peak;
    }
    of->last = near->n++;
    of->peak = 0.0;
    of->falls = false;
    return DALCS_OK;
}

static double value_at(const struct dalcs_radau_part *part, int row, double theta) {
    double weight[DALCS_MAX_NODES];
    dalcs_collocation_weights(part->stages.method, theta, weight);
    return fabs(dalcs_orbit_weigh(&part->stages.layout, weight, part->segment.out, row));
}

/* The least between two times in the present step. */
static enum dalcs_status find_low(struct dalcs_orbit_part *p, int pair, double from, double to) {
    const struct dalcs_radau_part *part = p->rates.part;
    const int row = dalcs_orbit_guard_row(part, pair);
    const double golden = 0.5 * (sqrt(5.0) - 1.0);
    for (int cut = 0; cut < CUTS && to > from; cut++) {
        const double left = to - golden * (to - from);
        const double right = from + golden * (to - from);
        if (value_at(part, row, left) < value_at(part, row, right)) {
            to = right;
        } else {
            from = left;
        }
    }
    return add_low(p, pair, part->segment.t + 0.5 * (from + to) * part->segment.h,
                   value_at(part, row, 0.5 * (from + to)));
}

/* ---- While the run goes on ----------------------------------------------------------------------- */

static enum dalcs_status begin(struct dalcs_orbit_part *p) {
    struct dalcs_orbit_near *near = &p->near;
    const size_t words = (size_t)p->rates.part->stages.n_words;
    near->pair = dalcs_arena_alloc(&p->log->arena, (size_t)n_pairs_of(p), sizeof *near->pair);
    near->mode = dalcs_arena_alloc(&p->log->arena, words, sizeof *near->mode);
    near->first = dalcs_arena_alloc(&p->log->arena, words, sizeof *near->first);
    if (near->pair == NULL || near->mode == NULL || near->first == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(near->mode, p->rates.part->component->osnsp.mode, words * sizeof *near->mode);
    memcpy(near->first, near->mode, words * sizeof *near->mode);
    for (int k = 0; k < n_pairs_of(p); k++) {
        near->pair[k] =
            (struct dalcs_near_pair){.before = INFINITY, .begins = INFINITY, .last = -1};
    }
    return DALCS_OK;
}

/* At t a command, or an edge, acts on a pair that has just had its own event. Had that not come before, the guard would be on
 * its old side by this much: a signal that moves it as far has the event behind the command, if there is one then. */
static enum dalcs_status meet_command(struct dalcs_orbit_part *p, int pair, double t) {
    struct dalcs_orbit_near *near = &p->near;
    struct dalcs_near_event *event = &near->pair[pair].event;
    const double rate = event->rate;
    event->rate = 0.0;
    if (rate == 0.0 || near->has_crossed || p->log->gates != NULL) {
        return DALCS_OK; /* gates may command because of the event */
    }
    DALCS_TRY(dalcs_grow(&near->low, &near->capacity, (size_t)near->n + 1, sizeof *near->low));
    near->low[near->n++] = (struct dalcs_orbit_low){.pair = pair,
                                                    .on = event->was_on,
                                                    .t = event->t,
                                                    .value = rate * (t - event->t),
                                                    .gap = t - event->t,
                                                    .above = {INFINITY, INFINITY}};
    return DALCS_OK;
}

/* Does it jump to that value, of its lambda or w, from the node before? */
static bool is_moved(const struct dalcs_near_pair *of, double value) {
    return of->event.rate != 0.0 &&
           fabs(value - of->before) > dalcs_small * fmax(value, of->before);
}

/* Does another guard cross in the present segment that this one differs from by a constant, or is a multiple of? Then no signal
 * tells one from the other: a triac's half and the switch in series with it open by one current. */
static bool goes_along(const struct dalcs_radau_part *part, int pair) {
    const struct dalcs_part_guards *g = &part->guards;
    const int stride = part->stages.layout.stride, n = part->stages.layout.n_nodes;
    const double *own = part->segment.out + dalcs_orbit_guard_row(part, pair);
    bool does = false;
    for (int c = 0; c < g->n_crossed && !does; c++) {
        const double *of = part->segment.out + dalcs_orbit_guard_row(part, g->crossed[c]);
        const double by[2] = {own[(n - 1) * stride] - own[stride],
                              of[(n - 1) * stride] - of[stride]};
        does = by[0] != 0.0 && by[1] != 0.0;
        for (int k = 2; k < n - 1 && does; k++) {
            const double part_of_own = (own[k * stride] - own[stride]) / by[0];
            does = fabs(part_of_own - (of[k * stride] - of[stride]) / by[1]) <= dalcs_nothing;
        }
    }
    return does;
}

/* The side of a pair is over. If not by its own event, it was away from 0 behind the last low, or was near until then. */
static enum dalcs_status end_side(struct dalcs_orbit_part *p, int pair, double t) {
    struct dalcs_near_pair *of = &p->near.pair[pair];
    if (of->falls && !of->has_crossed) {
        DALCS_TRY(add_low(p, pair, t, of->before));
    } else if (of->last >= 0) {
        p->near.low[of->last].above[1] = of->has_crossed ? of->peak : INFINITY;
    }
    return DALCS_OK;
}

/* What crossed and stays on its side, as a comparator does whose switch takes it back, has had its event if that changed the
 * mode. */
static enum dalcs_status change_sides(struct dalcs_orbit_part *p, const uint64_t *mode) {
    struct dalcs_orbit_near *near = &p->near;
    const bool is_same = dalcs_mode_is(near->mode, mode, p->rates.part->stages.n_words);
    for (int k = 0; k < n_pairs_of(p) && !is_same; k++) {
        struct dalcs_near_pair *of = &near->pair[k];
        const bool has_turned = dalcs_mode_has(near->mode, k) != dalcs_mode_has(mode, k);
        of->has_crossed = of->has_crossed || (has_turned && of->goes_along);
        if (is_diode(p, k) && (of->has_crossed || has_turned)) {
            DALCS_TRY(end_side(p, k, p->rates.part->segment.t));
            DALCS_TRY(meet_command(p, k, p->rates.part->segment.t));
            of->event = of->has_crossed ? of->crossed : (struct dalcs_near_event){.rate = 0.0};
            of->before = -INFINITY;
            of->falls = false;
            of->peak = 0.0;
            of->last = -1;
        }
        of->has_crossed = false;
    }
    memcpy(near->mode, mode, (size_t)p->rates.part->stages.n_words * sizeof *mode);
    return DALCS_OK;
}

/* At a node, whose values are in p->work_y. */
static enum dalcs_status note_node(struct dalcs_orbit_part *p, int node) {
    const struct dalcs_radau_part *part = p->rates.part;
    const double *at = part->stages.method->node;
    const double from = node > 1 ? at[node - 2] * part->segment.end : 0.0;
    for (int k = 0; k < n_pairs_of(p); k++) {
        struct dalcs_near_pair *of = &p->near.pair[k];
        const double value = is_diode(p, k) ? fabs(p->work_y[dalcs_orbit_guard_row(part, k)]) : 0.0;
        if (node == 0 && of->before >= 0.0 && is_moved(of, value)) {
            DALCS_TRY(meet_command(p, k, part->segment.t));
        }
        of->begins = isinf(of->begins) ? value : of->begins;
        if (value > of->before && of->falls) {
            DALCS_TRY(node == 0 ? add_low(p, k, part->segment.t, of->before)
                                : find_low(p, k, from, at[node] * part->segment.end));
        }
        of->falls = value < of->before || (of->falls && value == of->before);
        of->before = value;
        of->peak = fmax(of->peak, value);
        double *own = &of->own[dalcs_mode_has(p->near.mode, k) ? 1 : 0];
        *own = fmax(*own, value);
    }
    return DALCS_OK;
}

/* The last node may lie behind the least of the polynomial. */
static enum dalcs_status end_segment(struct dalcs_orbit_part *p) {
    const struct dalcs_radau_part *part = p->rates.part;
    p->near.has_crossed = part->guards.n_crossed > 0;
    for (int k = 0; k < n_pairs_of(p); k++) {
        struct dalcs_near_pair *of = &p->near.pair[k];
        const int row = dalcs_orbit_guard_row(part, k);
        of->has_crossed = false;
        for (int c = 0; c < part->guards.n_crossed; c++) {
            of->has_crossed = of->has_crossed || part->guards.crossed[c] == k;
        }
        of->goes_along = !of->has_crossed && of->falls && goes_along(part, k);
        if (of->has_crossed || of->goes_along) {
            of->crossed = (struct dalcs_near_event){.t = part->segment.t_end,
                                                    .rate = fabs(dalcs_orbit_guard_rate(part, row)),
                                                    .was_on = dalcs_mode_has(p->near.mode, k)};
        }
        if (of->falls && !of->has_crossed &&
            dalcs_orbit_guard_rate(part, row) * p->work_y[row] > 0.0) {
            const double from = part->stages.method->node[part->stages.method->s - 1];
            DALCS_TRY(find_low(p, k, from * part->segment.end, part->segment.end));
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_orbit_near_note(struct dalcs_orbit_part *p,
                                        const struct dalcs_orbit_span *span) {
    const struct dalcs_radau_part *part = p->rates.part;
    const struct dalcs_collocation *method = part->stages.method;
    if (p->near.pair == NULL) {
        DALCS_TRY(begin(p));
    }
    if (span->jump != NULL &&
        span->from == part->segment.t) { /* it starts from 0 behind its impulse */
        DALCS_TRY(change_sides(p, span->jump));
    }
    DALCS_TRY(change_sides(p, part->component->osnsp.mode));
    for (int node = 0; node <= method->s; node++) {
        dalcs_step_values(part, part->segment.end * method->node[node], p->work_y);
        DALCS_TRY(note_node(p, node));
    }
    return end_segment(p);
}

/* ---- At its end ---------------------------------------------------------------------------------- */

/* The period begins again: the side that a pair has at its end may go on, and a low at its start has that end before it. */
static enum dalcs_status close_period(struct dalcs_orbit_part *p) {
    struct dalcs_orbit_near *near = &p->near;
    for (int k = 0; k < n_pairs_of(p); k++) {
        struct dalcs_near_pair *of = &near->pair[k];
        const bool goes_on = dalcs_mode_has(near->mode, k) == dalcs_mode_has(near->first, k);
        if (!is_diode(p, k)) {
            continue;
        }
        if (!goes_on) {
            DALCS_TRY(end_side(p, k, p->rates.part->segment.t_end));
        }
        if (!goes_on || is_moved(of, of->begins)) {
            DALCS_TRY(meet_command(p, k, p->rates.part->segment.t_end));
        }
        for (int m = 0; m < near->n; m++) {
            struct dalcs_orbit_low *low = &near->low[m];
            if (low->pair == k && low->t <= p->span[0].from) {
                low->above[0] = goes_on ? of->peak : 0.0;
            }
        }
    }
    return DALCS_OK;
}

/* A diode that comes from its own event, or goes to it, is near to it alone: it was away on both sides of a low. Lows between
 * which it does not go away are one, if it has one side from the first of them to the last. */
static bool is_near(const struct dalcs_orbit_part *p, const struct dalcs_orbit_low *low) {
    struct dalcs_near_pair *of = &p->near.pair[low->pair];
    const double nothing = dalcs_small * of->own[low->on ? 1 : 0];
    const bool stays = of->was_away && !low->is_first && low->value <= nothing;
    of->was_away = low->above[0] > nothing || stays;
    const bool is = of->was_away && low->value <= nothing && low->above[1] > nothing;
    of->was_away = of->was_away && low->value <= nothing && low->above[1] <= nothing;
    return is;
}

enum dalcs_status dalcs_orbit_near_find(struct dalcs_orbit_part *p) {
    int kept = 0;
    DALCS_TRY(p->near.pair != NULL ? close_period(p) : DALCS_OK);
    for (int m = 0; m < p->near.n; m++) {
        if (is_near(p, &p->near.low[m])) {
            p->near.low[kept++] = p->near.low[m];
        }
    }
    p->near.n = kept;
    return DALCS_OK;
}

void dalcs_orbit_near_finish(struct dalcs_orbit_part *p) {
    free(p->near.low);
}

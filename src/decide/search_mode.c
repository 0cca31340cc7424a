/* search_mode.c - the answers to a step that is accurate and whose mode is wrong, or tied. */
#include "search_internal.h"

#include "blocks.h"
#include "guard_scale.h"
#include "guard_values.h"
#include "guards.h"
#include "restart.h"
#include "step_error.h"
#include "step_length.h"
#include "tied.h"
#include "transition.h"

#include <math.h>
#include <string.h>

enum {
    MOST_RESTARTS = 4,
    TIED_RESTARTS = 3, /* longer each time: at the event itself everything may be tied */
    MOST_FLIPS = 12,
    MOST_JUMPS = 64, /* at one instant, as switches turn */
    MOST_FLIPS_CLOSER = 2
};

static void keep_mode(struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    memcpy(part->work.mode_tied, p->mode, (size_t)p->n_words * sizeof(uint64_t));
}

static void put_mode_back(struct dalcs_radau_part *part) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    memcpy(p->mode, part->work.mode_tied, (size_t)p->n_words * sizeof(uint64_t));
}

static bool is_mode_kept(const struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    return dalcs_mode_is(p->mode, part->work.mode_tied, p->n_words);
}

enum dalcs_status dalcs_search_tie_again(struct dalcs_radau_part *part,
                                         struct dalcs_search *search) {
    search->opened = false;
    put_mode_back(part);
    return DALCS_OK;
}

enum dalcs_status dalcs_search_go_on_trying(struct dalcs_radau_part *part,
                                            struct dalcs_search *search) {
    search->opened = !is_mode_kept(part);
    return DALCS_OK;
}

/* Those that have crossed cannot: they go back to the side they were on, and the others are tried without them. */
static enum dalcs_status tie_crossed(struct dalcs_radau_part *part, struct dalcs_search *search) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    bool found = false;
    for (int k = 0; k < part->guards.n_crossed; k++) {
        int d = part->guards.crossed[k];
        bool was_on = d < p->system->n_pairs && dalcs_mode_has(part->work.mode_tied, d);
        if (d < p->system->n_pairs && was_on != dalcs_osnsp_is_on(p, d)) {
            dalcs_osnsp_command(p, d, was_on);
            found = true;
        }
    }
    if (!found) {
        return dalcs_search_tie_again(part, search);
    }
    return dalcs_search_go_on_trying(part, search);
}

enum dalcs_status dalcs_search_refuse(struct dalcs_radau_part *part, struct dalcs_search *search) {
    dalcs_transition_refuse(part);
    search->first_level = search->asked_level = part->length.level;
    search->guessed = false;
    part->memory.fronts_refused += search->front ? 1 : 0;
    search->front = false;
    return DALCS_OK;
}

enum dalcs_status dalcs_search_ask_from(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                        struct dalcs_search *search, int block) {
    keep_mode(part);
    DALCS_TRY(dalcs_search_ask(r, part, search, false));
    dalcs_blocks_put_back(part, block, part->work.mode_tied);
    return DALCS_OK;
}

/* Not if it has jumped and only micro-steps show how far. */
static bool is_state_known(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    return !part->segment.jumped || r->base->jump.is_known;
}

/* May what is wrong from the start be over so soon that micro-steps saw what comes after it? Where a
 * source begins to fall there may be a current that it has to take down first. Behind a jump that only
 * they know it is rather the state, which they left a little off. */
static bool may_be_brief(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                         const struct dalcs_search *search) {
    bool asked = search->restarts > 0 && search->flips == 0 && !search->closer;
    return asked && is_state_known(r, part) && !search->fixed;
}

/* Asks the circuit by micro-steps that are shorter still, for a segment about as long as that. */
static enum dalcs_status ask_closer(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                    struct dalcs_search *search, double recovery) {
    search->closer = true;
    search->projected = false;
    search->asked_level = part->length.level - 2 - ilogb(recovery);
    dalcs_search_start_over(part, search, search->asked_level);
    return dalcs_radau_restart(r, part, search->restarts++, false, NULL);
}

/* Have switches turned to where they stood, from the same state, so that they would for ever? Brent's way: modes are
 * compared with one of them, which is a later one each time that their number has doubled. */
static bool comes_round(const struct dalcs_radau_part *part, struct dalcs_search *search) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    if (search->turns.n > 0 && dalcs_mode_is(p->mode, part->work.mode_turned, p->n_words)) {
        return true;
    }
    if ((search->turns.n & (search->turns.n - 1)) == 0) {
        memcpy(part->work.mode_turned, p->mode, (size_t)p->n_words * sizeof(uint64_t));
    }
    return false;
}

/* Where a switch reaches its threshold on a straight way from what its control was before the instant to what it is now,
 * 0 to 1: as a resistance that goes from one end to the other would take it there. What was past it before is there at
 * once, but what has just turned, as by a formula that jumps, turns back last. */
static double way_to_turn(const struct dalcs_radau_part *part, int guard) {
    const struct dalcs_system *s = part->component->system;
    const int d = dalcs_guard_pair(part, guard);
    const double now = dalcs_guard_control_at(part, guard, 0);
    const double at_once = dalcs_guard_has_flipped(part, d) ? 1.0 : 0.0;
    if (part->segment.by_euler || !(part->segment.t > 0.0)) {
        return at_once; /* before is not known */
    }
    const double *control =
        part->segment.out_before + dalcs_system_n_columns(s) + guard - s->n_pairs;
    const double v =
        dalcs_guard_value_at(part, control, part->stages.layout.stride, part->segment.end_before);
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const double before =
        dalcs_osnsp_is_on(p, d) ? v - dalcs_switch_opens_at(s, p->mode, d) : s->pair[d].turn_on - v;
    return before > 0.0 ? before / fmax(before - now, before) : at_once;
}

/* Of the switches that have crossed, the first on that way; of equals the first of the netlist. */
static void keep_first(struct dalcs_radau_part *part) {
    struct dalcs_part_guards *g = &part->guards;
    int first = g->crossed[0];
    double least = way_to_turn(part, first);
    for (int k = 1; k < g->n_crossed; k++) {
        const double way = way_to_turn(part, g->crossed[k]);
        first = way < least ? g->crossed[k] : first;
        least = fmin(way, least);
    }
    g->crossed[0] = first;
    g->n_crossed = 1;
}

/* A switch that remembers stands as it was commanded until a voltage says otherwise, and at one instant that is the one
 * behind the last jump: in an accurate step of the mode it has led to. Past the other threshold there, it turns back,
 * and the circuit is asked what that does: a finite sequence of turns and jumps. All that have to turn at once. Where
 * that comes round to the same mode without a jump, one closing may undo what made another one open, as gaps in series
 * do that break down together: they turn one by one. Where that does not end either, nor does one with a jump each time,
 * the switches slide. */
static enum dalcs_status turn_switches(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       struct dalcs_search *search) {
    const bool is_round = comes_round(part, search);
    if (search->turns.jumps > MOST_JUMPS ||
        (is_round && search->turns.how != DALCS_TURN_TOGETHER)) {
        part->guards.slides = true;
        part->component->commands.n_delayed++;
        return DALCS_OK;
    }
    if (is_round) {
        search->turns.how = DALCS_TURN_ONE_BY_ONE;
        search->turns.n = 0;
    }
    if (search->turns.how == DALCS_TURN_ONE_BY_ONE) {
        keep_first(part);
    } else if (part->guards.n_crossed > 1) {
        search->turns.how = DALCS_TURN_TOGETHER;
    }
    bool has_jumped = part->segment.jumped;
    search->turns.n++;
    search->turns.any = true;
    dalcs_guards_flip(part);
    search->restarts = search->flips = 0;
    part->segment.jumped = false;
    DALCS_TRY(dalcs_search_ask(r, part, search, false));
    if (part->segment.jumped) {
        search->turns.n = 0;
        search->turns.jumps++;
    }
    part->segment.jumped = part->segment.jumped || has_jumped;
    return DALCS_OK;
}

static bool is_switch_that_remembers(const struct dalcs_radau_part *part, int guard) {
    const struct dalcs_system *s = part->component->system;
    return guard >= s->n_pairs && dalcs_pair_remembers(&s->pair[dalcs_guard_pair(part, guard)]);
}

/* Is all that has crossed such switches? What the one-step problem has said of diodes it has said with the switches where
 * they stand, so once it was asked these come first, and what else has crossed is left out. */
static bool leave_switches_that_remember(struct dalcs_radau_part *part, bool asked) {
    struct dalcs_part_guards *g = &part->guards;
    int n = 0;
    for (int k = 0; k < g->n_crossed; k++) {
        n += is_switch_that_remembers(part, g->crossed[k]) ? 1 : 0;
    }
    if (n == 0 || (n < g->n_crossed && !asked)) {
        return false;
    }
    n = 0;
    for (int k = 0; k < g->n_crossed; k++) {
        g->crossed[n] = g->crossed[k];
        n += is_switch_that_remembers(part, g->crossed[k]) ? 1 : 0;
    }
    g->n_crossed = n;
    return true;
}

enum dalcs_status dalcs_search_change_mode(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                           struct dalcs_search *search, const double *unit,
                                           bool *done) {
    bool is_remembered = search->guessed && !search->front;
    if (!is_remembered && dalcs_search_may_refine(search) && dalcs_guards_recover(part, unit)) {
        return dalcs_search_refine(r, part, search);
    }
    if (search->guessed) {
        return dalcs_search_refuse(part, search);
    }
    if (search->opened) {
        return tie_crossed(part, search);
    }
    if (leave_switches_that_remember(part, search->restarts > 0)) {
        return turn_switches(r, part, search);
    }
    double recovery = may_be_brief(r, part, search) ? dalcs_guards_recovery(part) : INFINITY;
    bool is_resolved =
        recovery * part->segment.h >= dalcs_length_shortest(r); /* else no micro-step sees it */
    if (recovery > 0.0 && recovery < INFINITY && is_resolved) {
        return ask_closer(r, part, search, recovery);
    }
    if (search->closer && search->flips_closer++ < MOST_FLIPS_CLOSER) {
        dalcs_guards_flip(part);
        return DALCS_OK;
    }
    if (search->restarts < MOST_RESTARTS && search->flips == 0) {
        return dalcs_search_ask_from(r, part, search, dalcs_blocks_first_crossed(part));
    }
    if (search->flips == 2 && dalcs_search_may_refine(search)) {
        search->flips = 0; /* on neither side: a shorter step may decide */
        return dalcs_search_refine(r, part, search);
    }
    if (search->flips++ < MOST_FLIPS) {
        dalcs_guards_flip(part);
        return DALCS_OK;
    }
    *done = true;
    return dalcs_search_fall_back(r, part, search->limit, search->first_level, part->segment.h);
}

/* The present mode holds but for ties, of which micro-steps tell more than this; of a diode that crossed just
 * now, less. So of others their mode is not taken, nor is the state put on it: what rounding makes of large
 * capacitors in steps so short may be more current than there is, and where it goes another mode. */
static enum dalcs_status ask_of_tied(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     struct dalcs_search *search, const double *unit) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    keep_mode(part);
    for (int d = 0; d < p->system->n_pairs; d++) {
        part->guards.tied[d] = dalcs_tied_is(part, d, unit);
    }
    bool mode_only = search->restarts > 0;
    bool is_off;
    DALCS_TRY(dalcs_radau_restart(r, part, search->restarts++, mode_only, &is_off));
    for (int d = 0; d < p->system->n_pairs; d++) {
        if (!part->guards.tied[d] && p->lists.is_diode[d]) {
            dalcs_osnsp_command(p, d, dalcs_mode_has(part->work.mode_tied, d));
        }
    }
    return dalcs_search_go_on_from_answer(r, part, search, is_off);
}

static const double *end_of_step(const struct dalcs_radau_part *part) {
    return part->segment.out + part->stages.method->s * part->stages.layout.stride;
}

bool dalcs_search_moves_states(const struct dalcs_radau_part *part,
                               const struct dalcs_search *search, const double *unit) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const bool shares = search->opened && search->ties == DALCS_TIES_SHARED;
    const double *end = end_of_step(part);
    bool moves = false;
    for (int x = 0; x < p->system->n_x && shares && dalcs_osnsp_is_monotone(p) && !moves; x++) {
        const double most = part->inner_tolerance * dalcs_step_scale(part, x, unit);
        moves = !(fabs(end[x] - part->work.y2[x]) <= most);
    }
    return moves;
}

enum dalcs_status dalcs_search_untie(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     struct dalcs_search *search, double next,
                                     const struct dalcs_step_quality *quality) {
    double micro = dalcs_radau_micro_length(r, part, search->restarts);
    if (search->ties == DALCS_TIES_STAND && search->restarts < TIED_RESTARTS &&
        4.0 * micro < next * part->segment.h) {
        return ask_of_tied(r, part, search, quality->unit);
    }
    keep_mode(part);
    const size_t n_x = (size_t)part->component->system->n_x;
    search->opened = search->ties == DALCS_TIES_STAND && dalcs_tied_turn(part, quality->unit);
    search->ties = search->opened ? DALCS_TIES_TURNED : DALCS_TIES_SHARED;
    if (!search->opened) {
        memcpy(part->work.y2, end_of_step(part), n_x * sizeof(double));
        search->opened = dalcs_tied_share(part, quality->unit);
    }
    return DALCS_OK;
}

/* projection.c - where the stages of a step in the mode are, extrapolated to its beginning. */
#include "projection.h"

#include "extremes.h"
#include "magnitudes.h"
#include "micro_steps.h"
#include "present.h"
#include "rounding.h"
#include "step_error.h"
#include "step_length.h"

#include <math.h>

/* A projecting step is this many rungs below: the first of these in which the mode can be seen. */
enum { PROJECTIONS = 3 };

static const int projection[PROJECTIONS] = {30, 20, 10};

/* What steps are tried for a projection. */
struct lengths {
    double tried;  /* s, the step before them */
    double limit;  /* s, up to which one may go */
    bool fixed;    /* the step is given */
    bool may_jump; /* states may */
    int first;     /* of `projection`, in which the mode was seen */
};

/* Of try k, after a step of length `tried`. */
static double projecting_length(const struct dalcs_radau_part *part, double tried, bool fixed,
                                int k) {
    return fixed ? ldexp(tried, -projection[k])
                 : dalcs_radau_ladder(part, (part->length.level & ~7) + projection[k]);
}

/* Does the map of the step that was tried last tell that the mode moves no state at once, by more than needs no
 * projection? */
static bool is_in_place(struct dalcs_radau_part *part) {
    const struct dalcs_stage_entry *entry =
        part->smooth == NULL
            ? dalcs_stages_find(&part->stages, part->component->osnsp.mode, part->segment.h)
            : NULL;
    double most = dalcs_slight * part->inner_tolerance;
    bool is = entry != NULL;
    for (int x = 0; x < part->component->system->n_x && is; x++) {
        double shift = dalcs_stage_shift(&part->stages, entry, x, part->segment.in);
        is = fabs(shift) <= most * dalcs_step_scale(part, x, part->scales.unit);
    }
    return is;
}

bool dalcs_projection_sees(struct dalcs_radau_part *part, bool fixed) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const double *first = part->segment.out + l->stride;
    const double *drift = part->segment.out + l->drift;
    double span = part->stages.method->node[1] * part->segment.h;
    double part_of_span = projecting_length(part, part->segment.h, fixed, 0) / span;
    bool sees = false;
    for (int x = 0; x < part->component->system->n_x && !sees; x++) {
        double regular = fabs(first[x] - part->x[x]) * part_of_span;
        sees = drift[x] != 0.0 && !(dalcs_beyond * fabs(drift[x]) < regular);
    }
    return sees && !is_in_place(part);
}

/* Does this state belong to block `of`? -1: to any. */
static bool is_in(const struct dalcs_radau_part *part, int x, int of) {
    return of < 0 || part->stages.block_of[x] == of;
}

/* Where the polynomial of a step begins. */
static double beginning_of(const struct dalcs_radau_part *part, int x) {
    const struct dalcs_collocation *m = part->stages.method;
    double beginning = 0.0;
    for (int i = 1; i <= m->n_stages; i++) {
        beginning += m->back[i - 1] * part->segment.out[i * part->stages.layout.stride + x];
    }
    return beginning;
}

/* How far the step goes from there. */
static double way_of(const struct dalcs_radau_part *part, int x, double beginning) {
    const double *end = part->segment.out + part->stages.method->s * part->stages.layout.stride;
    return fabs(end[x] - beginning);
}

/* Is it elsewhere than the state, beyond what the step goes? */
static bool has_moved(const struct dalcs_radau_part *part, int x, double beginning) {
    return fabs(beginning - part->x[x]) > dalcs_beyond * way_of(part, x, beginning);
}

/* Does the state go from node to node as rounding does? What it is off by may hide in that. */
static bool is_rough(const struct dalcs_radau_part *part, int x, double beginning) {
    const double *drift = part->segment.out + part->stages.layout.drift;
    return !(dalcs_beyond * fabs(drift[x]) < way_of(part, x, beginning));
}

/* Of states in other blocks than `of` work.after is where they are. *moves: not so of one in it. */
static void find_beginning(struct dalcs_radau_part *part, int of, bool *moves) {
    double *after = part->work.after;
    for (int x = 0; x < part->component->system->n_x; x++) {
        bool is_own = is_in(part, x, of);
        after[x] = is_own ? beginning_of(part, x) : part->x[x];
        *moves = *moves || (is_own && has_moved(part, x, after[x]));
    }
}

static bool has_states(const struct dalcs_radau_part *part, int of) {
    bool has = false;
    for (int x = 0; x < part->component->system->n_x && !has; x++) {
        has = is_in(part, x, of);
    }
    return has;
}

/* A step of length part->segment.h, up to limit. *means_something: it is long enough for the mode to be seen beside
 * rounding, and for its matrix to have a solution. */
static enum dalcs_status try_projection(struct dalcs_radau_part *part, double limit,
                                        bool *means_something) {
    if (part->segment.h > limit - part->segment.t) {
        return DALCS_OK;
    }
    struct dalcs_stage_entry *entry;
    enum dalcs_status status = dalcs_segment_solve(part, &entry);
    *means_something = status == DALCS_OK && dalcs_stage_residual(entry) <= dalcs_nothing;
    return status < DALCS_OK ? status : DALCS_OK;
}

/* How far that may be off: it is a sum. */
static double rounding_of_beginning(const struct dalcs_radau_part *part, int x) {
    const struct dalcs_collocation *m = part->stages.method;
    double sizes = 0.0;
    for (int i = 1; i <= m->n_stages; i++) {
        sizes += fabs(m->back[i - 1] * part->segment.out[i * part->stages.layout.stride + x]);
    }
    return dalcs_sum_rounded * sizes;
}

/* Do states that move begin elsewhere in the last step than in one before it, farther than the step goes and beyond rounding?
 * work.y1: where they began there. */
static bool begins_elsewhere(const struct dalcs_radau_part *part) {
    bool differs = false;
    for (int x = 0; x < part->component->system->n_x && !differs; x++) {
        double least = dalcs_beyond * part->work.y2[x] + rounding_of_beginning(part, x);
        differs = fabs(beginning_of(part, x) - part->work.y1[x]) > least;
    }
    return differs;
}

/* What each state does in the last step: where it begins and how far it goes. Does one move? */
static bool note_beginnings(struct dalcs_radau_part *part) {
    bool moves = false;
    for (int x = 0; x < part->component->system->n_x; x++) {
        part->work.y1[x] = beginning_of(part, x);
        part->work.y2[x] = way_of(part, x, part->work.y1[x]);
        moves = moves || has_moved(part, x, part->work.y1[x]);
    }
    return moves;
}

/* A jump is the same in a shorter step, and a transient faster than the step is less: of two lengths in which the mode is seen
 * and that do not agree, the shorter one tells. */
static enum dalcs_status look_shorter(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      double limit) {
    bool differs = true;
    while (differs && note_beginnings(part)) {
        const double h = part->segment.h;
        bool means_something = false;
        part->segment.h = fmax(ldexp(h, -DALCS_FAR_SHORTER), dalcs_length_shortest(r));
        if (part->segment.h < h) {
            DALCS_TRY(try_projection(part, limit, &means_something));
        }
        differs = means_something && begins_elsewhere(part);
        if (!differs) {
            part->segment.h = h;
            return try_projection(part, limit, &means_something);
        }
    }
    return DALCS_OK;
}

/* Are the states of blocks before `of` within their tolerance in a step? Nothing in them is faster. */
static bool acts_slowly(const struct dalcs_radau_part *part, int of) {
    const double *drift = part->segment.out + part->stages.layout.drift;
    bool slow = true;
    for (int x = 0; x < part->component->system->n_x && slow; x++) {
        double scale = dalcs_step_scale(part, x, part->scales.unit);
        slow = part->stages.block_of[x] >= of || fabs(drift[x]) <= part->inner_tolerance * scale;
    }
    return slow;
}

/* What block `of` reads may be the voltage of a coil, and rounding of its current over so short a step is more than that.
 * Of the states that move in the projecting step, or go as rounding does, longer ones show as much with less of it, up to
 * their own error: of two lengths that agree best the longer one tells. *moves: there are such states. */
static enum dalcs_status look_longer(struct dalcs_radau_part *part, const struct lengths *lengths,
                                     int of, bool *moves) {
    double *after = part->work.after;
    double *before = part->work.y1;
    double *apart = part->work.y2;
    int n_x = part->component->system->n_x;
    bool means_something = false; /* a longer step would */
    for (int x = 0; x < n_x; x++) {
        bool tells = !has_moved(part, x, after[x]) && !is_rough(part, x, after[x]);
        before[x] = after[x];
        apart[x] = is_in(part, x, of) && !tells ? INFINITY : 0.0;
        means_something = means_something || apart[x] > 0.0;
    }
    const double shortest = part->segment.h;
    enum dalcs_status status = DALCS_OK;
    for (int k = lengths->first + 1; k < PROJECTIONS && means_something && status >= DALCS_OK;
         k++) {
        part->segment.h = projecting_length(part, lengths->tried, lengths->fixed, k);
        means_something = false;
        status = try_projection(part, lengths->limit, &means_something);
        means_something = means_something && acts_slowly(part, of);
        for (int x = 0; x < n_x && means_something; x++) {
            double beginning = apart[x] > 0.0 ? beginning_of(part, x) : before[x];
            double differs = fabs(beginning - before[x]);
            before[x] = beginning;
            after[x] = differs < apart[x] ? beginning : after[x];
            apart[x] = dalcs_smaller(apart[x], differs);
        }
    }
    for (int x = 0; x < n_x; x++) {
        *moves = *moves || (apart[x] > 0.0 && apart[x] < INFINITY);
    }
    part->segment.h = shortest;
    return status < DALCS_OK ? status : DALCS_OK;
}

/* Is a state farther from there than an event's error takes it, over what is in the step that was tried before? In a mode that
 * no problem has told, as where a switch has turned and the diodes around it have not, the current of a coil has no path:
 * its way to there is a jump without an impulse that would be told. */
static bool is_jump(const struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    const double *after = part->work.after;
    double largest[2];
    dalcs_micro_largest(part, largest);
    dalcs_micro_raise(s, after, s->n_x, largest);
    for (int node = 1; node <= part->stages.method->s; node++) {
        dalcs_micro_raise(s, part->work.out_tried + (ptrdiff_t)node * part->stages.layout.stride,
                          dalcs_system_n_equations(s), largest);
    }
    bool is = false;
    for (int x = 0; x < s->n_x && !is; x++) {
        const double most = dalcs_micro_noticeable(part) * largest[s->column_is_current[x]];
        is = fabs(after[x] - part->x[x]) > most;
    }
    return is;
}

/* Puts the states of one block where the last step, a projecting one, begins, unless it *jumps. */
static enum dalcs_status move_block(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                    const struct lengths *lengths, int of, bool *moved,
                                    bool *jumps) {
    *moved = false;
    find_beginning(part, of, moved);
    if (of > 0) {
        DALCS_TRY(look_longer(part, lengths, of, moved));
    }
    *jumps = *moved && !lengths->may_jump && is_jump(part);
    *moved = *moved && !*jumps;
    if (*moved) {
        dalcs_radau_go_after(r, part);
    }
    return DALCS_OK;
}

/* The last step was a projecting one: puts states on what the mode allows, block by block (partition.h). What acts jumps
 * by what it is off, over the length of such a step, and what only reads it would follow that: so it is looked at again
 * from where the blocks before it are. */
static enum dalcs_status move_in_order(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       const struct lengths *lengths, bool *moved, bool *jumps) {
    int n_blocks = part->component->osnsp.partition.n_blocks;
    bool is_behind = false; /* the last step is another one, or a block has moved since */
    for (int k = 0; k < n_blocks && !*jumps; k++) {
        int of = n_blocks > 1 ? k : -1;
        if (!has_states(part, of)) {
            continue;
        }
        if (is_behind) {
            struct dalcs_stage_entry *entry;
            enum dalcs_status status = dalcs_segment_solve(part, &entry);
            if (status != DALCS_OK) {
                return status < DALCS_OK ? status : DALCS_OK;
            }
        }
        bool moves;
        DALCS_TRY(move_block(r, part, lengths, of, &moves, jumps));
        *moved = *moved || moves;
        is_behind = moves || of > 0;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_projection_try(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       double limit, bool fixed, bool may_jump,
                                       enum dalcs_projection *told) {
    double tried = part->segment.h;
    bool moved = false;
    *told = DALCS_PROJECTION_BLIND;
    if (part->component->system->n_x == 0) {
        return DALCS_OK;
    }
    dalcs_radau_swap_out(part, &part->work.out_tried);
    struct lengths lengths = {tried, limit, fixed, may_jump, -1};
    bool means_something = false;
    enum dalcs_status status = DALCS_OK;
    while (!means_something && status >= DALCS_OK && ++lengths.first < PROJECTIONS) {
        part->segment.h = projecting_length(part, tried, fixed, lengths.first);
        status = try_projection(part, limit, &means_something);
    }
    if (means_something) {
        DALCS_TRY(look_shorter(r, part, limit));
        bool jumps = false;
        status = move_in_order(r, part, &lengths, &moved, &jumps);
        *told = jumps   ? DALCS_PROJECTION_JUMPS
                : moved ? DALCS_PROJECTION_MOVED
                        : DALCS_PROJECTION_IN_PLACE;
    }
    if (moved) {
        return status;
    }
    dalcs_radau_swap_out(part, &part->work.out_tried);
    part->segment.h = tried;
    if (part->smooth != NULL && status >= DALCS_OK) { /* what it knows is of the last try */
        struct dalcs_stage_entry *entry;
        status = dalcs_segment_solve(part, &entry);
    } else {
        dalcs_segment_inputs(part);
    }
    return status < DALCS_OK ? status : DALCS_OK;
}

bool dalcs_projection_settle(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                             const double *unit, bool within_unit) {
    bool moves = false;
    find_beginning(part, -1, &moves);
    const struct dalcs_system *s = part->component->system;
    for (int x = 0; x < s->n_x; x++) {
        double scale =
            within_unit ? unit[s->column_is_current[x]] : dalcs_step_scale(part, x, unit);
        double most = part->inner_tolerance * scale;
        if (!(fabs(part->work.after[x] - part->x[x]) <= most)) {
            return false;
        }
    }
    dalcs_radau_go_after(r, part);
    return true;
}

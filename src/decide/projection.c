/* projection.c - where the stages of a step in the mode are, extrapolated to its beginning. */
#include "projection.h"

#include "present.h"

#include <math.h>

/* A projecting step is this many rungs below: the first of these in which the mode can be seen. */
enum { PROJECTIONS = 3 };

static const int projection[PROJECTIONS] = {30, 20, 10};

/* States that move by so many times their drift in a projecting step hide in it what they are off by. */
static const double hidden = 16.0;

/* Of try k, after a step of length `tried`. */
static double projecting_length(const struct dalcs_radau_part *part, double tried, bool fixed,
                                int k) {
    return fixed ? ldexp(tried, -projection[k])
                 : dalcs_radau_ladder(part, (part->length.level & ~7) + projection[k]);
}

bool dalcs_projection_sees(const struct dalcs_radau_part *part, bool fixed) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const double *first = part->segment.out + l->stride;
    const double *drift = part->segment.out + l->drift;
    double span = part->stages.method->node[1] * part->segment.h;
    double part_of_span = projecting_length(part, part->segment.h, fixed, 0) / span;
    bool sees = false;
    for (int x = 0; x < part->component->system->n_x && !sees; x++) {
        double regular = fabs(first[x] - part->x[x]) * part_of_span;
        sees = drift[x] != 0.0 && !(hidden * fabs(drift[x]) < regular);
    }
    return sees;
}

/* Where the polynomial of a step begins. *moves: that is elsewhere, farther than the step goes. */
static void find_beginning(struct dalcs_radau_part *part, bool *moves) {
    const struct dalcs_collocation *m = part->stages.method;
    int stride = part->stages.layout.stride;
    for (int x = 0; x < part->component->system->n_x; x++) {
        part->work.after[x] = 0.0;
        for (int i = 1; i <= m->n_stages; i++) {
            part->work.after[x] += m->back[i - 1] * part->segment.out[i * stride + x];
        }
        double defect = fabs(part->work.after[x] - part->x[x]);
        double regular = fabs(part->segment.out[m->s * stride + x] - part->work.after[x]);
        *moves = *moves || defect > 4.0 * regular;
    }
}

/* A step of length part->segment.h, up to limit. *means_something: it is long enough for the mode to be seen beside
 * rounding. */
static enum dalcs_status try_projection(struct dalcs_radau_part *part, double limit,
                                        bool *means_something) {
    if (part->segment.h > limit - part->segment.t) {
        return DALCS_OK;
    }
    struct dalcs_stage_entry *entry;
    enum dalcs_status status = dalcs_segment_solve(part, &entry);
    *means_something = status == DALCS_OK && dalcs_stage_residual(entry) <= dalcs_largest_residual;
    return status;
}

enum dalcs_status dalcs_projection_try(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       double limit, bool fixed, bool *moved) {
    double tried = part->segment.h;
    *moved = false;
    if (part->component->system->n_x == 0) {
        return DALCS_OK;
    }
    dalcs_radau_swap_out(part, &part->work.out_tried);
    bool means_something = false;
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < PROJECTIONS && !means_something && status >= DALCS_OK; k++) {
        part->segment.h = projecting_length(part, tried, fixed, k);
        status = try_projection(part, limit, &means_something);
    }
    if (means_something) {
        find_beginning(part, moved);
    }
    if (*moved) {
        dalcs_radau_go_after(r, part);
        return DALCS_OK;
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
                             const double *unit) {
    bool moves = false;
    find_beginning(part, &moves);
    const struct dalcs_system *s = part->component->system;
    for (int x = 0; x < s->n_x; x++) {
        double most = part->inner_tolerance * unit[s->column_is_current[x]];
        if (!(fabs(part->work.after[x] - part->x[x]) <= most)) {
            return false;
        }
    }
    dalcs_radau_go_after(r, part);
    return true;
}

/* segment.c - one step: its length, its error, and the first thing that ends its mode. */
#include "crossing.h"
#include "radau_internal.h"

#include <math.h>
#include <string.h>

/* Signals smaller than this part of the largest of their unit are held to that one's scale. */
static const double smallest_scale = 1e-5;

/* The same for the current of a pair. */
static const double pair_scale = 1e-2;

/* Errors up to this part of the unit's scale in a pair that has just changed sides are no event. */
static const double band_over_tolerance = 10.0;

/* What rounding leaves of a zero, over the unit's scale. */
static const double noise = 2e-13;

/* No column is known better than this part of what would balance the largest of the others. */
static const double rounding_part = 2e-14;

/* The error estimate may be this much smaller before the step is doubled. */
static const double safety = 0.8;

#include <stdio.h>
#include <stdlib.h>
#define DBG(...)                                                                                   \
    do {                                                                                           \
        if (getenv("DALCS_D")) {                                                                   \
            fprintf(stderr, __VA_ARGS__);                                                          \
        }                                                                                          \
    } while (0)
static const double most_tolerated = 2e-13;

/* Defects of a state, over what is allowed, that interpolation may leave; more is a jump. */
static const double most_projected = 1e4;

enum {
    LEAST_PATIENCE = 8,
    MOST_PATIENCE = 1024,
    STUCK = 3,
    PROJECTION = 30,
    MOST_RUNGS = 6,
    PIVOTS = 12,
    MOST_RESTARTS = 4,
    CROWD = 40
};

/* The wildest step over the shortest period of a source, by stages: fewer nodes see less. */
static double most_periods(int stages) {
    return stages >= 7 ? 0.6 : stages >= 5 ? 0.45 : 0.25;
}

double dalcs_radau_limit(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    return fmin(fmin(part->excitation.next_edge, part->commands.next), r->options.stop);
}

/* Largest magnitudes of the answer up to `end`, with what is known from before: to[n_columns], and by
 * unit. */
static void find_scales(const struct dalcs_radau_part *part, double end, double *to, double *unit) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stages *st = &part->stages;
    int n_columns = dalcs_system_n_columns(s);
    int last = 0;
    while (last < st->method.s && st->method.node[last + 1] <= end) {
        last++;
    }
    memcpy(to, part->scale, (size_t)n_columns * sizeof(double));
    for (int k = 0; k <= last; k++) {
        const double *y = part->out + k * st->layout.stride;
        for (int c = 0; c < n_columns; c++) {
            double a = fabs(y[c]);
            to[c] = a > to[c] ? a : to[c];
        }
    }
    unit[0] = part->unit_scale[0];
    unit[1] = part->unit_scale[1];
    int n_equations = dalcs_system_n_equations(s);
    for (int c = 0; c < n_equations; c++) {
        int of = s->column_is_current[c];
        unit[of] = to[c] > unit[of] ? to[c] : unit[of];
    }
    for (int d = 0; d < s->n_pairs; d++) {
        int of = dalcs_osnsp_is_on(&part->component->osnsp, d) ? 1 : 0;
        for (int k = 0; k <= last; k++) {
            double a = fabs(part->out[k * st->layout.stride + n_equations + d]);
            unit[of] = a > unit[of] ? a : unit[of];
        }
    }
    double volt = unit[0];
    unit[0] = fmax(unit[0], part->cross[0] * unit[1]);
    unit[1] = fmax(unit[1], part->cross[1] * volt);
}

/* The same for the currents of closed pairs, whose voltages are columns. */
static double error_of_pairs(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                             double rounding, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    int n_equations = dalcs_system_n_equations(s);
    double worst = 0.0;
    for (int d = 0; d < s->n_pairs && part->excitation.is_curved; d++) {
        if (!dalcs_osnsp_is_on(&part->component->osnsp, d)) {
            continue;
        }
        double scale = pair_scale * unit[1];
        for (int k = 0; k < l->n_nodes; k++) {
            scale = fmax(scale, fabs(part->out[k * l->stride + n_equations + d]));
        }
        double error = fabs(part->out[l->ripple + n_equations + d]);
        double ratio = error / (r->inner_tolerance * scale + rounding + 0.1 * r->options.abstol);
        worst = error > 0.0 && ratio > worst ? ratio : worst;
    }
    return worst;
}

/* The estimated error over what is allowed. */
static double error_of(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                       const struct dalcs_stage_entry *entry, double end, double *size,
                       double *unit, double *of_unit) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const double besides[2] = {r->options.vntol, r->options.abstol};
    find_scales(part, end, size, unit);
    double worst = 0.0;
    *of_unit = 0.0;
    double tolerance = r->inner_tolerance;
    int n_equations = dalcs_system_n_equations(s);
    const double *natural = dalcs_stage_natural_units(entry);
    double largest = 0.0;
    const double *last = part->out + part->stages.method.s * l->stride;
    for (int c = 0; c < n_equations; c++) {
        largest = fmax(largest, fabs(last[c]) / natural[c]);
    }
    double rounding = rounding_part * largest;
    for (int c = 0; c < n_equations; c++) {
        double error = c < s->n_x ? fabs(part->out[l->drift + c]) : 0.0;
        if (part->excitation.is_curved) {
            error = fmax(error, fabs(part->out[l->ripple + c]));
        }
        if (error == 0.0) {
            continue;
        }
        int of = s->column_is_current[c];
        double scale = fmax(size[c], smallest_scale * unit[of]);
        double ratio = error / (tolerance * scale + rounding * natural[c] + 0.1 * besides[of]);
        if (getenv("DALCS_D") && ratio > 0.5)
            fprintf(stderr, " [%s col%d x=%d err=%g scale=%g unit=%g]", s->column[c].element, c,
                    c < s->n_x, error, scale, unit[of]);
        worst = ratio > worst || ratio != ratio ? ratio : worst;
        *of_unit = ratio > 1.0 ? fmax(*of_unit, error / unit[of]) : *of_unit;
    }
    double pairs = error_of_pairs(r, part, rounding_part * unit[1], unit);
    return pairs > worst ? pairs : worst;
}

static enum dalcs_status solve_step(struct dalcs_radau_part *part,
                                    struct dalcs_stage_entry **entry) {
    const struct dalcs_system *s = part->component->system;
    DALCS_TRY(dalcs_stages_get(&part->stages, part->component->osnsp.mode, part->h, entry));
    memcpy(part->in, part->x, (size_t)s->n_x * sizeof(double));
    part->in[s->n_x] = 1.0;
    dalcs_excitation_coefficients(&part->excitation, part->t, part->h, part->in + s->n_x + 1);
    DALCS_TRY(dalcs_stages_apply(&part->stages, *entry, part->in, part->out));
    if (!part->fresh) { /* where the last step ended is known better than where this one starts */
        memcpy(part->out, part->last, (size_t)part->stages.layout.stride * sizeof(double));
    }
    return DALCS_OK;
}

/* Puts a state that is a little off, as interpolation leaves it at an event, on what its mode allows:
 * that is where the stages of a step in the mode are, here so short a step that only such a defect
 * moves the state, and where their polynomial starts. */
static enum dalcs_status project(struct dalcs_radau_part *part, double limit, bool *moved) {
    const struct dalcs_collocation *m = &part->stages.method;
    int n_x = part->component->system->n_x;
    int stride = part->stages.layout.stride;
    struct dalcs_stage_entry *entry;
    *moved = false;
    part->h = dalcs_radau_ladder((part->level & ~7) + PROJECTION);
    if (n_x == 0 || part->h > limit - part->t) {
        return DALCS_OK;
    }
    enum dalcs_status status = solve_step(part, &entry);
    if (status != DALCS_OK) {
        return status < DALCS_OK ? status : DALCS_OK;
    }
    for (int x = 0; x < n_x; x++) {
        part->after[x] = 0.0;
        for (int i = 1; i <= m->s; i++) {
            part->after[x] += m->back[i - 1] * part->out[i * stride + x];
        }
        double defect = fabs(part->after[x] - part->x[x]);
        double regular = fabs(part->out[m->s * stride + x] - part->after[x]);
        *moved = *moved || defect > 4.0 * regular;
    }
    if (*moved) {
        memcpy(part->x, part->after, (size_t)n_x * sizeof(double));
    }
    return DALCS_OK;
}

/* Sources that disagree in a singular mode: it cannot be this one. */
static bool clashes(const struct dalcs_radau_part *part, const struct dalcs_stage_entry *entry,
                    double end, const double *unit) {
    int n = dalcs_stage_n_clashes(entry);
    int s = part->stages.method.s;
    double limit = 1e-9 * fmax(unit[0], unit[1]);
    bool found = false;
    for (int k = 0; k < n; k++) {
        bool counts = k % s == 0 || part->stages.method.node[k % s + 1] <= end;
        found = found || (counts && fabs(part->out[part->stages.layout.n_fixed + k]) > limit);
    }
    return found;
}

/* What must stay positive: guard < n_pairs is a diode, behind are watched switches. Returns the
 * values at the nodes with their stride, NULL for a switch without a guard. */
static const double *guard_values(const struct dalcs_radau_part *part, int guard, double *work,
                                  int *stride) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    if (guard < s->n_pairs) {
        *stride = l->stride;
        return s->pair[guard].kind == DALCS_PAIR_DIODE
                   ? part->out + dalcs_system_n_equations(s) + guard
                   : NULL;
    }
    int d = part->stages.watched[guard - s->n_pairs];
    bool is_on = dalcs_osnsp_is_on(&part->component->osnsp, d);
    const double *v = part->out + dalcs_system_n_columns(s) + guard - s->n_pairs;
    for (int k = 0; k < l->n_nodes; k++) {
        work[k] =
            is_on ? v[k * l->stride] - s->pair[d].turn_off : s->pair[d].turn_on - v[k * l->stride];
    }
    *stride = 1;
    return work;
}

/* The largest values of the whole step, which may go past the end of the segment: what its
 * polynomials are off by goes with these. */
static void find_reach(const struct dalcs_radau_part *part, const double *unit, double *reach) {
    const struct dalcs_system *s = part->component->system;
    reach[0] = unit[0];
    reach[1] = unit[1];
    for (int k = 0; k < part->stages.layout.n_nodes; k++) {
        const double *y = part->out + k * part->stages.layout.stride;
        for (int c = 0; c < dalcs_system_n_equations(s); c++) {
            int of = s->column_is_current[c];
            reach[of] = fmax(reach[of], fabs(y[c]));
        }
    }
}

static double guard_scale(const struct dalcs_radau_part *part, int guard, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    bool is_current = guard < s->n_pairs && dalcs_osnsp_is_on(&part->component->osnsp, guard);
    if (guard >= s->n_pairs) {
        const struct dalcs_pair *p = &s->pair[part->stages.watched[guard - s->n_pairs]];
        return fmax(unit[0], fmax(fabs(p->turn_on), fabs(p->turn_off)));
    }
    return unit[is_current ? 1 : 0];
}

static double band_of(const struct dalcs_radau *r) {
    return fmax(band_over_tolerance * r->inner_tolerance, 4.0 * noise);
}

static void arm(const struct dalcs_radau *r, struct dalcs_radau_part *part, double theta,
                const double *unit) {
    int n_guards = part->component->system->n_pairs + part->stages.n_watched;
    double weight[DALCS_MAX_NODES];
    dalcs_collocation_weights(&part->stages.method, theta, weight);
    for (int g = 0; g < n_guards; g++) {
        double work[DALCS_MAX_NODES];
        int stride;
        const double *value = guard_values(part, g, work, &stride);
        double now = 0.0;
        for (int k = 0; value != NULL && k < part->stages.layout.n_nodes; k++) {
            now += weight[k] * value[k * stride];
        }
        bool clear = now > band_of(r) * guard_scale(part, g, unit);
        part->armed[g] = clear || (theta > 0.0 && part->armed[g]);
    }
}

/* The first guards to fall, listed in part->crossed. Returns theta; *at_once: wrong from the start. */
static double find_crossing(const struct dalcs_radau *r, struct dalcs_radau_part *part, double end,
                            const double *unit, bool *at_once) {
    int n_guards = part->component->system->n_pairs + part->stages.n_watched;
    double first = INFINITY;
    double together = fmax(1e-13, 2.0 * r->resolution / part->h);
    /* What crosses at the stop time, up to the error, is left to a longer run. */
    bool last = end <= 1.0 && part->t + end * part->h >= r->options.stop - r->resolution;
    part->n_crossed = 0;
    *at_once = false;
    for (int g = 0; g < n_guards; g++) {
        double work[DALCS_MAX_NODES];
        int stride;
        const double *value = guard_values(part, g, work, &stride);
        if (value == NULL) {
            continue;
        }
        double scale = guard_scale(part, g, unit);
        double depth = (part->armed[g] && !last ? noise : band_of(r)) * scale;
        struct dalcs_crossing c =
            dalcs_crossing_find(&part->stages.method, value, stride, end, depth);
        if (!c.falls || c.theta > first + together) {
            continue;
        }
        if (c.theta < first - together) {
            part->n_crossed = 0;
            *at_once = false;
        }
        DBG("   g%d depth=%g end=%g vals", g, depth, end);
        for (int q = 0; q < part->stages.layout.n_nodes; q++)
            DBG(" %g", value[q * stride]);
        DBG("\n");
        first = fmin(first, c.theta);
        *at_once = *at_once || (c.at_once && !part->armed[g]);
        part->crossed[part->n_crossed++] = g;
    }
    return first;
}

/* Is there a diode with neither current nor voltage during the whole step? It may change sides without
 * anything else, and where that leaves a choice (sources in parallel, floating nodes) only the OSNSP
 * knows which is of least norm. */
static bool stays_tied(const struct dalcs_radau_part *part, const double *unit) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    bool tied = false;
    for (int d = 0; d < s->n_pairs && !tied; d++) {
        if (s->pair[d].kind != DALCS_PAIR_DIODE) {
            continue;
        }
        const double *value = part->out + dalcs_system_n_equations(s) + d;
        double limit = noise * guard_scale(part, d, unit);
        tied = true;
        for (int k = 0; k < l->n_nodes && tied; k++) {
            tied = fabs(value[k * l->stride]) <= limit;
        }
    }
    return tied;
}

/* Where the ladder should go for an error of `ratio` times what is allowed. */
static int rungs_for(double ratio, int stages) {
    double rungs = log2(fmax(ratio, 1e-30)) / (double)(stages + 1);
    return !(rungs < MOST_RUNGS) ? MOST_RUNGS : (int)ceil(rungs);
}

void dalcs_segment_flip(struct dalcs_radau_part *part) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    for (int k = 0; k < part->n_crossed; k++) {
        int g = part->crossed[k];
        int d = g < p->system->n_pairs ? g : part->stages.watched[g - p->system->n_pairs];
        dalcs_osnsp_command(p, d, !dalcs_osnsp_is_on(p, d));
    }
}

static void accept(struct dalcs_radau *r, struct dalcs_radau_part *part, double theta, double limit,
                   const double *unit) {
    const struct dalcs_system *s = part->component->system;
    part->end = theta;
    double t_end = part->t + theta * part->h;
    part->why = part->n_crossed > 0 ? DALCS_END_AT_EVENT : DALCS_END_OF_STEP;
    if (part->n_crossed == 0 && t_end >= limit - r->resolution) {
        t_end = limit;
        part->why = DALCS_END_AT_EDGE;
    }
    if (r->options.fixed_step > 0.0 && part->why == DALCS_END_OF_STEP) {
        double whole = rint(t_end / part->h) * part->h; /* counted, not accumulated */
        t_end = fabs(t_end - whole) <= 4.0 * r->resolution ? whole : t_end;
    }
    part->t_end = fmin(t_end, limit);
    int last = 0;
    while (last < part->stages.method.s && part->stages.method.node[last + 1] <= theta) {
        last++;
    }
    for (int k = 0; k <= last; k++) {
        const double *y = part->out + k * part->stages.layout.stride;
        for (int c = 0; c < dalcs_system_n_columns(s); c++) {
            double a = fabs(y[c]);
            part->scale[c] = a > part->scale[c] ? a : part->scale[c];
        }
    }
    part->unit_scale[0] = unit[0];
    part->unit_scale[1] = unit[1];
    arm(r, part, theta, unit);
    r->steps++;
}

static enum dalcs_status fall_back(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                   double limit, int tries) {
    double h = dalcs_radau_ladder(part->level + 14);
    h = fmax(ldexp(h, tries), 64.0 * r->resolution);
    r->euler_steps++;
    DBG("FALLBACK h=%g tries=%d\n", h, tries);
    return dalcs_radau_euler_step(r, part, fmin(h, limit - part->t));
}

/* A longer step next time if the error promises it, or, as errors near rounding promise nothing, now
 * and then to see. */
static void grow(struct dalcs_radau_part *part, bool promising) {
    part->waited++;
    part->grew = false;
    bool ready = promising ? part->waited > 1 : part->waited > part->patience;
    if (ready && dalcs_radau_ladder(part->level - 1) <= part->longest) {
        part->level--;
        part->waited = 0;
        part->grew = true;
    }
}

enum dalcs_status dalcs_segment_begin(struct dalcs_radau *r, struct dalcs_radau_part *part) {
    double limit = dalcs_radau_limit(r, part);
    int stages = part->stages.method.s;
    int first_level = part->level;
    double before = INFINITY;
    double tolerated = 1.0;
    int stuck = 0;
    bool projected = false;
    int restarts = 0;
    int pivots = 0;
    bool fixed = r->options.fixed_step > 0.0;
    bool crowded = part->crowd > CROWD + 4 * part->component->system->n_pairs;
    if (crowded) {
        part->fresh = true;
        return fall_back(r, part, limit, (int)(part->crowd / CROWD));
    }
    for (;;) {
        part->h = fixed ? r->options.fixed_step : dalcs_radau_ladder(part->level);
        struct dalcs_stage_entry *entry = NULL;
        enum dalcs_status status = solve_step(part, &entry);
        if (status < DALCS_OK) {
            return status;
        }
        double end = fmin(1.0, (limit - part->t) / part->h);
        DBG("p%d t=%.12g h=%g mode=%lx fresh=%d st=%d", part->index, part->t, part->h,
            part->component->osnsp.n_words ? (long)part->component->osnsp.mode[0] : 0, part->fresh,
            (int)status);
        double unit[2];
        double ratio = INFINITY;
        double of_unit = INFINITY;
        if (status == DALCS_OK) {
            ratio = error_of(r, part, entry, end, part->y1, unit, &of_unit);
        }
        DBG(" err=%g clash=%d x=", ratio, clashes(part, entry, end, unit));
        for (int q = 0; q < part->component->system->n_x; q++)
            DBG(" %.9g", part->x[q]);
        DBG("\n");
        if (status != DALCS_OK || clashes(part, entry, end, unit) ||
            (!(ratio <= tolerated) && (!fixed || (part->fresh && restarts == 0))) ||
            ratio != ratio) {
            bool small = ratio < most_projected;
            if (part->fresh && restarts == 0) {
                DALCS_TRY(dalcs_radau_restart(r, part, restarts++));
                part->level = fixed ? part->level : first_level;
                stuck = 0;
                before = INFINITY;
                continue;
            }
            if (small && !fixed && !projected) {
                bool moved;
                projected = true;
                DALCS_TRY(project(part, limit, &moved));
                if (moved) {
                    continue;
                }
            }
            r->rejected++;
            /* An error that does not shrink with the step is what the state is off by, from an event
             * or by rounding: a smaller step would not mend it. */
            stuck = ratio > 0.3 * before ? stuck + 1 : 0;
            before = ratio;
            if (stuck >= STUCK && of_unit < most_tolerated && tolerated == 1.0) {
                tolerated = 4.0 * ratio;
                part->level = first_level;
                continue;
            }
            if (fixed || dalcs_radau_ladder(part->level) < 64.0 * r->resolution) {
                part->level = first_level;
                return fall_back(r, part, limit, part->tries++);
            }
            part->level += rungs_for(ratio, stages) < 1 ? 1 : rungs_for(ratio, stages);
            part->patience = part->grew ? 2 * part->patience : LEAST_PATIENCE;
            part->patience = part->patience < MOST_PATIENCE ? part->patience : MOST_PATIENCE;
            part->waited = 0;
            part->grew = false;
            continue;
        }
        double reach[2];
        find_reach(part, unit, reach);
        if (part->fresh) {
            arm(r, part, 0.0, reach);
        }
        bool at_once;
        double theta = find_crossing(r, part, end, reach, &at_once);
        if (part->n_crossed) {
            DBG("  cross theta=%g at_once=%d armed=%d:", theta, at_once,
                part->armed[part->crossed[0]]);
            for (int q = 0; q < part->n_crossed; q++)
                DBG(" %d", part->crossed[q]);
            DBG("\n");
        }
        if (at_once && part->fresh) {
            if (restarts < MOST_RESTARTS && pivots == 0) {
                DALCS_TRY(dalcs_radau_restart(r, part, restarts++));
            } else if (pivots++ < PIVOTS) {
                dalcs_segment_flip(part);
            } else {
                part->fresh = true;
                return fall_back(r, part, limit, part->tries++);
            }
            continue;
        }
        if (part->fresh && restarts == 0 && stays_tied(part, reach)) {
            DALCS_TRY(dalcs_radau_restart(r, part, restarts++));
            continue;
        }
        part->tries = 0;
        accept(r, part, fmin(theta, end), limit, unit);
        part->fresh = false;
        if (!fixed && theta >= 1.0) {
            grow(part, ratio * ldexp(1.0, stages + 1) < safety);
        }
        return DALCS_OK;
    }
}

double dalcs_segment_longest(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    double longest = r->options.stop;
    if (r->options.max_step > 0.0) {
        longest = fmin(longest, r->options.max_step);
    }
    return fmin(longest, most_periods(part->stages.method.s) * part->excitation.shortest_period);
}

void dalcs_segment_values(const struct dalcs_radau_part *part, double theta, double *value) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    double weight[DALCS_MAX_NODES];
    dalcs_collocation_weights(&part->stages.method, theta, weight);
    for (int c = 0; c < l->stride; c++) {
        value[c] = 0.0;
    }
    for (int k = 0; k < l->n_nodes; k++) {
        const double *y = part->out + k * l->stride;
        for (int c = 0; c < l->stride; c++) {
            value[c] += weight[k] * y[c];
        }
    }
}

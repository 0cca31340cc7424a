/* row_gaps.c - derivatives of what outputs read, part by part, and the gaps that they allow. */
#include "row_gaps_internal.h"

#include "extremes.h"
#include "magnitudes.h"
#include "radau_state.h"
#include "wide_vectors.h"

#include <math.h>
#include <string.h>

/* Of the bound, what a curve may take: the largest derivative may lie between the places. */
static const double share = 0.5;

/* Polynomials of fewer stages have no fourth derivative: they bend where they meet. */
enum { ENOUGH_STAGES = 5 };

/* ---- Derivatives ------------------------------------------------------------------------------- */

/* The largest magnitude of a polynomial at some places of a step's first part. */
static inline __attribute__((always_inline)) double
size_of(const struct dalcs_collocation *c, const double *coefficient, double part) {
    static const double place[DALCS_QUAD] = {0.0, 0.4, 0.7, 1.0};
    dalcs_quad theta;
    dalcs_quad_load(&theta, place);
    theta *= part;
    dalcs_quad value = {0.0};
    value += coefficient[c->s];
    for (int k = c->s - 1; k >= 0; k--) {
        value = value * (theta - c->differences.node[k]) + coefficient[k];
    }
    dalcs_quad_unsign(&value);
    return dalcs_quad_largest(&value);
}

/* sum of coefficient times derivative, its largest magnitude over the places. */
static inline __attribute__((always_inline)) double
largest_of(int s, const double *coefficient, const double (*derivative)[DALCS_N_PLACES]) {
    dalcs_quad sum[DALCS_N_PLACES / DALCS_QUAD] = {{0.0}};
    for (int k = 2; k <= s; k++) {
        for (int q = 0; q < DALCS_N_PLACES / DALCS_QUAD; q++) {
            dalcs_quad factor;
            dalcs_quad_load(&factor, derivative[k] + q * DALCS_QUAD);
            sum[q] += factor * coefficient[k];
        }
    }
    dalcs_quad largest = {0.0};
    for (int q = 0; q < DALCS_N_PLACES / DALCS_QUAD; q++) {
        dalcs_quad_unsign(&sum[q]);
        dalcs_quad_raise(&largest, &sum[q]);
    }
    return dalcs_quad_largest(&largest);
}

/* Of polynomials in steps of length h, of which a part counts. */
DALCS_TWICE(void, find_bends,
            (const struct dalcs_row_basis *basis, const struct dalcs_collocation *c, double h,
             double part, const double *coefficient, int n, struct dalcs_bend *bend),
            (basis, c, h, part, coefficient, n, bend)) {
    const double per_second = 1.0 / (h * h);
    const double per_fourth = per_second * per_second;
    for (int i = 0; i < n; i++, coefficient += DALCS_MAX_NODES) {
        bend[i].size = size_of(c, coefficient, part);
        bend[i].second = per_second * largest_of(c->s, coefficient, basis->second);
        bend[i].fourth = per_fourth * largest_of(c->s, coefficient, basis->fourth);
    }
}

/* Of a stimulus, from one time to another between edges: of a sum of exponentials and sinusoids no larger than those of
 * its terms together. Without damping it is the same up to the next edge, which a formula is asked for but once. */
static void bend_stimulus(struct dalcs_row_gaps *gaps, struct dalcs_row_gaps_curve *curve,
                          double from, double to) {
    const struct dalcs_stimulus *s = &gaps->rows->radau->base->circuit->stimulus[curve->stimulus];
    struct dalcs_bend *bend = &gaps->stimulus[curve->stimulus];
    struct dalcs_stimulus_piece piece = {.term = gaps->term};
    bool stays = true;
    dalcs_stimulus_course_at(s, from, &piece);
    *bend = (struct dalcs_bend){0.0, 0.0, 0.0};
    for (int k = 0; k < piece.n_terms; k++) {
        const struct dalcs_stimulus_term *term = &piece.term[k];
        double rate = term->decay * term->decay + term->omega * term->omega;
        double size = hypot(term->cosine, term->sine);
        size *= term->decay < 0.0 ? exp(-term->decay * (to - from)) : 1.0;
        bend->size += size;
        bend->second += rate * size;
        bend->fourth += rate * rate * size;
        stays = stays && term->decay == 0.0;
    }
    curve->from = from;
    curve->to = stays ? dalcs_stimulus_next_edge(s, from) : from;
}

static void bend_stimuli(struct dalcs_row_gaps *gaps, double from, double to) {
    for (int i = 0; i < gaps->n_curved; i++) {
        struct dalcs_row_gaps_curve *curve = &gaps->curved[i];
        if (!(from >= curve->from && from < curve->to)) {
            bend_stimulus(gaps, curve, from, to);
        }
    }
}

static inline void add(struct dalcs_bend *to, double factor, const struct dalcs_bend *bend) {
    double size = fabs(factor);
    to->size += size * bend->size;
    to->second += size * bend->second;
    to->fourth += size * bend->fourth;
}

/* What sources alone decide, times a factor. */
static void add_source(const struct dalcs_row_gaps *gaps, const struct dalcs_radau_part *part,
                       const struct dalcs_row_source *source, double factor,
                       struct dalcs_bend *to) {
    const struct dalcs_system *s = part->component->system;
    if (!source->is_bystander) {
        add(to, factor, &gaps->stimulus[s->stimulus[source->index]]);
        return;
    }
    const double *gain = part->excitation.bystanders.gain + source->index * s->n_inputs;
    for (int k = 1; k < s->n_inputs; k++) {
        add(to, factor * gain[k], &gaps->stimulus[s->stimulus[k]]);
    }
}

static void add_sources(const struct dalcs_row_gaps *gaps, const struct dalcs_rows_part *p,
                        const struct dalcs_radau_part *part, const struct dalcs_probe *probe,
                        struct dalcs_bend *to) {
    int n_columns = dalcs_system_n_columns(part->component->system);
    for (int i = 0; i < probe->n_terms + probe->n_inputs; i++) {
        const struct dalcs_probe_term *term = &probe->term[i];
        int place = p->place[i < probe->n_terms ? term->index : n_columns + term->index];
        if (place >= 0) {
            add_source(gaps, part, &p->source[place], term->coefficient, to);
        }
    }
}

static enum dalcs_status look_at_stepped(struct dalcs_row_gaps *gaps,
                                         struct dalcs_radau_part *part) {
    const struct dalcs_rows_part *p = &gaps->rows->part[part->index];
    struct dalcs_row_gaps_part *g = &gaps->part[part->index];
    if (p->n_read > 0 && g->number != part->segment.number) {
        DALCS_TRY(dalcs_rows_find_polynomials(gaps->rows, part));
        find_bends(g->basis, part->stages.method, part->segment.h, part->segment.end,
                   p->coefficient, p->n_read, g->bend);
        g->number = part->segment.number;
    }
    if (part->segment.by_euler || part->stages.method->s < ENOUGH_STAGES) {
        gaps->line = dalcs_smaller(gaps->line, part->segment.h);
        gaps->cubic = dalcs_smaller(gaps->cubic, part->segment.h);
    }
    const struct dalcs_bend *bend = g->bend;
    for (int i = 0; i < p->n_signals; bend++) {
        int output = p->signal[i].output;
        add(&gaps->of_steps[output], 1.0, bend);
        for (; i < p->n_signals && p->signal[i].output == output; i++) {
            if (gaps->n_curved > 0) {
                add_sources(gaps, p, part, p->signal[i].probe, &gaps->of_sources[output]);
            }
        }
    }
    return DALCS_OK;
}

/* The outputs of such a part are fixed sums of sources: they bend no more than the source that bends most for its
 * size. */
static void look_at_algebraic(struct dalcs_row_gaps *gaps, const struct dalcs_radau_part *part) {
    const struct dalcs_component *c = part->component;
    for (int i = 0; i < c->varying.n && gaps->rows->part[part->index].n_signals > 0; i++) {
        const struct dalcs_bend *bend = &gaps->stimulus[c->system->stimulus[c->varying.input[i]]];
        if (bend->size > 0.0) {
            struct dalcs_bend *most = &gaps->algebraic;
            most->second = dalcs_larger(most->second, bend->second / bend->size);
            most->fourth = dalcs_larger(most->fourth, bend->fourth / bend->size);
        }
    }
}

/* ---- Gaps -------------------------------------------------------------------------------------- */

void dalcs_row_gaps_note(struct dalcs_row_gaps *gaps) {
    for (int i = 0; i < gaps->n_outputs; i++) {
        gaps->largest[i] = dalcs_larger(gaps->largest[i], fabs(gaps->rows->value[i].at[0]));
    }
}

/* What outputs are at least, somewhere in the stretch; of_unit[2]: the largest in V and A. */
static void raise_largest(struct dalcs_row_gaps *gaps, double *of_unit) {
    for (int i = 0; i < gaps->n_outputs; i++) {
        double size = fabs(gaps->of_steps[i].size - gaps->of_sources[i].size);
        gaps->largest[i] = dalcs_larger(gaps->largest[i], size);
        double *unit = &of_unit[dalcs_row_is_current(gaps, i) ? 1 : 0];
        *unit = dalcs_larger(*unit, gaps->largest[i]);
    }
}

/* What it is measured by: no less than what is nothing beside the largest of its unit. */
static double scale_of(const struct dalcs_row_gaps *gaps, int output, const double *of_unit) {
    int unit = dalcs_row_is_current(gaps, output) ? 1 : 0;
    double least =
        dalcs_larger(dalcs_nothing * of_unit[unit], gaps->cross[output] * of_unit[1 - unit]);
    return dalcs_larger(gaps->largest[output], least);
}

static void choose_gaps(struct dalcs_row_gaps *gaps) {
    double of_unit[2] = {0.0, 0.0};
    raise_largest(gaps, of_unit);
    struct dalcs_bend most = gaps->algebraic;
    for (int i = 0; i < gaps->n_outputs; i++) {
        double size = scale_of(gaps, i, of_unit);
        double second = gaps->of_steps[i].second + gaps->of_sources[i].second;
        double fourth = gaps->of_steps[i].fourth + gaps->of_sources[i].fourth;
        if (size > 0.0 && second > most.second * size) {
            most.second = second / size;
        }
        if (size > 0.0 && fourth > most.fourth * size) {
            most.fourth = fourth / size;
        }
    }
    double allowed = share * gaps->bound;
    gaps->line = dalcs_smaller(gaps->line, sqrt(8.0 * allowed / most.second));
    gaps->cubic = dalcs_smaller(gaps->cubic, sqrt(sqrt(128.0 / 3.0 * allowed / most.fourth)));
}

enum dalcs_status dalcs_row_gaps_look(struct dalcs_row_gaps *gaps, double from, double to) {
    const struct dalcs_rows *rows = gaps->rows;
    const size_t size = (size_t)rows->n_outputs * sizeof(*gaps->of_steps);
    memset(gaps->of_steps, 0, size);
    memset(gaps->of_sources, 0, size);
    gaps->algebraic = (struct dalcs_bend){0.0, 0.0, 0.0};
    gaps->line = INFINITY;
    gaps->cubic = INFINITY;
    bend_stimuli(gaps, from, to);
    for (int i = 0; i < rows->n_asked; i++) {
        struct dalcs_radau_part *part = &rows->radau->part[rows->asked[i]];
        if (part->kind == DALCS_PART_ALGEBRAIC) {
            look_at_algebraic(gaps, part);
        } else {
            DALCS_TRY(look_at_stepped(gaps, part));
        }
    }
    choose_gaps(gaps);
    return DALCS_OK;
}

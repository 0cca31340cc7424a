/* measures.c - hands the measurements stretches of the solution: of radau's polynomials between
 * everything that happens, of the straight lines of implicit Euler, of the rows of a sweep. */
#include "measures.h"

#include "losses_run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A stretch of a sinusoid or an exponential is resolved up to this many radians and time constants. */
static const double most_turn = 3.6, most_decay = 3.0;

/* Parts of a source of this size, over the largest, are over. */
static const double is_over = 1e-17;

static enum dalcs_status allocate(struct dalcs_measures *measures, const struct dalcs_circuit *c,
                                  const struct dalcs_network *n) {
    int n_terms = 0;
    for (int i = 0; i < c->n_stimuli; i++) {
        int terms = dalcs_stimulus_n_terms(&c->stimulus[i]);
        n_terms = terms > n_terms ? terms : n_terms;
    }
    measures->network = n;
    measures->reads = dalcs_alloc((size_t)n->n_systems, sizeof(bool));
    measures->stimulus = dalcs_alloc((size_t)c->n_stimuli, sizeof(const struct dalcs_stimulus *));
    measures->term = dalcs_alloc((size_t)n_terms, sizeof(*measures->term));
    measures->before = dalcs_alloc((size_t)c->results.n_measured, sizeof(double));
    measures->now = dalcs_alloc((size_t)c->results.n_measured, sizeof(double));
    bool complete = measures->reads != NULL && measures->stimulus != NULL &&
                    measures->term != NULL && measures->before != NULL && measures->now != NULL;
    return complete ? dalcs_edges_ahead_setup(&measures->edges, (size_t)c->n_stimuli)
                    : DALCS_E_NOMEM;
}

/* Which components, and what drives them. */
static void find_sources(struct dalcs_measures *measures, const struct dalcs_circuit *circuit,
                         const struct dalcs_euler *e) {
    for (int k = 0; k < circuit->results.n_measured; k++) {
        const struct dalcs_output *out = &measures->network->output[circuit->results.measured[k]];
        const int system[2] = {out->plus.system, out->minus.system};
        for (int side = 0; side < 2; side++) {
            if (system[side] >= 0) {
                measures->reads[system[side]] = true;
            }
        }
    }
    for (int k = 0; k < e->n_components; k++) {
        const struct dalcs_component *c = &e->component[k];
        for (int i = 0; measures->reads[k] && i < c->varying.n; i++) {
            const struct dalcs_stimulus *s =
                &circuit->stimulus[c->system->stimulus[c->varying.input[i]]];
            bool known = false;
            for (int j = 0; j < measures->n_stimuli && !known; j++) {
                known = measures->stimulus[j] == s;
            }
            if (!known) {
                measures->stimulus[measures->n_stimuli++] = s;
                dalcs_edges_ahead_add(&measures->edges, s);
            }
        }
    }
}

static void read_signals(const struct dalcs_measures *measures, const struct dalcs_euler *e,
                         double *value) {
    const struct dalcs_circuit *c = measures->measuring.circuit;
    for (int k = 0; k < c->results.n_measured; k++) {
        value[k] = dalcs_recorder_signal(measures->network, e, c->results.measured[k]);
    }
}

/* What is told beside the waveforms of a slide. */
static enum dalcs_status ask_sides(struct dalcs_measures *measures, struct dalcs_radau *radau) {
    struct dalcs_side_means *sides = &measures->sides;
    DALCS_TRY(dalcs_side_means_setup(sides, radau, measures->measuring.circuit->results.measured));
    DALCS_TRY(dalcs_measuring_ask_sides(&measures->measuring, sides));
    return measures->losses != NULL ? dalcs_losses_sum_ask_sides(&measures->losses->sum, sides)
                                    : DALCS_OK;
}

enum dalcs_status dalcs_measures_prepare(struct dalcs_measures *measures, struct dalcs_run *r,
                                         struct dalcs_radau *radau) {
    const struct dalcs_circuit *c = &r->s->circuit;
    measures->next_edge = INFINITY;
    measures->begin = INFINITY;
    const bool is_period = r->orbit != NULL && !r->leaves_orbit;
    const enum dalcs_measured_analysis analysis =
        is_period ? DALCS_MEASURED_PSS : DALCS_MEASURED_TRAN;
    if (!dalcs_measuring_is_wanted(c, analysis)) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_measuring_setup(&measures->measuring, c, analysis, c->analyses.transient.start,
                                    c->analyses.transient.stop));
    measures->wanted = true;
    measures->measuring.near = radau != NULL ? radau->resolution : 0.0;
    measures->measuring.is_euler = radau == NULL;
    /* what is just before a window is known, too */
    measures->begin = dalcs_measuring_begin(&measures->measuring) - 4.0 * measures->measuring.near;
    measures->losses = r->transient.losses;
    measures->impulses = r->transient.impulses;
    return radau != NULL ? ask_sides(measures, radau) : DALCS_OK;
}

enum dalcs_status dalcs_measures_start(struct dalcs_measures *measures, struct dalcs_run *r,
                                       const struct dalcs_euler *e, struct dalcs_radau *radau,
                                       struct dalcs_audit_run *audit) {
    const struct dalcs_circuit *c = &r->s->circuit;
    if (!measures->wanted) {
        return DALCS_OK;
    }
    if (r->transient.losses != NULL) {
        r->transient.losses->audit.run = radau != NULL && audit->audit != NULL ? audit : NULL;
        measures->begin = fmin(measures->begin, dalcs_losses_run_begin(r->transient.losses));
    }
    DALCS_TRY(allocate(measures, c, &r->s->network));
    const struct dalcs_recorder *recorder = &r->s->results.recorder;
    if (recorder->starts_on_edge) {
        for (int k = 0; k < c->results.n_measured; k++) {
            measures->before[k] = recorder->before[c->results.measured[k]];
        }
        dalcs_measuring_before_start(&measures->measuring, measures->before);
        if (measures->losses != NULL) {
            dalcs_losses_sum_before_start(&measures->losses->sum, measures->before);
        }
    }
    if (radau == NULL) {
        read_signals(measures, e, measures->now);
        if (measures->losses != NULL && !measures->losses->sum.has_last) {
            dalcs_losses_sum_before_start(&measures->losses->sum, measures->now);
        }
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_rows_setup(&measures->rows, radau, c->results.measured, c->results.n_measured));
    find_sources(measures, c, e);
    measures->next_edge = dalcs_edges_ahead_after(&measures->edges, 0.0);
    return dalcs_audit_measures_start(&measures->audit, audit, &measures->measuring);
}

void dalcs_measures_finish(struct dalcs_measures *measures) {
    if (measures->wanted) {
        dalcs_measuring_finish(&measures->measuring);
    }
    dalcs_rows_finish(&measures->rows);
    dalcs_side_means_finish(&measures->sides);
    dalcs_audit_measures_finish(&measures->audit);
    free(measures->reads);
    free(measures->stimulus);
    dalcs_edges_ahead_finish(&measures->edges);
    free(measures->term);
    free(measures->before);
    free(measures->now);
    *measures = (struct dalcs_measures){0};
}

/* ---- Radau ------------------------------------------------------------------------------------- */

/* How far a stretch from t may go, for the sake of the sources: what they drive has their shape where
 * it has no memory, however long the steps are. */
static double longest(const struct dalcs_measures *measures, double t) {
    double length = INFINITY;
    for (int i = 0; i < measures->n_stimuli; i++) {
        struct dalcs_stimulus_piece piece = {.term = measures->term};
        if (dalcs_stimulus_n_terms(measures->stimulus[i]) == 0) {
            continue;
        }
        dalcs_stimulus_piece_at(measures->stimulus[i], t, &piece);
        double largest = fabs(piece.level);
        for (int k = 0; k < piece.n_terms; k++) {
            largest = fmax(largest, hypot(piece.term[k].cosine, piece.term[k].sine));
        }
        for (int k = 0; k < piece.n_terms; k++) {
            const struct dalcs_stimulus_term *term = &piece.term[k];
            if (hypot(term->cosine, term->sine) > is_over * largest) {
                length = fmin(length, most_turn / fabs(term->omega));
                length = fmin(length, most_decay / fabs(term->decay));
            }
        }
    }
    return length;
}

static enum dalcs_status hand_over(struct dalcs_measures *measures, double from, double to) {
    struct dalcs_measuring *m = &measures->measuring;
    double time[DALCS_STRETCH_NODES];
    for (int i = 0; i < DALCS_STRETCH_NODES; i++) {
        time[i] = from + 0.5 * (1.0 + m->rule.node[i]) * (to - from);
    }
    int n_done;
    for (int first = 0; first < DALCS_STRETCH_NODES; first += n_done) {
        DALCS_TRY(dalcs_rows_fill(&measures->rows, time + first, DALCS_STRETCH_NODES - first,
                                  DALCS_RIGHT, &n_done));
        for (int k = 0; k < m->stretch.n_signals; k++) {
            memcpy(m->stretch.value[k] + first, measures->rows.value[k].at,
                   (size_t)n_done * sizeof(double));
        }
    }
    dalcs_measuring_stretch(m, from, to, dalcs_measures_find_impulses(measures, from));
    if (measures->losses != NULL) {
        dalcs_losses_run_stretch(measures->losses, &m->stretch);
    }
    return DALCS_OK;
}

/* Does anything end at t that the measured signals see? */
static bool ends_at(const struct dalcs_measures *measures, const struct dalcs_radau *radau,
                    double t, double near) {
    bool ends = measures->next_edge <= t + near || t >= radau->options.stop - near;
    for (int k = 0; k < radau->n_parts && !ends; k++) {
        ends = measures->reads[k] && radau->part[k].segment.t_end <= t;
    }
    return ends;
}

enum dalcs_status dalcs_measures_reach(struct dalcs_measures *measures,
                                       const struct dalcs_radau *radau, double t, double near) {
    if (!measures->wanted || !ends_at(measures, radau, t, near)) {
        return DALCS_OK;
    }
    if (t <= measures->begin) { /* before all windows: as where a leap passes over it */
        measures->t = t;
    }
    while (measures->t < t) {
        double to = fmin(t, measures->t + longest(measures, measures->t));
        if (to - measures->t > near) {
            DALCS_TRY(hand_over(measures, measures->t, to));
        }
        measures->t = to;
    }
    if (measures->next_edge <= t + near) {
        measures->next_edge =
            dalcs_edges_ahead_after(&measures->edges, fmax(t, measures->next_edge));
    }
    return DALCS_OK;
}

void dalcs_measures_end_at(struct dalcs_measures *measures, double t) {
    measures->next_edge = fmin(measures->next_edge, t);
}

void dalcs_measures_renew(struct dalcs_measures *measures, double t) {
    measures->next_edge = dalcs_edges_ahead_after(&measures->edges, t);
}

void dalcs_measures_skip(struct dalcs_measures *measures, double t) {
    measures->t = t;
    measures->next_edge = dalcs_edges_ahead_after(&measures->edges, t);
}

/* ---- Implicit Euler and rows ------------------------------------------------------------------- */

/* The powers of a step of implicit Euler are those at its end: so its energies add up to the ledger's. */
static void add_constant_stretch(struct dalcs_measures *measures) {
    struct dalcs_measuring *m = &measures->measuring;
    for (int k = 0; k < m->stretch.n_signals; k++) {
        for (int i = 0; i < DALCS_STRETCH_NODES; i++) {
            m->stretch.value[k][i] = measures->now[k];
        }
        dalcs_stretch_expand(&m->rule, m->stretch.value[k], m->stretch.coefficient[k]);
    }
    dalcs_losses_run_stretch(measures->losses, &m->stretch);
}

void dalcs_measures_step(struct dalcs_measures *measures, const struct dalcs_euler *e) {
    struct dalcs_measuring *m = &measures->measuring;
    if (!measures->wanted) {
        return;
    }
    double *swap = measures->before;
    measures->before = measures->now;
    measures->now = swap;
    read_signals(measures, e, measures->now);
    for (int k = 0; k < m->stretch.n_signals; k++) {
        for (int i = 0; i < DALCS_STRETCH_NODES; i++) {
            double theta = 0.5 * (1.0 + m->rule.node[i]);
            m->stretch.value[k][i] =
                measures->before[k] + theta * (measures->now[k] - measures->before[k]);
        }
    }
    dalcs_measuring_stretch(m, e->t_before, e->t, dalcs_measures_find_blurred(measures));
    if (measures->losses != NULL) {
        add_constant_stretch(measures);
    }
    if (measures->impulses != NULL) {
        measures->impulses->is_noted = false; /* they were of this step */
    }
}

void dalcs_measures_cross(struct dalcs_measures *measures, const struct dalcs_euler *e) {
    if (measures->wanted) {
        read_signals(measures, e, measures->now);
    }
}

enum dalcs_status dalcs_measures_start_rows(struct dalcs_measures *measures, struct dalcs_run *r,
                                            enum dalcs_measured_analysis analysis, double start,
                                            double stop) {
    const struct dalcs_circuit *c = &r->s->circuit;
    if (!dalcs_measuring_is_wanted(c, analysis)) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_measuring_setup(&measures->measuring, c, analysis, start, stop));
    measures->wanted = true;
    return allocate(measures, c, &r->s->network);
}

void dalcs_measures_row(struct dalcs_measures *measures, double at, const double *value) {
    const struct dalcs_circuit *c = measures->measuring.circuit;
    if (!measures->wanted) {
        return;
    }
    for (int k = 0; k < c->results.n_measured; k++) {
        measures->now[k] = value[c->results.measured[k]];
    }
    dalcs_measuring_row(&measures->measuring, at, measures->now, NULL);
}

void dalcs_measures_complex_row(struct dalcs_measures *measures, double at, const double *value) {
    const struct dalcs_circuit *c = measures->measuring.circuit;
    if (!measures->wanted) {
        return;
    }
    for (int k = 0; k < c->results.n_measured; k++) {
        measures->now[k] = value[2 * c->results.measured[k]];
        measures->before[k] =
            value[2 * c->results.measured[k] + 1]; /* which rows have no other use for */
    }
    dalcs_measuring_row(&measures->measuring, at, measures->now, measures->before);
}

/* stepped_run.c - .step: the analyses with each value, and what was measured in all of them. */
#include "failed_steps.h"
#include "orbit_analyses.h"

#include <stdlib.h>
#include <string.h>

/* What a step cost on top of those before it. */
static void add_work(struct dalcs_report *sum, const struct dalcs_report *one) {
    sum->work.steps += one->work.steps;
    sum->work.rejected += one->work.rejected;
    sum->work.restarts += one->work.restarts;
    sum->work.euler_steps += one->work.euler_steps;
    sum->work.periodic_steps += one->work.periodic_steps;
    sum->work.leapt_steps += one->work.leapt_steps;
    sum->work.osnsp += one->work.osnsp;
    sum->work.pivots += one->work.pivots;
    sum->work.factorizations += one->work.factorizations;
    sum->work.cache_hits += one->work.cache_hits;
    sum->work.singular += one->work.singular;
    sum->work.cpu_s += one->work.cpu_s;
    sum->work.wall_s += one->work.wall_s;
}

/* What was measured in all steps. */
struct measured {
    size_t n, capacity, n_fourier, fourier_capacity;
    struct dalcs_measurement *measurement;
    struct dalcs_fourier *fourier;
    size_t n_losses, losses_capacity;
    struct dalcs_losses *losses;
};

static enum dalcs_status collect_measured(struct measured *all, struct dalcs_session *s,
                                          const struct dalcs_plot *step) {
    const struct dalcs_report *one = &s->results.report;
    if (one->n_measurements + one->n_fourier + one->n_losses == 0) {
        return DALCS_OK;
    }
    const char *text = dalcs_step_text(s, step);
    if (text == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_grow(&all->measurement, &all->capacity, all->n + one->n_measurements,
                         sizeof *all->measurement));
    DALCS_TRY(dalcs_grow(&all->fourier, &all->fourier_capacity, all->n_fourier + one->n_fourier,
                         sizeof *all->fourier));
    DALCS_TRY(dalcs_grow(&all->losses, &all->losses_capacity, all->n_losses + one->n_losses,
                         sizeof *all->losses));
    for (size_t k = 0; k < one->n_measurements; k++) {
        all->measurement[all->n] = one->measurement[k];
        all->measurement[all->n++].step = text;
    }
    for (size_t k = 0; k < one->n_fourier; k++) {
        all->fourier[all->n_fourier] = one->fourier[k];
        all->fourier[all->n_fourier++].step = text;
    }
    for (size_t k = 0; k < one->n_losses; k++) {
        all->losses[all->n_losses] = one->losses[k];
        all->losses[all->n_losses++].step = text;
    }
    return DALCS_OK;
}

/* The measurements of one analysis, from number `first` on: how many each step has. */
struct blocks {
    size_t first, n_steps;
    size_t *n; /* [n_steps] */
};

/* Each step has the same ones: those of a step that failed before it measured were not found. */
static enum dalcs_status fill_failed(struct measured *all, const struct blocks *blocks,
                                     const struct dalcs_failed_steps *failed) {
    size_t most = 0, at = blocks->first, pattern = at;
    for (size_t k = 0; k < blocks->n_steps; at += blocks->n[k++]) {
        pattern = blocks->n[k] > most ? at : pattern;
        most = blocks->n[k] > most ? blocks->n[k] : most;
    }
    for (size_t f = 0; f < failed->n && most > 0; f++) {
        const struct dalcs_failed_step *step = &failed->step[f];
        if (step->step >= blocks->n_steps || blocks->n[step->step] > 0) {
            continue;
        }
        DALCS_TRY(dalcs_grow(&all->measurement, &all->capacity, all->n + most,
                             sizeof(*all->measurement)));
        at = blocks->first;
        for (size_t k = 0; k < step->step; k++) {
            at += blocks->n[k];
        }
        pattern += pattern >= at ? most : 0;
        memmove(all->measurement + at + most, all->measurement + at,
                (all->n - at) * sizeof(*all->measurement));
        const struct dalcs_measurement *one = all->measurement + pattern;
        for (size_t k = 0; k < most; k++) {
            all->measurement[at + k] = (struct dalcs_measurement){
                .name = one[k].name, .step = step->values, .failure = step->because};
        }
        all->n += most;
        blocks->n[step->step] = most;
    }
    return DALCS_OK;
}

/* Into the report, where they live as long as it. */
static enum dalcs_status report_measured(struct measured *all, struct dalcs_session *s) {
    struct dalcs_measurement *m = dalcs_arena_alloc(&s->arena, all->n + 1, sizeof *m);
    struct dalcs_fourier *f = dalcs_arena_alloc(&s->arena, all->n_fourier + 1, sizeof *f);
    struct dalcs_losses *l = dalcs_arena_alloc(&s->arena, all->n_losses + 1, sizeof *l);
    enum dalcs_status status = m == NULL || f == NULL || l == NULL ? DALCS_E_NOMEM : DALCS_OK;
    for (size_t k = 0; k < all->n_losses && status == DALCS_OK; k++) {
        l[k] = all->losses[k];
    }
    for (size_t k = 0; k < all->n && status == DALCS_OK; k++) {
        m[k] = all->measurement[k];
    }
    for (size_t k = 0; k < all->n_fourier && status == DALCS_OK; k++) {
        f[k] = all->fourier[k];
    }
    s->results.report.measurement = m;
    s->results.report.n_measurements = status == DALCS_OK ? all->n : 0;
    s->results.report.fourier = f;
    s->results.report.n_fourier = status == DALCS_OK ? all->n_fourier : 0;
    s->results.report.losses = l;
    s->results.report.n_losses = status == DALCS_OK ? all->n_losses : 0;
    free(all->measurement);
    free(all->fourier);
    free(all->losses);
    return status;
}

static bool is_asked(const struct dalcs_circuit *circuit, const struct dalcs_run_options *options,
                     enum dalcs_analysis analysis) {
    if (options->steady || options->bode || options->envelope) {
        return analysis == (options->steady ? DALCS_PERIODIC
                            : options->bode ? DALCS_AC
                                            : DALCS_TRANSIENT);
    }
    const bool asked[] = {[DALCS_OPERATING_POINT] = circuit->analyses.operating_point,
                          [DALCS_TRANSIENT] = circuit->analyses.transient.present,
                          [DALCS_DC_SWEEP] = circuit->analyses.n_dc > 0,
                          [DALCS_TRANSFER] = circuit->analyses.transfer.present,
                          [DALCS_AC] = circuit->analyses.ac.n > 0,
                          [DALCS_PERIODIC] = circuit->analyses.periodic.present};
    return asked[analysis];
}

/* All steps, with what they have in common. */
struct stepping {
    struct dalcs_session *session;
    const struct dalcs_run_options *options;
    const struct dalcs_sink *sink;
    size_t first, end; /* steps */
    struct dalcs_report sum;
    struct measured measured;
    struct dalcs_failed_steps failed;
    const char *title; /* of a circuit that was built; the arena's */
};

/* One analysis of step k. */
static enum dalcs_status run_step(struct stepping *g, enum dalcs_analysis analysis, size_t k,
                                  struct dalcs_plot *step) {
    struct dalcs_session *session = g->session;
    DALCS_TRY(dalcs_steady_anchor_prepare(session, g->options, g->sink, analysis, k));
    DALCS_TRY(dalcs_session_take_step(session, k, step));
    if (g->options->only_step > 0) {
        step->step = 0;
        step->n_steps = 1; /* what follows is of one run */
    }
    if (g->title == NULL) {
        const char *title = session->circuit.title;
        g->title = dalcs_arena_copy(&session->arena, title, strlen(title));
    }
    DALCS_TRY(dalcs_operating_currents(session, g->options, g->sink));
    const enum dalcs_status status =
        dalcs_run_analyses(session, g->options, g->sink, step, &analysis, 1);
    add_work(&g->sum, &session->results.report);
    const enum dalcs_status kept = collect_measured(&g->measured, session, step);
    return status == DALCS_OK ? kept : status;
}

/* May the steps behind one that ended so be run? What is looked at once a period goes on from value to value. */
static bool goes_on(const struct stepping *g, enum dalcs_status status) {
    return dalcs_step_lets_go_on(status) && g->session->steady.stroboscope == NULL;
}

static enum dalcs_status run_steps(struct stepping *g, enum dalcs_analysis analysis,
                                   struct blocks *blocks) {
    for (size_t k = g->first; k < g->end; k++) {
        const struct dalcs_diag_mark before = dalcs_diag_mark(&g->session->diag);
        const size_t n = g->measured.n;
        struct dalcs_plot step = {0};
        enum dalcs_status status = DALCS_OK;
        if (!dalcs_failed_steps_has(&g->failed, k)) {
            status = run_step(g, analysis, k, &step);
        }
        blocks->n[k] = g->measured.n - n;
        if (dalcs_step_lets_go_on(status)) {
            step.step = k;
            DALCS_TRY(dalcs_failed_steps_add(&g->failed, g->session, &step, status, &before));
        }
        if (status != DALCS_OK && !goes_on(g, status)) {
            return status;
        }
    }
    return fill_failed(&g->measured, blocks, &g->failed);
}

/* There is one, too, where the last step could not be built. */
static void make_report(struct stepping *g) {
    struct dalcs_session *s = g->session;
    if (!s->results.has_report && g->title != NULL) {
        s->results.report = (struct dalcs_report){.netlist = s->name,
                                                  .title = g->title,
                                                  .method = dalcs_method_name(0),
                                                  .certificate = {.where = ""}};
        s->results.has_report = true;
    }
}

static enum dalcs_status run_all_steps(struct stepping *g) {
    const struct dalcs_circuit *circuit = &g->session->circuit;
    struct blocks blocks = {.n_steps = g->end};
    bool asked[DALCS_N_IN_ORDER];
    for (size_t a = 0; a < DALCS_N_IN_ORDER; a++) {
        asked[a] = is_asked(circuit, g->options, dalcs_analyses_in_order[a]);
    }
    blocks.n = dalcs_alloc(g->end, sizeof(*blocks.n));
    enum dalcs_status status = blocks.n == NULL ? DALCS_E_NOMEM : DALCS_OK;
    for (size_t a = 0; a < DALCS_N_IN_ORDER && status == DALCS_OK; a++) {
        blocks.first = g->measured.n;
        status = asked[a] ? run_steps(g, dalcs_analyses_in_order[a], &blocks) : DALCS_OK;
    }
    free(blocks.n);
    return status;
}

enum dalcs_status dalcs_stepped_run(struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const struct dalcs_sink *sink) {
    const size_t n_all = dalcs_steps_count(session);
    const size_t only = options->only_step;
    if (only > n_all) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, NULL,
                       "there are %zu steps, and no step %zu", n_all, only);
        return DALCS_E_OPTION;
    }
    dalcs_steady_anchor_enter(session, options);
    struct stepping g = {.session = session,
                         .options = options,
                         .sink = sink,
                         .first = only > 0 ? only - 1 : 0,
                         .end = only > 0 ? only : n_all};
    enum dalcs_status status = run_all_steps(&g);
    make_report(&g);
    session->results.report.work = g.sum.work;
    const enum dalcs_status told = report_measured(&g.measured, session);
    const enum dalcs_status listed = dalcs_failed_steps_report(&g.failed, session, g.end - g.first);
    status = status != DALCS_OK ? status : g.failed.first;
    dalcs_failed_steps_finish(&g.failed);
    status = status != DALCS_OK ? status : told;
    return status != DALCS_OK ? status : listed;
}

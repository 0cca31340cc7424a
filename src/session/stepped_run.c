/* stepped_run.c - .step: the analyses with each value, and what was measured in all of them. */
#include "pipeline.h"

#include <stdlib.h>

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

/* "r = 500, c = 1e-06" */
static const char *step_text(struct dalcs_session *s, const struct dalcs_plot *step) {
    const char *values = "";
    for (size_t k = 0; k < step->n_parameters && values != NULL; k++) {
        values = dalcs_arena_printf(&s->arena, "%s%s%s = %.9g", values, k > 0 ? ", " : "",
                                    step->parameter[k], step->parameter_value[k]);
    }
    return values;
}

/* Names the step that failed, and says how to come to those behind it. */
static void blame_step(struct dalcs_session *s, const struct dalcs_plot *step, size_t k,
                       bool has_more) {
    const char *values = step_text(s, step);
    dalcs_diag_add(&s->diag, DALCS_NOTE, NULL,
                   has_more ? "those behind it are not run; -o none --measures FILE.csv makes a "
                              "table of all, and so does dalcs.variants in Python"
                            : NULL,
                   "this was step %zu of %zu: %s", k + 1, dalcs_steps_count(s),
                   values != NULL ? values : "");
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
    const struct dalcs_report *one = &s->report;
    if (one->n_measurements + one->n_fourier + one->n_losses == 0) {
        return DALCS_OK;
    }
    const char *text = step_text(s, step);
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
    s->report.measurement = m;
    s->report.n_measurements = status == DALCS_OK ? all->n : 0;
    s->report.fourier = f;
    s->report.n_fourier = status == DALCS_OK ? all->n_fourier : 0;
    s->report.losses = l;
    s->report.n_losses = status == DALCS_OK ? all->n_losses : 0;
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
    const bool asked[] = {[DALCS_OPERATING_POINT] = circuit->operating_point,
                          [DALCS_TRANSIENT] = circuit->transient.present,
                          [DALCS_DC_SWEEP] = circuit->n_dc > 0,
                          [DALCS_AC] = circuit->ac.n > 0,
                          [DALCS_PERIODIC] = circuit->periodic.present};
    return asked[analysis];
}

enum dalcs_status dalcs_stepped_run(struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const struct dalcs_sink *sink) {
    struct dalcs_report sum = {0};
    struct measured measured = {0};
    const size_t n_all = dalcs_steps_count(session);
    const size_t only = options->only_step;
    if (only > n_all) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, NULL,
                       "there are %zu steps, and no step %zu", n_all, only);
        return DALCS_E_OPTION;
    }
    dalcs_steady_anchor_enter(session, options);
    const size_t first = only > 0 ? only - 1 : 0;
    const size_t end = only > 0 ? only : n_all;
    bool asked[DALCS_N_IN_ORDER];
    for (size_t a = 0; a < DALCS_N_IN_ORDER; a++) {
        asked[a] = is_asked(&session->circuit, options, dalcs_analyses_in_order[a]);
    }
    enum dalcs_status status = DALCS_OK;
    for (size_t a = 0; a < DALCS_N_IN_ORDER && status == DALCS_OK; a++) {
        for (size_t k = first; asked[a] && k < end && status == DALCS_OK; k++) {
            struct dalcs_plot step = {0};
            status =
                dalcs_steady_anchor_prepare(session, options, sink, dalcs_analyses_in_order[a], k);
            if (status == DALCS_OK) {
                status = dalcs_session_take_step(session, k, &step);
            }
            if (only > 0) {
                step.step = 0;
                step.n_steps = 1; /* what follows is of one run */
            }
            if (status == DALCS_OK) {
                status = dalcs_operating_currents(session, options, sink);
            }
            if (status == DALCS_OK) {
                status = dalcs_run_analyses(session, options, sink, &step,
                                            &dalcs_analyses_in_order[a], 1);
                add_work(&sum, &session->report);
                const enum dalcs_status kept = collect_measured(&measured, session, &step);
                status = status == DALCS_OK ? kept : status;
            }
            if (status > DALCS_OK || status == DALCS_E_NETLIST) {
                blame_step(session, &step, k, k + 1 < end);
            }
        }
    }
    session->report.work = sum.work;
    const enum dalcs_status told = report_measured(&measured, session);
    return status == DALCS_OK ? told : status;
}

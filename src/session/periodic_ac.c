/* periodic_ac.c - .ac behind .pss: small sinusoids around the periodic orbit. */
#include "steady.h"

#include "measures.h"
#include "periodic_response.h"
#include "radau.h"

#include <math.h>
#include <stdlib.h>

static const double two_pi = 6.28318530717958647692;

/* The orbit is known to rounding whatever the tolerance; where events move with what is on both sides of them, this
 * says how well that is. */
static const double tolerance_of_log = 1e-10;

struct part {
    struct dalcs_periodic_flow flow;
    struct dalcs_periodic_response response;
    double complex *source; /* [n_inputs] */
    double *y[2], *s[2];    /* [n_columns], [n_inputs] re and im */
};

struct periodic_ac {
    struct dalcs_steady *st;
    struct dalcs_run *run;
    struct dalcs_euler euler;
    struct dalcs_radau radau;
    struct dalcs_orbit_log log;
    int n_parts;
    struct part *part;
    double *row; /* [2 n_outputs] */
    struct dalcs_measures measures;
    struct dalcs_arena arena;
};

/* ---- One frequency ------------------------------------------------------------------------------- */

static double probe(const struct periodic_ac *a, const struct dalcs_probe *probe, int which) {
    if (probe->system < 0) {
        return 0.0;
    }
    const struct part *part = &a->part[probe->system];
    return dalcs_probe_value(probe, part->y[which], part->s[which]);
}

static enum dalcs_status refuse_frequency(const struct periodic_ac *a, double frequency) {
    struct dalcs_run *r = a->run;
    dalcs_diag_add(
        &r->s->diag, DALCS_ERROR, &r->s->circuit.ac.where,
        "a quantity that nothing changes, as the charge of a floating node, has a Floquet "
        "multiplier of 1: give it a way out, or begin at another frequency",
        "at %.9g Hz there is no single answer", frequency);
    return DALCS_SINGULAR;
}

static enum dalcs_status solve_frequency(struct periodic_ac *a, double frequency) {
    const struct dalcs_network *network = &a->run->s->network;
    for (int k = 0; k < a->n_parts; k++) {
        struct part *p = &a->part[k];
        const enum dalcs_status status =
            dalcs_periodic_response_at(&p->response, two_pi * frequency, 0);
        if (status == DALCS_SINGULAR) {
            return refuse_frequency(a, frequency);
        }
        DALCS_TRY(status);
        for (int m = 0; m < p->response.n_read; m++) {
            const int column = p->response.read[m];
            p->y[0][column] = creal(p->response.y[column]);
            p->y[1][column] = cimag(p->response.y[column]);
        }
    }
    for (int i = 0; i < network->n_outputs; i++) {
        const struct dalcs_output *out = &network->output[i];
        for (int which = 0; which < 2; which++) {
            a->row[2 * i + which] = probe(a, &out->plus, which) - probe(a, &out->minus, which);
        }
    }
    return DALCS_OK;
}

/* ---- All of them --------------------------------------------------------------------------------- */

static enum dalcs_status walk(struct periodic_ac *a) {
    struct dalcs_run *r = a->run;
    const struct dalcs_sweep *f = &r->s->circuit.ac;
    DALCS_TRY(dalcs_run_announce(r, &(struct dalcs_plot){.analysis = DALCS_AC,
                                                         .scale = "frequency",
                                                         .scale_unit = DALCS_UNIT_HERTZ,
                                                         .n_signals = (size_t)r->s->circuit.n_shown,
                                                         .name = r->name,
                                                         .unit = r->unit,
                                                         .is_complex = true}));
    DALCS_TRY(dalcs_measures_start_rows(&a->measures, r, DALCS_MEASURED_AC, dalcs_sweep_value(f, 0),
                                        dalcs_sweep_value(f, f->n - 1)));
    for (int k = 0; k < f->n; k++) {
        const double frequency = dalcs_sweep_value(f, k);
        DALCS_TRY(solve_frequency(a, frequency));
        dalcs_measures_complex_row(&a->measures, frequency, a->row);
        DALCS_TRY(r->sink->row(r->sink->user, frequency, a->row));
        DALCS_TRY(r->sink->progress(r->sink->user, k + 1, f->n));
    }
    DALCS_TRY(dalcs_measures_report(&a->measures, r, DALCS_OK));
    return r->sink->end(r->sink->user);
}

/* ---- Set up -------------------------------------------------------------------------------------- */

/* Columns of a system that outputs read. */
static void mark_read(const struct dalcs_network *network, int system, bool *is_read) {
    for (int i = 0; i < network->n_outputs; i++) {
        const struct dalcs_probe *probe[2] = {&network->output[i].plus, &network->output[i].minus};
        for (int k = 0; k < 2; k++) {
            for (int m = 0; probe[k]->system == system && m < probe[k]->n_terms; m++) {
                is_read[probe[k]->term[m].index] = true;
            }
        }
    }
}

static double fastest_of(const struct dalcs_sweep *f) {
    double fastest = 0.0;
    for (int k = 0; k < f->n; k++) {
        fastest = fmax(fastest, dalcs_sweep_value(f, k));
    }
    return two_pi * fastest;
}

static enum dalcs_status part_setup(struct periodic_ac *a, int k, double fastest) {
    struct part *p = &a->part[k];
    const struct dalcs_system *s = &a->run->s->network.system[k];
    const struct dalcs_circuit *circuit = &a->run->s->circuit;
    const size_t n_columns = (size_t)dalcs_system_n_columns(s);
    const size_t n_inputs = (size_t)s->n_inputs;
    bool *is_read = dalcs_arena_alloc(&a->arena, n_columns, sizeof(bool));
    p->source = dalcs_arena_alloc(&a->arena, n_inputs, sizeof *p->source);
    bool complete = is_read != NULL && p->source != NULL;
    for (int which = 0; which < 2; which++) {
        p->y[which] = dalcs_arena_alloc(&a->arena, n_columns, sizeof(double));
        p->s[which] = dalcs_arena_alloc(&a->arena, n_inputs, sizeof(double));
        complete = complete && p->y[which] != NULL && p->s[which] != NULL;
    }
    if (!complete) {
        return DALCS_E_NOMEM;
    }
    for (int i = 1; i < s->n_inputs; i++) {
        const struct dalcs_stimulus *of = &circuit->stimulus[s->stimulus[i]];
        p->s[0][i] = of->ac_real;
        p->s[1][i] = of->ac_imaginary;
        p->source[i] = of->ac_real + I * of->ac_imaginary;
    }
    mark_read(&a->run->s->network, k, is_read);
    DALCS_TRY(
        dalcs_periodic_flow_setup(&p->flow, &a->log.part[k], p->source, fastest, a->st->period));
    return dalcs_periodic_response_setup(&p->response, &p->flow, is_read);
}

static enum dalcs_status setup(struct periodic_ac *a) {
    const double fastest = fastest_of(&a->run->s->circuit.ac);
    a->part = dalcs_arena_alloc(&a->arena, (size_t)a->log.n_parts, sizeof *a->part);
    a->row = dalcs_arena_alloc(&a->arena, 2 * (size_t)a->run->s->network.n_outputs, sizeof(double));
    if (a->part == NULL || a->row == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < a->log.n_parts; k++) {
        a->n_parts = k + 1;
        DALCS_TRY(part_setup(a, k, fastest));
    }
    return DALCS_OK;
}

static enum dalcs_status look_around(struct periodic_ac *a) {
    struct dalcs_run *r = a->run;
    struct dalcs_radau_options options = dalcs_transient_options(r, a->st->period);
    options.tolerance = fmin(options.tolerance, tolerance_of_log);
    DALCS_TRY(dalcs_radau_setup(&a->radau, &a->euler, &options, &r->osnsp));
    DALCS_TRY(dalcs_orbit_log_setup(&a->log, &a->radau));
    DALCS_TRY(dalcs_explain_failure(r, &a->euler,
                                    dalcs_steady_log(a->st, &a->euler, &a->radau, &a->log)));
    DALCS_TRY(setup(a));
    return walk(a);
}

enum dalcs_status dalcs_periodic_ac_walk(struct dalcs_steady *st) {
    struct dalcs_run *r = st->run;
    struct periodic_ac a = {.st = st, .run = r};
    DALCS_TRY(
        dalcs_euler_setup(&a.euler, &r->s->circuit, &r->s->network, &r->osnsp, r->h, st->period));
    enum dalcs_status status = look_around(&a);
    for (int k = 0; k < a.n_parts; k++) {
        dalcs_periodic_response_finish(&a.part[k].response);
        dalcs_periodic_flow_finish(&a.part[k].flow);
    }
    dalcs_measures_finish(&a.measures);
    dalcs_orbit_log_finish(&a.log);
    dalcs_radau_finish(&a.radau);
    dalcs_euler_finish(&a.euler);
    dalcs_arena_finish(&a.arena);
    return status;
}

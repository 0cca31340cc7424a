/* dc_sweep.c - .dc: operating points, one after the other.
 *
 * Where sources alone are swept, one engine goes through all points: only its inputs change, and each
 * point starts in the mode of the one before. For anything else the circuit is built again at each
 * point, and the mode is handed on where the pairs are the same. */
#include "audit_points.h"
#include "gates.h"
#include "idle_sources.h"
#include "kept_modes.h"
#include "measures.h"

#include "congruential.h"
#include "quantity.h"

#include <stdlib.h>
#include <string.h>

enum {
    PROGRESS_POINTS = 64, /* operating points between calls of the sink's progress */
    AUDITED_POINTS = 64,  /* the first of them, all of which are audited */
    POINTS_TO_AUDIT =
        1024, /* of which one is drawn behind those: a look takes what 30 points take of one engine */
};

struct sweep {
    struct dalcs_run *run;
    const struct dalcs_sweep *dc; /* [n_dc] */
    int n_dc;
    long n, k;                   /* points, the present one */
    double value[DALCS_MOST_DC]; /* at the present point */
    double *row;                 /* [n_dc - 1 + n_outputs] */
    size_t n_outputs, n_shown;
    struct dalcs_measures measures;
    struct dalcs_idle_sources idle;
    long pivots;                   /* of the engine, up to the point before */
    uint64_t seed;                 /* of what is drawn */
    struct dalcs_kept_modes modes; /* of the last point, where a network is built again */
};

static enum dalcs_unit unit_of(const struct dalcs_circuit *circuit,
                               const struct dalcs_sweep *sweep) {
    switch (sweep->device < 0 ? '?' : circuit->device[sweep->device].letter) {
    case 'v':
        return DALCS_VOLT;
    case 'i':
        return DALCS_AMPERE;
    case 'r':
        return DALCS_UNIT_OHM;
    default:
        return DALCS_UNIT_NONE;
    }
}

static enum dalcs_status begin_plot(const struct sweep *s) {
    struct dalcs_session *session = s->run->s;
    const size_t n_outer = (size_t)s->n_dc - 1;
    const size_t n = n_outer + s->n_shown;
    const char **name = dalcs_arena_alloc(&session->arena, n, sizeof *name);
    enum dalcs_unit *unit = dalcs_arena_alloc(&session->arena, n, sizeof *unit);
    const char *scale = dalcs_arena_copy(&session->arena, s->dc[0].label, strlen(s->dc[0].label));
    if (name == NULL || unit == NULL || scale == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < n_outer; i++) {
        const char *label = s->dc[i + 1].label;
        name[i] = dalcs_arena_copy(&session->arena, label, strlen(label));
        unit[i] = unit_of(&session->circuit, &s->dc[i + 1]);
        if (name[i] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    memcpy(name + n_outer, s->run->signals.name, s->n_shown * sizeof *name);
    memcpy(unit + n_outer, s->run->signals.unit, s->n_shown * sizeof *unit);
    return dalcs_run_announce(s->run,
                              &(struct dalcs_plot){.analysis = DALCS_DC_SWEEP,
                                                   .scale = scale,
                                                   .scale_unit = unit_of(&session->circuit, s->dc),
                                                   .n_signals = n,
                                                   .name = name,
                                                   .unit = unit});
}

static void take_point(struct sweep *s, long k) {
    s->k = k;
    for (int i = 0; i < s->n_dc; i++) {
        s->value[i] = dalcs_sweep_value(&s->dc[i], (int)(k % s->dc[i].n));
        k /= s->dc[i].n;
    }
}

/* After a failure: at which point. */
static void blame_point(const struct sweep *s) {
    char text[DALCS_MOST_DC][DALCS_QUANTITY_SIZE];
    const bool is_nested = s->n_dc > 1;
    for (int i = 0; i < s->n_dc; i++) {
        (void)dalcs_quantity_write(text[i], s->value[i], "", 9);
    }
    dalcs_diag_add(&s->run->s->diag, DALCS_NOTE, NULL, NULL, "this was .dc at %s = %s%s%s%s%s",
                   s->dc[0].label, text[0], is_nested ? ", " : "", is_nested ? s->dc[1].label : "",
                   is_nested ? " = " : "", is_nested ? text[1] : "");
}

/* The first points, the last one, those where the mode changes, and others that are drawn. */
static bool is_audited(struct sweep *s, const struct dalcs_euler *e) {
    long pivots = 0;
    for (int i = 0; i < e->n_components; i++) {
        pivots += e->component[i].osnsp.counters.pivots;
    }
    const bool has_changed = pivots != s->pivots;
    s->pivots = pivots;
    const bool is_drawn = (dalcs_congruential_next(&s->seed) >> 33) % POINTS_TO_AUDIT == 0;
    return has_changed || s->run->options->audit == DALCS_AUDIT_FULL || s->k < AUDITED_POINTS ||
           s->k + 1 == s->n || is_drawn;
}

/* The operating point of e, as a row. */
static enum dalcs_status solve_point(struct sweep *s, struct dalcs_euler *e,
                                     struct dalcs_logic_run *logic,
                                     const struct dalcs_circuit *circuit,
                                     const struct dalcs_network *network) {
    struct dalcs_run *r = s->run;
    const size_t n_outer = (size_t)s->n_dc - 1;
    enum dalcs_status status = dalcs_gates_operating_point(e, logic, false);
    if (status != DALCS_OK) {
        status = dalcs_explain_failure(r, e, status);
        if (status > DALCS_OK) {
            blame_point(s);
        }
        return status;
    }
    memcpy(s->row, s->value + 1, n_outer * sizeof(double));
    dalcs_recorder_evaluate(network, e, s->row + n_outer);
    dalcs_measures_row(&s->measures, s->value[0], s->row + n_outer);
    DALCS_TRY(r->sink->row(r->sink->user, s->value[0], s->row));
    if (is_audited(s, e)) {
        const struct dalcs_solved_point point = {circuit, network,          e,
                                                 logic,   s->row + n_outer, s->k > 0};
        status = dalcs_audit_point(r, &point);
        if (status == DALCS_REFUTED) {
            blame_point(s);
        }
        DALCS_TRY(status);
    }
    if ((s->k + 1) % PROGRESS_POINTS == 0) {
        DALCS_TRY(dalcs_run_progress(r, (double)(s->k + 1), (double)s->n));
    }
    return DALCS_OK;
}

/* ---- Sources alone --------------------------------------------------------------------------- */

static bool are_sources(const struct dalcs_circuit *circuit) {
    bool all = true;
    for (int i = 0; i < circuit->analyses.n_dc; i++) {
        const int device = circuit->analyses.dc[i].device;
        all = all && device >= 0 && circuit->device[device].stimulus >= 0;
    }
    return all;
}

static struct dalcs_stimulus *stimulus_of(struct dalcs_circuit *circuit,
                                          const struct dalcs_sweep *sweep) {
    return sweep->device < 0 ? NULL : &circuit->stimulus[circuit->device[sweep->device].stimulus];
}

/* A network of the circuit with the values of this point, and an engine that begins in the mode before. */
static enum dalcs_status solve_network(struct sweep *s, struct dalcs_circuit *circuit,
                                       const struct dalcs_network *network) {
    struct dalcs_euler e;
    DALCS_TRY(dalcs_euler_setup(&e, circuit, network, &s->run->osnsp, 1.0, 1.0));
    struct dalcs_logic_run logic;
    dalcs_kept_modes_hand_on(&s->modes, &e);
    enum dalcs_status status = dalcs_logic_run_setup(&logic, circuit, &e, NULL);
    status = status == DALCS_OK ? solve_point(s, &e, &logic, circuit, network) : status;
    dalcs_logic_run_finish(&logic);
    if (status == DALCS_OK) {
        status = dalcs_kept_modes_take(&s->modes, &e);
    }
    dalcs_run_add_work(s->run, &e);
    dalcs_euler_finish(&e);
    return status;
}

/* Sources that agree in a loop elsewhere do not agree at this point, or the other way round. */
static enum dalcs_status solve_on_its_own(struct sweep *s) {
    struct dalcs_session *session = s->run->s;
    const struct dalcs_network_options options = {.silent = true, .with_readout = true};
    struct dalcs_network network;
    DALCS_TRY(dalcs_network_build(&network, &session->circuit, &options, &session->diag));
    const enum dalcs_status status = solve_network(s, &session->circuit, &network);
    dalcs_network_finish(&network);
    return status;
}

static enum dalcs_status walk(struct sweep *s, struct dalcs_euler *e,
                              struct dalcs_logic_run *logic) {
    struct dalcs_session *session = s->run->s;
    for (long k = 0; k < s->n; k++) {
        take_point(s, k);
        for (int i = 0; i < s->n_dc; i++) {
            struct dalcs_stimulus *source = stimulus_of(&session->circuit, &s->dc[i]);
            if (source != NULL) {
                source->dc = s->value[i];
                source->has_dc = true;
            }
        }
        bool differ;
        DALCS_TRY(dalcs_idle_sources_compare(&s->idle, &session->circuit, &differ));
        DALCS_TRY(differ ? solve_on_its_own(s)
                         : solve_point(s, e, logic, &session->circuit, &session->network));
    }
    return DALCS_OK;
}

static enum dalcs_status run_sources(struct sweep *s) {
    struct dalcs_run *r = s->run;
    struct dalcs_circuit *circuit = &r->s->circuit;
    struct dalcs_stimulus before[DALCS_MOST_DC];
    struct dalcs_euler e;
    DALCS_TRY(dalcs_euler_setup(&e, circuit, &r->s->network, &r->osnsp, 1.0, 1.0));
    e.listener.open_user = &r->nonunique.undetermined;
    e.listener.on_open = dalcs_undetermined_at;
    for (int i = 0; i < s->n_dc; i++) {
        const struct dalcs_stimulus *source = stimulus_of(circuit, &s->dc[i]);
        before[i] = source != NULL ? *source : (struct dalcs_stimulus){0};
    }
    struct dalcs_logic_run logic;
    enum dalcs_status status = dalcs_logic_run_setup(&logic, circuit, &e, NULL);
    if (status == DALCS_OK) {
        status = dalcs_idle_sources_find(&s->idle, circuit);
    }
    if (status == DALCS_OK) {
        status = walk(s, &e, &logic);
        dalcs_warn_of_restless_gates(r, &logic);
    }
    dalcs_logic_run_finish(&logic);
    dalcs_idle_sources_finish(&s->idle);
    for (int i = 0; i < s->n_dc; i++) {
        struct dalcs_stimulus *source = stimulus_of(circuit, &s->dc[i]);
        if (source != NULL) {
            *source = before[i];
        }
    }
    dalcs_run_add_work(r, &e);
    dalcs_euler_finish(&e);
    return status;
}

/* ---- Anything -------------------------------------------------------------------------------- */

static enum dalcs_status run_point(struct sweep *s) {
    struct dalcs_run *r = s->run;
    struct dalcs_override override[DALCS_MOST_DC];
    size_t n_overrides = 0;
    struct dalcs_circuit circuit;
    struct dalcs_network network;
    for (int i = 0; i < s->n_dc; i++) {
        n_overrides += dalcs_override_of(&s->dc[i], s->value[i], &override[n_overrides]) ? 1 : 0;
    }
    enum dalcs_status status = dalcs_session_build(r->s, override, n_overrides, &circuit, &network);
    if (status == DALCS_E_NETLIST) {
        blame_point(s);
    }
    DALCS_TRY(status);
    if ((size_t)network.n_outputs != s->n_outputs) {
        dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL, "sweep it with .step",
                       "this .dc changes which elements and nodes there are");
        blame_point(s);
        status = DALCS_E_NETLIST;
    } else {
        status = dalcs_operating_currents_keep(&circuit, &network, &r->s->circuit, &r->s->diag);
        status = status == DALCS_OK ? solve_network(s, &circuit, &network) : status;
    }
    dalcs_network_finish(&network);
    dalcs_circuit_finish(&circuit);
    return status;
}

static enum dalcs_status run_circuits(struct sweep *s) {
    enum dalcs_status status = DALCS_OK;
    for (long k = 0; k < s->n && status == DALCS_OK; k++) {
        take_point(s, k);
        status = run_point(s);
    }
    return status;
}

/* Over the scale, which has to rise. */
static enum dalcs_status start_measures(struct sweep *s) {
    const struct dalcs_sweep *scale = &s->dc[0];
    const double first = dalcs_sweep_value(scale, 0);
    const double last = dalcs_sweep_value(scale, scale->n - 1);
    if (s->n_dc == 1 && first <= last) {
        return dalcs_measures_start_rows(&s->measures, s->run, DALCS_MEASURED_DC, first, last);
    }
    if (dalcs_measuring_is_wanted(&s->run->s->circuit, DALCS_MEASURED_DC)) {
        dalcs_diag_add(&s->run->s->diag, DALCS_WARNING, NULL, NULL,
                       "nothing is measured in a .dc that is nested or falls");
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_dc_sweep_run(struct dalcs_run *r) {
    const struct dalcs_circuit *circuit = &r->s->circuit;
    struct sweep s = {.run = r,
                      .dc = circuit->analyses.dc,
                      .n_dc = circuit->analyses.n_dc,
                      .n = 1,
                      .n_outputs = (size_t)r->s->network.n_outputs,
                      .n_shown = (size_t)circuit->results.n_shown};
    for (int i = 0; i < s.n_dc; i++) {
        s.n *= s.dc[i].n;
    }
    DALCS_TRY(begin_plot(&s));
    s.row = dalcs_alloc((size_t)s.n_dc - 1 + s.n_outputs, sizeof *s.row);
    if (s.row == NULL) {
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status = start_measures(&s);
    if (status == DALCS_OK) {
        status = are_sources(circuit) ? run_sources(&s) : run_circuits(&s);
    }
    if (status == DALCS_OK) {
        status = dalcs_measures_report(&s.measures, r, DALCS_OK);
    }
    dalcs_measures_finish(&s.measures);
    dalcs_kept_modes_finish(&s.modes);
    free(s.row);
    return status == DALCS_OK ? r->sink->end(r->sink->user) : status;
}

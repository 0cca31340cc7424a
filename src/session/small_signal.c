/* small_signal.c - .ac: small sinusoids around an operating point.
 *
 * The operating point says on which side each diode and switch stands, and there it stays. What is
 * left of (2.1) is linear, so amplitudes obey
 *     (j omega P_I - A_I) y = E_I s,   -A_II y = E_II s,   C y = -F s where w = 0, else lambda = 0
 * with the AC values of the sources as s: one sparse complex system for each frequency. */
#include "audit_response.h"
#include "gates.h"
#include "measures.h"
#include "pi.h"
#include "smooth_newton.h"

#include "lu.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NAMED = 12 };

/* One system's matrix by columns: re + j omega im, and what drives it. */
struct part {
    const struct dalcs_component *component;
    int n;                            /* rows and columns */
    int *p, *i;                       /* [n + 1], [p[n]] */
    double *re;                       /* [p[n]] */
    double *im;                       /* [p[n]] of 1/omega */
    double *x;                        /* [2 p[n]] scaled, at the present frequency */
    double *row_scale, *column_scale; /* [n] powers of 2 */
    double *right;                    /* [2 n] */
    double *residual;                 /* [2 n] */
    double *y[2];                     /* [n] re and im of the answer */
    double *s[2];                     /* [n_inputs] re and im of the sources */
    klu_common common;
    klu_symbolic *symbolic;
};

struct small_signal {
    struct dalcs_run *run;
    struct part *part; /* [n_parts] */
    int n_parts;
    double *row; /* [2 n_outputs] */
    struct dalcs_measures measures;
    struct dalcs_response_columns *columns; /* [n_parts] for the audit */
    struct dalcs_audit_response audit;
};

/* ---- The matrix -------------------------------------------------------------------------------- */

struct entry {
    int row, column;
    double re, im;
};

static int compare_entries(const void *a, const void *b) {
    const struct entry *x = a;
    const struct entry *y = b;
    return x->column != y->column ? (x->column < y->column ? -1 : 1)
                                  : (x->row > y->row) - (x->row < y->row);
}

/* All entries, unordered; returns how many. */
static int list_entries(const struct dalcs_component *c, struct entry *entry) {
    const struct dalcs_system *s = c->system;
    const int n_equations = dalcs_system_n_equations(s);
    int n = 0;
    for (int i = 0; i < s->n_x; i++) {
        for (int k = s->P.p[i]; k < s->P.p[i + 1]; k++) {
            entry[n++] = (struct entry){i, s->P.j[k], 0.0, s->P.x[k]};
        }
    }
    for (int i = 0; i < n_equations; i++) {
        for (int k = s->A.p[i]; k < s->A.p[i + 1]; k++) {
            entry[n++] = (struct entry){i, s->A.j[k], -s->A.x[k], 0.0};
        }
    }
    for (int k = 0; k < s->n_smooth; k++) { /* by their tangents at the operating point */
        const struct dalcs_smooth_input *of = &s->smooth[k];
        double gradient[2];
        dalcs_smooth_gradient(of->kind, c->osnsp.smooth.newton->x[k], gradient);
        for (int j = 0; j < of->n; j++) {
            if (of->column[j] >= 0) {
                const double line = of->entry[j] != NULL ? -*of->entry[j] : 0.0; /* that A has */
                entry[n++] = (struct entry){of->row, of->column[j], gradient[j] - line, 0.0};
            }
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        if (!dalcs_osnsp_is_on(&c->osnsp, d)) {
            entry[n++] = (struct entry){n_equations + d, n_equations + d, 1.0, 0.0};
            continue;
        }
        for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
            entry[n++] = (struct entry){n_equations + d, s->C.j[k], s->C.x[k], 0.0};
        }
    }
    return n;
}

static enum dalcs_status compress(struct part *part) {
    const struct dalcs_system *s = part->component->system;
    const size_t most = (size_t)(s->n_x > 0 ? s->P.p[s->n_x] : 0) +
                        (size_t)s->A.p[dalcs_system_n_equations(s)] + (size_t)s->C.p[s->n_pairs] +
                        (size_t)s->n_pairs + 2 * (size_t)s->n_smooth;
    struct entry *entry = dalcs_alloc(most, sizeof *entry);
    part->p = dalcs_alloc((size_t)part->n + 1, sizeof(int));
    part->i = dalcs_alloc(most, sizeof(int));
    part->re = dalcs_alloc(most, sizeof(double));
    part->im = dalcs_alloc(most, sizeof(double));
    part->x = dalcs_alloc(2 * most, sizeof(double));
    if (entry == NULL || part->p == NULL || part->i == NULL || part->re == NULL ||
        part->im == NULL || part->x == NULL) {
        free(entry);
        return DALCS_E_NOMEM;
    }
    const int n = list_entries(part->component, entry);
    qsort(entry, (size_t)n, sizeof *entry, compare_entries);
    int kept = 0;
    for (int k = 0; k < n; k++) {
        const bool repeats =
            k > 0 && entry[k].row == entry[k - 1].row && entry[k].column == entry[k - 1].column;
        if (!repeats) {
            part->i[kept++] = entry[k].row;
            part->p[entry[k].column + 1] = kept;
        }
        part->re[kept - 1] += entry[k].re;
        part->im[kept - 1] += entry[k].im;
    }
    for (int j = 0; j < part->n; j++) {
        part->p[j + 1] = part->p[j + 1] > part->p[j] ? part->p[j + 1] : part->p[j];
    }
    free(entry);
    return DALCS_OK;
}

static void part_finish(struct part *part) {
    if (part->symbolic != NULL) {
        klu_free_symbolic(&part->symbolic, &part->common);
    }
    free(part->p);
    free(part->i);
    free(part->re);
    free(part->im);
    free(part->x);
    free(part->row_scale);
    free(part->column_scale);
    free(part->right);
    free(part->residual);
    for (int k = 0; k < 2; k++) {
        free(part->y[k]);
        free(part->s[k]);
    }
}

static enum dalcs_status part_setup(struct part *part, const struct dalcs_component *c) {
    const struct dalcs_system *s = c->system;
    const size_t n = (size_t)dalcs_system_n_columns(s);
    *part = (struct part){.component = c, .n = (int)n};
    dalcs_lu_common_init(&part->common);
    part->row_scale = dalcs_alloc(n, sizeof(double));
    part->column_scale = dalcs_alloc(n, sizeof(double));
    part->right = dalcs_alloc(2 * n, sizeof(double));
    part->residual = dalcs_alloc(2 * n, sizeof(double));
    bool complete = part->row_scale != NULL && part->column_scale != NULL && part->right != NULL &&
                    part->residual != NULL;
    for (int k = 0; k < 2; k++) {
        part->y[k] = dalcs_alloc(n, sizeof(double));
        part->s[k] = dalcs_alloc((size_t)s->n_inputs, sizeof(double));
        complete = complete && part->y[k] != NULL && part->s[k] != NULL;
    }
    if (!complete) {
        return DALCS_E_NOMEM;
    }
    for (int k = 1; k < s->n_inputs; k++) {
        const struct dalcs_stimulus *source = &c->circuit->stimulus[s->stimulus[k]];
        part->s[0][k] = source->ac_real;
        part->s[1][k] = source->ac_imaginary;
    }
    const int n_equations = dalcs_system_n_equations(s);
    for (int i = 0; i < n_equations; i++) {
        part->right[2 * i] = dalcs_csr_row_dot(&s->E, i, part->s[0]);
        part->right[2 * i + 1] = dalcs_csr_row_dot(&s->E, i, part->s[1]);
    }
    for (int d = 0; d < s->n_pairs; d++) {
        if (dalcs_osnsp_is_on(&c->osnsp, d)) {
            part->right[2 * (n_equations + d)] = -dalcs_csr_row_dot(&s->F, d, part->s[0]);
            part->right[2 * (n_equations + d) + 1] = -dalcs_csr_row_dot(&s->F, d, part->s[1]);
        }
    }
    DALCS_TRY(compress(part));
    /* what is shorted has no unknowns, and KLU takes no matrix without rows */
    return part->n == 0 ? DALCS_OK
                        : dalcs_lu_analyze(
                              &part->symbolic, &part->common,
                              &(struct dalcs_columns){.n = part->n, .p = part->p, .i = part->i});
}

/* ---- One frequency ------------------------------------------------------------------------------ */

static double power_of_two_below(double x) {
    return x > 0.0 && isfinite(x) ? ldexp(1.0, -ilogb(x)) : 1.0;
}

/* Fills part->x, rows and columns scaled. */
static void balance(struct part *part, double omega) {
    for (int i = 0; i < part->n; i++) {
        part->row_scale[i] = 0.0;
    }
    for (int k = 0; k < part->p[part->n]; k++) {
        const double size = fabs(part->re[k]) + omega * fabs(part->im[k]);
        part->row_scale[part->i[k]] = fmax(part->row_scale[part->i[k]], size);
    }
    for (int i = 0; i < part->n; i++) {
        part->row_scale[i] = power_of_two_below(part->row_scale[i]);
    }
    for (int j = 0; j < part->n; j++) {
        double largest = 0.0;
        for (int k = part->p[j]; k < part->p[j + 1]; k++) {
            const double size = fabs(part->re[k]) + omega * fabs(part->im[k]);
            largest = fmax(largest, size * part->row_scale[part->i[k]]);
        }
        part->column_scale[j] = power_of_two_below(largest);
        for (int k = part->p[j]; k < part->p[j + 1]; k++) {
            const double scale = part->row_scale[part->i[k]] * part->column_scale[j];
            part->x[2 * k] = part->re[k] * scale;
            part->x[2 * k + 1] = omega * part->im[k] * scale;
        }
    }
}

/* y += the solution for the residual. */
static void correct(struct part *part, const struct dalcs_lu *lu) {
    for (int i = 0; i < part->n; i++) {
        const int from = lu->from[i];
        lu->work[2 * i] = part->residual[2 * from] * part->row_scale[from];
        lu->work[2 * i + 1] = part->residual[2 * from + 1] * part->row_scale[from];
    }
    dalcs_lu_solve_ordered_complex(lu);
    for (int i = 0; i < part->n; i++) {
        const int to = lu->to[i];
        part->y[0][to] += lu->work[2 * i] * part->column_scale[to];
        part->y[1][to] += lu->work[2 * i + 1] * part->column_scale[to];
    }
}

static void find_residual(struct part *part, double omega) {
    memcpy(part->residual, part->right, 2 * (size_t)part->n * sizeof(double));
    for (int j = 0; j < part->n; j++) {
        const double re = part->y[0][j];
        const double im = part->y[1][j];
        for (int k = part->p[j]; k < part->p[j + 1]; k++) {
            const double a = part->re[k];
            const double b = omega * part->im[k];
            part->residual[2 * part->i[k]] -= a * re - b * im;
            part->residual[2 * part->i[k] + 1] -= a * im + b * re;
        }
    }
}

static enum dalcs_status solve_part(struct part *part, double frequency, double rcond_min) {
    const double omega = dalcs_two_pi * frequency;
    struct dalcs_lu lu;
    if (part->n == 0) {
        return DALCS_OK;
    }
    balance(part, omega);
    const struct dalcs_columns a = {
        .n = part->n, .p = part->p, .i = part->i, .x = part->x, .is_complex = true};
    DALCS_TRY(dalcs_lu_factor_analyzed(&lu, &part->common, part->symbolic, NULL, &a, rcond_min));
    memset(part->y[0], 0, (size_t)part->n * sizeof(double));
    memset(part->y[1], 0, (size_t)part->n * sizeof(double));
    for (int round = 0; round < 2; round++) { /* once more, for what rounding left */
        find_residual(part, omega);
        correct(part, &lu);
    }
    dalcs_lu_finish(&lu);
    return DALCS_OK;
}

static double probe(const struct small_signal *a, const struct dalcs_probe *probe, int which) {
    if (probe->system < 0) {
        return 0.0;
    }
    const struct part *part = &a->part[probe->system];
    return dalcs_probe_value(probe, part->y[which], part->s[which]);
}

/* The k-th. */
static enum dalcs_status solve_frequency(struct small_signal *a, int k, double frequency) {
    struct dalcs_run *r = a->run;
    const struct dalcs_network *network = &r->s->network;
    for (int p = 0; p < a->n_parts; p++) {
        const enum dalcs_status status = solve_part(&a->part[p], frequency, r->osnsp.rcond_min);
        if (status == DALCS_SINGULAR) {
            dalcs_diag_add(&r->s->diag, DALCS_ERROR, &r->s->circuit.analyses.ac.where,
                           "an undamped resonance at this frequency, or a loop of conducting ideal "
                           "diodes or closed switches; a resistance in it makes it one",
                           "at %.9g Hz the response is not unique", frequency);
        }
        DALCS_TRY(status);
    }
    for (int i = 0; i < network->n_outputs; i++) {
        const struct dalcs_output *out = &network->output[i];
        for (int which = 0; which < 2; which++) {
            a->row[2 * i + which] = probe(a, &out->plus, which) - probe(a, &out->minus, which);
        }
    }
    dalcs_measures_complex_row(&a->measures, frequency, a->row);
    DALCS_TRY(r->sink->row(r->sink->user, frequency, a->row));
    return dalcs_audit_response_look(&a->audit, k, frequency, a->row);
}

/* ---- The operating point ------------------------------------------------------------------------ */

/* Names the diodes that could as well stand on the other side. */
static enum dalcs_status warn_of_degenerate(struct dalcs_run *r,
                                            const struct dalcs_side_taken *side, size_t n) {
    struct dalcs_arena *arena = &r->s->arena;
    const char *list = "";
    size_t n_found = 0;
    for (size_t k = 0; k < n; k++) {
        if (side[k].degenerate && n_found++ < MOST_NAMED) {
            list = dalcs_arena_printf(arena, "%s%s%s as %s", list, n_found > 1 ? ", " : "",
                                      side[k].element, side[k].on ? "conducting" : "blocking");
            if (list == NULL) {
                return DALCS_E_NOMEM;
            }
        }
    }
    if (n_found > 0) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, &r->s->circuit.analyses.ac.where,
                       "give them a current or a reverse voltage at the operating point",
                       "at the operating point %zu diode%s neither current nor voltage; .ac takes "
                       "%s%s",
                       n_found, n_found == 1 ? " has" : "s have", list,
                       n_found > MOST_NAMED ? ", ..." : "");
    }
    return DALCS_OK;
}

/* Which side each pair is on, into the report. */
static enum dalcs_status report_sides(struct dalcs_run *r, struct dalcs_euler *e) {
    size_t n = 0;
    for (int k = 0; k < e->n_components; k++) {
        n += (size_t)e->component[k].system->n_pairs;
    }
    struct dalcs_side_taken *side = dalcs_arena_alloc(&r->s->arena, n, sizeof *side);
    if (side == NULL) {
        return DALCS_E_NOMEM;
    }
    size_t n_sides = 0;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        double scale[2];
        dalcs_osnsp_find_ties(&c->osnsp, c->u, c->y, scale);
        for (int d = 0; d < c->system->n_pairs; d++) {
            const struct dalcs_pair *pair = &c->system->pair[d];
            const bool on = dalcs_osnsp_is_on(&c->osnsp, d);
            if (!pair->is_breakdown || on) {
                const bool is_diode = pair->kind == DALCS_PAIR_DIODE;
                side[n_sides++] = (struct dalcs_side_taken){pair->element, on,
                                                            is_diode && c->osnsp.signs.tied[d]};
            }
        }
    }
    r->s->results.report.n_sides = n_sides;
    r->s->results.report.side = side;
    return warn_of_degenerate(r, side, n_sides);
}

static enum dalcs_status find_operating_point(struct dalcs_run *r, struct dalcs_euler *e,
                                              struct dalcs_logic_run *logic) {
    e->listener.open_user = &r->nonunique.undetermined;
    e->listener.on_open = dalcs_undetermined_at;
    enum dalcs_status status = dalcs_logic_run_setup(logic, &r->s->circuit, e, NULL);
    if (status == DALCS_OK) {
        status = dalcs_gates_operating_point(e, logic, false);
        dalcs_warn_of_restless_gates(r, logic);
    }
    if (status == DALCS_OK) {
        e->failure.at_operating_point = true;
        status = dalcs_undetermined_several(&r->nonunique.undetermined, e, 0.0);
        e->failure.at_operating_point = false;
    }
    status = dalcs_explain_failure(r, e, status);
    return status == DALCS_OK ? report_sides(r, e) : status;
}

/* ---- All frequencies ---------------------------------------------------------------------------- */

static enum dalcs_status walk(struct small_signal *a) {
    struct dalcs_run *r = a->run;
    const struct dalcs_sweep *f = &r->s->circuit.analyses.ac;
    DALCS_TRY(dalcs_run_announce(
        r, &(struct dalcs_plot){.analysis = DALCS_AC,
                                .scale = "frequency",
                                .scale_unit = DALCS_UNIT_HERTZ,
                                .n_signals = (size_t)r->s->circuit.results.n_shown,
                                .name = r->signals.name,
                                .unit = r->signals.unit,
                                .is_complex = true}));
    DALCS_TRY(dalcs_measures_start_rows(&a->measures, r, DALCS_MEASURED_AC, dalcs_sweep_value(f, 0),
                                        dalcs_sweep_value(f, f->n - 1)));
    for (int k = 0; k < f->n; k++) {
        DALCS_TRY(solve_frequency(a, k, dalcs_sweep_value(f, k)));
        DALCS_TRY(dalcs_run_progress(r, k + 1, f->n));
    }
    DALCS_TRY(dalcs_measures_report(&a->measures, r, DALCS_OK));
    return r->sink->end(r->sink->user);
}

static enum dalcs_status setup(struct small_signal *a, const struct dalcs_euler *e,
                               struct dalcs_logic_run *logic) {
    struct dalcs_session *s = a->run->s;
    const struct dalcs_solved_point point = {
        .circuit = &s->circuit, .network = &s->network, .euler = e, .logic = logic};
    a->part = dalcs_alloc((size_t)e->n_components, sizeof *a->part);
    a->row = dalcs_alloc(2 * (size_t)a->run->s->network.n_outputs, sizeof *a->row);
    a->columns = dalcs_alloc((size_t)e->n_components, sizeof *a->columns);
    if (a->part == NULL || a->row == NULL || a->columns == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < e->n_components; k++) {
        a->n_parts = k + 1;
        const enum dalcs_status status = part_setup(&a->part[k], &e->component[k]);
        if (status == DALCS_SINGULAR) {
            dalcs_diag_add(&a->run->s->diag, DALCS_ERROR, &a->run->s->circuit.analyses.ac.where,
                           NULL,
                           "the circuit around its operating point has no unique response at any "
                           "frequency");
        }
        DALCS_TRY(status);
        a->columns[k] = (struct dalcs_response_columns){{a->part[k].y[0], a->part[k].y[1]}};
    }
    return dalcs_audit_response_start(&a->audit, a->run, &point, a->columns,
                                      s->circuit.analyses.ac.n);
}

enum dalcs_status dalcs_small_signal_run(struct dalcs_run *r) {
    struct small_signal a = {.run = r};
    struct dalcs_euler e;
    struct dalcs_logic_run logic; /* whose outputs the sources show as long as it is there */
    DALCS_TRY(dalcs_commanded_ac_refuse(r));
    DALCS_TRY(dalcs_euler_setup(&e, &r->s->circuit, &r->s->network, &r->osnsp, 1.0, 1.0));
    enum dalcs_status status = find_operating_point(r, &e, &logic);
    if (status == DALCS_OK) {
        status = setup(&a, &e, &logic);
    }
    if (status == DALCS_OK) {
        status = walk(&a);
    }
    for (int k = 0; k < a.n_parts; k++) {
        part_finish(&a.part[k]);
    }
    dalcs_audit_response_finish(&a.audit);
    dalcs_measures_finish(&a.measures);
    free(a.part);
    free(a.row);
    free(a.columns);
    dalcs_run_add_work(r, &e);
    dalcs_logic_run_finish(&logic);
    dalcs_euler_finish(&e);
    return status;
}

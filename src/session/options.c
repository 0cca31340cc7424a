/* options.c - what a run is told: by the run's options, else by the netlist's, else by default.
 *
 * dalcs_run_choose at the end is the table of contents. Nothing after it looks at where a choice came
 * from. */
#include "session_internal.h"

#include <math.h>
#include <string.h>

/* The grid tells times apart to a few 1e-15 of the stop time; leave room for edges between. */
static const double MOST_STEPS = 1e13;

static const double USUAL_TOLERANCE = 1e-6;

/* Of filling where nothing is said: who looks at rows looks no closer. */
static const double LEAST_FILL = 1e-6;

/* By enum dalcs_method. */
static const char *const METHODS[] = {"auto", "radau", "lobatto", "euler"};

enum { N_METHODS = sizeof METHODS / sizeof METHODS[0] };

const char *dalcs_method_name(size_t index) {
    return index < N_METHODS ? METHODS[index] : NULL;
}

static bool find_method(const char *name, enum dalcs_method *method) {
    for (int k = 0; k < N_METHODS; k++) {
        if (strcmp(METHODS[k], name) == 0) {
            *method = (enum dalcs_method)k;
            return true;
        }
    }
    return false;
}

static enum dalcs_status option_error(struct dalcs_session *s, const char *text) {
    dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, NULL, "%s", text);
    return DALCS_E_OPTION;
}

static enum dalcs_status choose_method(struct dalcs_run *r) {
    const char *given = r->options->method;
    const struct dalcs_circuit_options *netlist = &r->s->circuit.options;
    r->method = DALCS_METHOD_AUTO;
    if (given != NULL && !find_method(given, &r->method)) {
        dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL, "the methods are: auto radau lobatto euler",
                       "unknown method '%s'", given);
        return DALCS_E_OPTION;
    }
    if (given == NULL && netlist->method != NULL && !find_method(netlist->method, &r->method)) {
        dalcs_diag_add(&r->s->diag, DALCS_NOTE, &netlist->method_where, NULL,
                       "method=%s has no meaning here: using auto", netlist->method);
    }
    return DALCS_OK;
}

/* Says what a fixed step has no use for. */
static void note_unused_accuracy(struct dalcs_run *r) {
    const struct dalcs_circuit_options *netlist = &r->s->circuit.options;
    if (netlist->tolerance_where.line > 0) {
        dalcs_diag_add(&r->s->diag, DALCS_NOTE, &netlist->tolerance_where,
                       "choose the step with --step or .options step=",
                       "reltol, abstol and vntol have no effect with the fixed step of euler");
    }
    if (r->options->tolerance > 0.0 || r->options->stages > 0) {
        dalcs_diag_add(&r->s->diag, DALCS_NOTE, NULL, NULL,
                       "a tolerance and a number of stages have no effect with euler");
    }
}

double dalcs_run_tolerance(const struct dalcs_run_options *options,
                           const struct dalcs_circuit *circuit) {
    return options->tolerance > 0.0        ? options->tolerance
           : circuit->options.reltol > 0.0 ? circuit->options.reltol
                                           : USUAL_TOLERANCE;
}

static enum dalcs_status choose_accuracy(struct dalcs_run *r) {
    const struct dalcs_run_options *o = r->options;
    const struct dalcs_circuit_options *netlist = &r->s->circuit.options;
    if (o->tolerance != 0.0 &&
        !(o->tolerance >= DALCS_TOLERANCE_MIN && o->tolerance <= DALCS_TOLERANCE_MAX)) {
        dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL, NULL,
                       "the tolerance must lie between %g and %g", DALCS_TOLERANCE_MIN,
                       DALCS_TOLERANCE_MAX);
        return DALCS_E_OPTION;
    }
    if (o->stages != 0 && !DALCS_HAS_STAGES(o->stages)) {
        return option_error(r->s, "the number of stages must be 1, 3, 5, 7 or 9");
    }
    r->radau.family = r->method == DALCS_METHOD_LOBATTO ? DALCS_LOBATTO_IIIC : DALCS_RADAU_IIA;
    r->tolerance = dalcs_run_tolerance(o, &r->s->circuit);
    r->radau.abstol = netlist->abstol;
    r->radau.vntol = netlist->vntol;
    r->radau.stages = o->stages > 0 ? o->stages : netlist->stages;
    if (r->radau.stages > 0 && dalcs_collocation_of(r->radau.family, r->radau.stages) == NULL) {
        return option_error(r->s, "the number of stages of lobatto must be 3, 5, 7 or 9");
    }
    if (r->method == DALCS_METHOD_EULER) {
        note_unused_accuracy(r);
    }
    return DALCS_OK;
}

static enum dalcs_status check_output_times(struct dalcs_session *s,
                                            const struct dalcs_run_options *o) {
    const struct dalcs_transient *t = &s->circuit.analyses.transient;
    for (size_t k = 0; o->at != NULL && k < o->n_at; k++) {
        if (!(o->at[k] >= (k > 0 ? o->at[k - 1] : 0.0)) || !isfinite(o->at[k])) {
            return option_error(s, "output times must be ascending and not negative");
        }
        if (t->present && o->at[k] > t->stop) {
            return option_error(s, "output times must not come after the stop time");
        }
    }
    return DALCS_OK;
}

static enum dalcs_status choose_compression(struct dalcs_run *r) {
    const struct dalcs_run_options *o = r->options;
    const struct dalcs_circuit_options *netlist = &r->s->circuit.options;
    if (o->compress != 0.0 && !(o->compress > 0.0 && o->compress < 1.0)) {
        return option_error(r->s, "compress must be greater than 0 and less than 1");
    }
    if (o->compress > 0.0 && o->at != NULL) {
        return option_error(
            r->s, "compress leaves rows out, output times print each of theirs: choose one");
    }
    r->rows.compress = o->compress > 0.0 ? o->compress : netlist->compress;
    if (r->rows.compress > 0.0 && o->at != NULL) {
        dalcs_diag_add(&r->s->diag, DALCS_NOTE, &netlist->compress_where, NULL,
                       "compress has no effect: each output time gets its row");
        r->rows.compress = 0.0;
    }
    return DALCS_OK;
}

/* Rows of a fixed step serve orders and comparisons, which added rows would disturb. */
static enum dalcs_status choose_filling(struct dalcs_run *r) {
    const struct dalcs_run_options *o = r->options;
    const struct dalcs_circuit_options *netlist = &r->s->circuit.options;
    bool is_none = o->fill > 0.0 && isinf(o->fill);
    if (o->fill != 0.0 && !is_none && !(o->fill > 0.0 && o->fill < 1.0)) {
        return option_error(r->s, "fill must be greater than 0 and less than 1, or infinite");
    }
    bool is_given = o->fill > 0.0 || netlist->fill > 0.0;
    bool is_fixed = r->method == DALCS_METHOD_EULER || o->at != NULL;
    if (o->curve != NULL && strcmp(o->curve, "cubics") != 0 && strcmp(o->curve, "lines") != 0) {
        return option_error(r->s, "curve is cubics or lines");
    }
    r->rows.lines = o->curve != NULL ? o->curve[0] == 'l' : netlist->lines;
    r->rows.fill = o->fill > 0.0 ? o->fill : netlist->fill;
    if (is_fixed && o->fill > 0.0 && !is_none) {
        return option_error(r->s, o->at != NULL
                                      ? "fill adds rows, output times print only theirs: choose one"
                                      : "fill has no meaning with euler, whose rows are its steps");
    }
    if (is_fixed && isfinite(netlist->fill) && netlist->fill > 0.0 && o->fill == 0.0) {
        dalcs_diag_add(&r->s->diag, DALCS_NOTE, &netlist->fill_where, NULL,
                       o->at != NULL ? "fill has no effect: only the output times are printed"
                                     : "fill has no effect with euler, whose rows are its steps");
    }
    if (is_fixed || (!is_given && r->radau.fixed_step > 0.0)) {
        r->rows.fill = INFINITY;
    } else if (!is_given) {
        r->rows.fill = fmax(r->tolerance, LEAST_FILL);
    }
    return DALCS_OK;
}

static enum dalcs_status check_tolerances(struct dalcs_session *s,
                                          const struct dalcs_run_options *o) {
    bool positive = o->certificate_tolerance > 0.0 && o->max_outer > 0 && o->max_pivots > 0;
    positive = positive && o->proximal_weight > 0.0 && o->proximal_weight < 1.0;
    if (!positive || !(o->certificate_tolerance < 1.0) || !(o->rcond_min >= 0.0) ||
        !(o->rcond_min < 1.0) || o->dense_limit < 0) {
        return option_error(s, "tolerances and limits must be positive, tolerances less than 1");
    }
    return DALCS_OK;
}

/* Does the next step depend on the one before? */
static bool has_memory(const struct dalcs_network *n) {
    bool found = false;
    for (int k = 0; k < n->n_systems && !found; k++) {
        found = n->system[k].n_x > 0;
        for (int d = 0; d < n->system[k].n_pairs && !found; d++) {
            const struct dalcs_pair *p = &n->system[k].pair[d];
            found = p->kind == DALCS_PAIR_SWITCH && p->turn_on != p->turn_off;
        }
    }
    return found;
}

static enum dalcs_status choose_step(struct dalcs_run *r) {
    struct dalcs_session *s = r->s;
    const struct dalcs_transient *t = &s->circuit.analyses.transient;
    const double given = r->options->step;
    if (!(given >= 0.0) || !isfinite(given)) {
        return option_error(s, "the step must be positive");
    }
    if (!t->present) {
        return DALCS_OK;
    }
    if (given > t->stop) {
        return option_error(s, "the step is longer than the run");
    }
    const double asked = given > 0.0 ? given : s->circuit.options.step;
    if (asked > 0.0) {
        r->h = asked;
    } else if (t->max_step > 0.0 && (t->step == 0.0 || has_memory(&s->network))) {
        r->h = t->max_step;
    } else { /* without states, steps end at the printed times only */
        r->h = t->step > 0.0 ? t->step : t->stop / 1000.0;
    }
    r->radau.fixed_step =
        r->method != DALCS_METHOD_AUTO && r->method != DALCS_METHOD_EULER ? asked : 0.0;
    r->radau.max_step = asked > 0.0 ? asked : t->max_step;
    double least = r->h;
    if (r->method != DALCS_METHOD_EULER && r->radau.max_step > 0.0) {
        least = fmin(least, r->radau.max_step);
    }
    if (t->stop / least > MOST_STEPS) {
        return option_error(s,
                            "the step is too small for the stop time: times would not be distinct");
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_run_choose(struct dalcs_run *r) {
    DALCS_TRY(choose_method(r));
    r->s->results.report.method = METHODS[r->method];
    DALCS_TRY(choose_accuracy(r));
    r->s->results.report.tolerance = r->method == DALCS_METHOD_EULER ? 0.0 : r->tolerance;
    DALCS_TRY(check_output_times(r->s, r->options));
    DALCS_TRY(choose_compression(r));
    DALCS_TRY(check_tolerances(r->s, r->options));
    r->osnsp = dalcs_osnsp_options_of(r->options);
    r->osnsp.is_cancelled =
        r->s->is_cancelled_with != NULL ? r->s->is_cancelled_with : &r->s->is_cancelled;
    r->osnsp.patterns = r->s->source.steps.n > 0 ? &r->s->patterns : NULL;
    DALCS_TRY(choose_step(r));
    return choose_filling(r);
}

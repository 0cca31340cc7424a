/* explain.c - numerical failures in words: the time, the elements, what to look at. */
#include "refusal.h"

#include "refute.h"
#include "smooth_newton.h"
#include "system_file.h"

#include <errno.h>
#include <math.h>
#include <string.h>

const char *dalcs_explain_row(struct dalcs_session *s, const struct dalcs_euler *e, int system,
                              int where) {
    if (where < 0) {
        return "";
    }
    const struct dalcs_system *d = &e->network->system[system];
    int n_equations = dalcs_system_n_equations(d);
    if (where >= n_equations) {
        return dalcs_arena_printf(&s->arena, "complementarity of %s",
                                  d->pair[where - n_equations].element);
    }
    return dalcs_arena_printf(&s->arena, "%s %s", dalcs_label_equation(d->row[where].kind),
                              d->row[where].element);
}

const char dalcs_leave_initial[] =
    "give .ic another voltage there, or none: the elements named beside it hold that one";

bool dalcs_is_initial(const char *element) {
    return strncmp(element, ".ic", sizeof ".ic" - 1) == 0;
}

const struct dalcs_location *dalcs_place_of(const struct dalcs_circuit *c, const char *element) {
    for (int i = 0; i < c->n_devices; i++) {
        if (strcmp(c->device[i].name, element) == 0) {
            return &c->device[i].where;
        }
    }
    return NULL;
}

static bool contains(const char *const *list, size_t n, const char *name) {
    bool found = false;
    for (size_t k = 0; k < n && !found; k++) {
        found = strcmp(list[k], name) == 0;
    }
    return found;
}

/* A coil of an ideal transformer carries what its partners carry. */
static void add_coupled_coils(const struct dalcs_circuit *c, bool *is_named) {
    for (bool more = true; more;) {
        more = false;
        for (int k = 0; k < c->n_couplings; k++) {
            const int *coil = c->coupling[k].inductor;
            if (fabs(c->coupling[k].k) == 1.0 && is_named[coil[0]] != is_named[coil[1]]) {
                is_named[coil[0]] = is_named[coil[1]] = true;
                more = true;
            }
        }
    }
}

/* The names of a witness in the session's arena; NULL, and 0 of them, without memory. To a loop belongs
 * also devices without an equation of their own: the partners of a coil, and shorts. */
static const char **whole_witness(struct dalcs_session *s, const struct dalcs_witness *w,
                                  size_t *n_elements) {
    const struct dalcs_circuit *c = &s->circuit;
    size_t n_devices = (size_t)c->n_devices;
    size_t n = (size_t)w->n_elements;
    const char **element = dalcs_arena_alloc(&s->arena, n + n_devices, sizeof(*element));
    bool *is_named = dalcs_arena_alloc(&s->arena, n_devices, sizeof(*is_named));
    bool *is_short = dalcs_arena_alloc(&s->arena, n_devices, sizeof(*is_short));
    *n_elements = 0;
    if (element == NULL || is_named == NULL || is_short == NULL) {
        return NULL;
    }
    memcpy(element, w->element, n * sizeof(*element));
    *n_elements = n;
    if (w->kind != DALCS_WITNESS_LOOP) {
        return element;
    }
    for (size_t i = 0; i < n_devices; i++) {
        is_named[i] = contains(element, n, c->device[i].name);
    }
    add_coupled_coils(c, is_named);
    if (dalcs_loop_shorts_find(c, is_named, is_short) != DALCS_OK) {
        *n_elements = 0;
        return NULL;
    }
    for (size_t i = 0; i < n_devices; i++) {
        if (is_short[i] || (is_named[i] && !contains(element, n, c->device[i].name))) {
            element[(*n_elements)++] = c->device[i].name;
        }
    }
    return element;
}

/* The values of the sources in the problem that failed. */
static void list_values(struct dalcs_refusal *x, const struct dalcs_component *c) {
    const struct dalcs_system *d = c->system;
    for (int k = 1; k < d->n_inputs; k++) {
        x->value[d->stimulus[k]] = c->failure.u[d->n_x + k];
    }
}

/* Micro-steps this many times shorter must have no answer either. */
static const double shorter = 1024.0;

/* Is a jump of a formula in it, which circuit/commutate.c makes a switch of? What contradicts itself is one of its sides, and
 * the answer may be between them. */
static bool has_jump(const struct dalcs_witness *w) {
    bool has = false;
    for (int k = 0; k < w->n_elements && !has; k++) {
        has = dalcs_element_is_commutator(w->element[k]);
    }
    return has;
}

/* Has the problem no answer for certain? What a step sees of a circuit that is not passive is no more than that where
 * shorter ones see something else. */
static enum dalcs_status find_certainty(struct dalcs_component *c, bool is_from, bool *is_certain) {
    DALCS_TRY(dalcs_osnsp_refute(&c->osnsp, c->failure.sigma, c->failure.u, is_certain));
    bool is_mode = c->osnsp.witness.kind == DALCS_WITNESS_MODE || c->osnsp.weighed.n_elements > 0;
    if (*is_certain && is_from && is_mode && c->failure.sigma > 0.0) {
        DALCS_TRY(
            dalcs_osnsp_refute(&c->osnsp, shorter * c->failure.sigma, c->failure.u, is_certain));
    }
    *is_certain = *is_certain && !has_jump(&c->osnsp.witness);
    return DALCS_OK;
}

/* What to change: of a held voltage, of a loop with a diode, which often is the wrong way round; NULL: nothing more than
 * the sentence says. */
static const char *advice_for(const struct dalcs_refusal *x) {
    const struct dalcs_circuit *c = x->circuit;
    bool has_initial = false;
    bool has_diode = false;
    for (size_t k = 0; k < x->n_elements; k++) {
        has_initial = has_initial || dalcs_is_initial(x->element[k]);
    }
    for (int i = 0; i < c->n_devices; i++) {
        has_diode = has_diode || (x->is_named[i] && c->device[i].letter == 'd');
    }
    return has_initial ? dalcs_leave_initial
           : has_diode && x->kind == DALCS_WITNESS_LOOP
               ? "swap the nodes of a diode that should block here; to limit the current put a "
                 "resistance into the loop, an R or Ron= of a diode's model"
               : NULL;
}

static void report_infeasible(struct dalcs_session *s, const struct dalcs_refusal *x) {
    static const char *const kind[] = {[DALCS_WITNESS_LOOP] = "loop",
                                       [DALCS_WITNESS_CUTSET] = "cutset",
                                       [DALCS_WITNESS_MODE] = "mode",
                                       [DALCS_WITNESS_EQUATIONS] = "equations",
                                       [DALCS_WITNESS_DERIVATIVE] = "derivative"};
    s->results.report.infeasible.present = true;
    s->results.report.infeasible.time = x->time;
    s->results.report.infeasible.kind = kind[x->kind];
    s->results.report.infeasible.n_elements = x->n_elements;
    s->results.report.infeasible.element = x->element;
    s->results.report.infeasible.because = x->because;
}

/* DALCS_NOT_CONVERGED where it is not certain. */
static enum dalcs_status explain_infeasible(struct dalcs_run *r, const struct dalcs_euler *e,
                                            bool is_from, const char *when, const char *hint) {
    struct dalcs_session *s = r->s;
    struct dalcs_component *c = &e->component[e->failure.system];
    const struct dalcs_witness *w = &c->osnsp.witness;
    size_t n_devices = (size_t)s->circuit.n_devices;
    size_t n_stimuli = (size_t)s->circuit.n_stimuli;
    struct dalcs_refusal x = {
        .s = s,
        .circuit = &s->circuit,
        .osnsp = &c->osnsp,
        .kind = w->kind,
        .time = e->failure.time,
        .is_static = c->failure.sigma == 0.0,
        .is_from = is_from,
        .is_named = dalcs_arena_alloc(&s->arena, n_devices, sizeof(*x.is_named)),
        .value = dalcs_arena_alloc(&s->arena, n_stimuli, sizeof(*x.value)),
        .shown = dalcs_arena_alloc(&s->arena, n_stimuli, sizeof(*x.shown)),
    };
    x.element = whole_witness(s, w, &x.n_elements);
    if (x.element == NULL || x.is_named == NULL || x.value == NULL || x.shown == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(find_certainty(c, is_from, &x.is_certain));
    for (size_t i = 0; i < n_devices; i++) {
        x.is_named[i] = contains(x.element, x.n_elements, s->circuit.device[i].name);
    }
    list_values(&x, c);
    dalcs_refusal_explain(&x);
    const struct dalcs_location *where = NULL;
    for (size_t k = 0; k < x.n_elements && where == NULL; k++) {
        where = dalcs_place_of(&s->circuit, x.element[k]);
    }
    const char *advice = advice_for(&x);
    if (advice != NULL) {
        hint = hint == NULL ? advice : dalcs_arena_printf(&s->arena, "%s; %s", advice, hint);
    }
    if (hint != NULL && dalcs_refusal_is_of_start(&x)) {
        hint = dalcs_arena_printf(
            &s->arena, "'uic' on %s starts from initial values, without an operating point; %s",
            s->circuit.analyses.periodic.present ? ".pss" : ".tran", hint);
    }
    dalcs_diag_add(&s->diag, DALCS_ERROR, where, hint, "%s %s: %s", when,
                   x.is_certain ? "no solution exists" : "a solution may exist, but none was found",
                   x.because);
    if (!x.is_certain) {
        return DALCS_NOT_CONVERGED;
    }
    report_infeasible(s, &x);
    return DALCS_INFEASIBLE;
}

/* Writes the problem if that is wanted. Returns the hint that says where it is, or NULL. */
static const char *dump_problem(struct dalcs_run *r, const struct dalcs_euler *e,
                                const char *when) {
    const struct dalcs_component *c = &e->component[e->failure.system];
    const char *path = r->options->dump_path;
    if (path == NULL) {
        return NULL;
    }
    struct dalcs_session *s = r->s;
    const char *about = dalcs_arena_printf(&s->arena, "%s %s", s->name, when);
    const struct dalcs_system_step step = {.sigma = c->failure.sigma,
                                           .u = c->failure.u,
                                           .mode = c->osnsp.mode,
                                           .about = about == NULL ? when : about};
    if (dalcs_system_file_write(path, c->system, &step) != DALCS_OK) {
        return dalcs_arena_printf(&s->arena,
                                  "the one-step problem could not be written to '%s': %s", path,
                                  strerror(errno));
    }
    return dalcs_arena_printf(
        &s->arena, "the one-step problem is in '%s'; tools/replay solves it again", path);
}

/* A state that has grown too large. */
static void explain_growth(struct dalcs_session *s, const struct dalcs_component *c, double time) {
    const char *element = c->system->column[c->failure.overgrown].element;
    dalcs_diag_add(&s->diag, DALCS_ERROR, dalcs_place_of(&s->circuit, element),
                   "a negative resistance or a controlled source supplies energy all the time",
                   "at t = %.8g s the circuit is unstable: the %s of '%s' "
                   "has grown to more than 1e240 %s",
                   time, c->system->column_is_current[c->failure.overgrown] ? "current" : "voltage",
                   element, c->system->column_is_current[c->failure.overgrown] ? "A" : "V");
}

enum dalcs_status dalcs_explain_failure(struct dalcs_run *r, const struct dalcs_euler *e,
                                        enum dalcs_status status) {
    struct dalcs_session *s = r->s;
    if (status <= DALCS_OK || e->failure.system < 0) {
        return status;
    }
    if (e->component[e->failure.system].failure.overgrown >= 0) {
        explain_growth(s, &e->component[e->failure.system], e->failure.time);
        return status;
    }
    /* Radau fails just after a time, a step of Euler at its end. */
    bool is_from = !e->failure.at_operating_point &&
                   (e->failure.looks_behind || r->method != DALCS_METHOD_EULER);
    const struct dalcs_smooth_newton *newton = e->component[e->failure.system].osnsp.smooth.newton;
    const char *when = e->failure.at_operating_point ? "at the operating point"
                       : dalcs_failed_at_pole(e, status)
                           ? dalcs_arena_printf(&s->arena, "at t = %.8g s", e->failure.time)
                       : is_from && e->failure.time == 0.0 ? "from t = 0 on"
                       : is_from
                           ? dalcs_arena_printf(&s->arena, "from t = %.8g s on", e->failure.time)
                           : dalcs_arena_printf(&s->arena, "at t = %.9g s (step %ld, h = %.6g s)",
                                                e->failure.time, e->steps + 1, e->failure.h);
    when = when == NULL ? "" : when;
    if (e->component[e->failure.system].failure.restless.pair >= 0) {
        dalcs_explain_restless(s, &e->component[e->failure.system], when);
        return DALCS_NOT_CONVERGED;
    }
    const bool is_smooth = newton != NULL;
    const char *hint = is_smooth ? NULL : dump_problem(r, e, when);
    if (status == DALCS_INFEASIBLE) {
        return explain_infeasible(r, e, is_from, when, hint);
    }
    if (is_smooth) {
        dalcs_explain_smooth(s, &e->component[e->failure.system], when);
        return status;
    }
    const struct dalcs_certificate *c = &e->component[e->failure.system].osnsp.certificate;
    const char *row = dalcs_explain_row(s, e, e->failure.system, c->where);
    dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, hint,
                   "%s no certified solution was found: the best residual is %.3g of its scale, %s",
                   when, c->worst, row == NULL ? "" : row);
    return status;
}

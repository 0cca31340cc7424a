/* computed.c - a sink that computes columns. */
#include "computed.h"

#include <math.h>
#include <string.h>

/* ---- One value --------------------------------------------------------------------------------------- */

/* The columns of a row that a formula reads. */
struct asked {
    const struct dalcs_computing *c;
    const double *row;
};

static double signal_at(const struct dalcs_signal_formula_point *point, int index,
                        enum dalcs_signal_part part) {
    const struct asked *asked = point->user;
    const struct dalcs_computing *c = asked->c;
    const size_t k = c->n_before + (size_t)c->session->circuit.results.measured[index];
    if (!c->is_complex) {
        return asked->row[k];
    }
    const double re = asked->row[2 * k];
    const double im = asked->row[2 * k + 1];
    switch (part) {
    case DALCS_PART_REAL:
        return re;
    case DALCS_PART_IMAGINARY:
        return im;
    case DALCS_PART_PHASE:
        return atan2(im, re) * (180.0 / 3.141592653589793);
    case DALCS_PART_DECIBEL:
        return 20.0 * log10(hypot(re, im));
    default: /* as a measurement has it */
        return hypot(re, im);
    }
}

/* ---- The order of columns ------------------------------------------------------------------------------ */

/* Does computed column number `done` stand before the named signal number `named`? */
static bool is_due(const struct dalcs_circuit *circuit, size_t done, size_t named) {
    return done < (size_t)circuit->results.n_computed &&
           ((size_t)circuit->results.computed[done].at <= named ||
            named >= (size_t)circuit->results.n_named);
}

static void fill(const struct dalcs_computing *c, double time, const double *from, double *to) {
    const struct dalcs_circuit *circuit = &c->session->circuit;
    const struct asked asked = {c, from};
    const struct dalcs_signal_formula_point point = {
        .time = time, .user = &asked, .signal = signal_at};
    const size_t each = c->is_complex ? 2 : 1;
    const size_t n_shown = (size_t)circuit->results.n_shown;
    size_t done = 0;
    for (size_t k = 0; k <= c->n_in; k++) {
        const size_t named = k > c->n_before ? k - c->n_before : 0;
        while (k >= c->n_before && is_due(circuit, done, named)) {
            const struct dalcs_computed *column = &circuit->results.computed[done++];
            *to++ = dalcs_signal_formula_value(&column->formula, &point) + 0.0; /* no -0 */
            if (c->is_complex) {
                *to++ = 0.0;
            }
        }
        const bool is_hidden =
            k >= c->n_before && named >= (size_t)circuit->results.n_named && named < n_shown;
        if (k < c->n_in && !is_hidden) {
            memcpy(to, from + each * k, each * sizeof *to);
            to += each;
        }
    }
}

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct dalcs_computing *c = user;
    const struct dalcs_circuit *circuit = &c->session->circuit;
    const size_t n_shown = (size_t)circuit->results.n_shown;
    const size_t n_named = (size_t)circuit->results.n_named;
    c->passes = plot->analysis == DALCS_TRANSFER; /* whose values are no signals */
    if (c->passes) {
        return c->to->begin(c->to->user, plot);
    }
    struct dalcs_arena *arena = &c->session->arena; /* a plot lives as long as the session */
    c->is_complex = plot->is_complex;
    c->n_in = plot->n_signals;
    c->n_before = plot->analysis == DALCS_DC_SWEEP ? plot->n_signals - n_shown : 0;
    c->n_out = plot->n_signals - n_shown + n_named + (size_t)circuit->results.n_computed;
    const char **name = dalcs_arena_alloc(arena, c->n_out, sizeof *name);
    enum dalcs_unit *unit = dalcs_arena_alloc(arena, c->n_out, sizeof *unit);
    c->row = dalcs_arena_alloc(arena, 2 * c->n_out, sizeof *c->row);
    struct dalcs_plot *shown = dalcs_arena_alloc(arena, 1, sizeof *shown);
    if (name == NULL || unit == NULL || c->row == NULL || shown == NULL) {
        return DALCS_E_NOMEM;
    }
    size_t n = 0, done = 0;
    for (size_t k = 0; k <= c->n_in; k++) {
        const size_t named = k > c->n_before ? k - c->n_before : 0;
        while (k >= c->n_before && is_due(circuit, done, named)) {
            const char *own = circuit->results.computed[done++].name;
            unit[n] = DALCS_UNIT_NONE;
            name[n] = dalcs_arena_copy(arena, own, strlen(own));
            if (name[n++] == NULL) {
                return DALCS_E_NOMEM;
            }
        }
        const bool is_hidden = k >= c->n_before && named >= n_named && named < n_shown;
        if (k < c->n_in && !is_hidden) {
            unit[n] = plot->unit[k];
            name[n++] = plot->name[k];
        }
    }
    *shown = *plot;
    shown->n_signals = c->n_out;
    shown->name = name;
    shown->unit = unit;
    return c->to->begin(c->to->user, shown);
}

static enum dalcs_status row(void *user, double time, const double *value) {
    struct dalcs_computing *c = user;
    if (c->passes) {
        return c->to->row(c->to->user, time, value);
    }
    fill(c, time, value, c->row);
    return c->to->row(c->to->user, time, c->row);
}

static enum dalcs_status end(void *user) {
    const struct dalcs_computing *c = user;
    return c->to->end(c->to->user);
}

static enum dalcs_status progress(void *user, double time, double stop) {
    const struct dalcs_computing *c = user;
    return c->to->progress(c->to->user, time, stop);
}

void dalcs_computing_init(struct dalcs_computing *c, struct dalcs_session *session,
                          const struct dalcs_sink *to) {
    *c = (struct dalcs_computing){
        .sink = {.user = c, .begin = begin, .row = row, .end = end, .progress = progress},
        .to = to,
        .session = session};
}

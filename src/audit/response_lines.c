/* response_lines.c - on which lines diodes and switches may be, by an operating point. */
#include "response_internal.h"

static void add_line(struct response_lines *l, bool may, double p, double q) {
    if (may) {
        l->line[l->n++] = (struct response_line){p, q};
    }
}

/* What a voltage and a current of the operating point may be off by. */
struct doubt {
    double volts, amperes;
};

static void find_diode(struct response_lines *l, const struct dalcs_diode_model *m, double u,
                       double i, struct doubt doubt) {
    const double g = isfinite(m->roff) ? 1.0 / m->roff : 0.0;
    const double own = i - g * u;
    const double amperes = doubt.amperes + g * doubt.volts;
    const double forward = u - m->vfwd - m->ron * own;
    const double reverse = u + m->vrev - m->rrev * own;
    add_line(l, fabs(forward) <= doubt.volts + m->ron * amperes && own >= -amperes,
             1.0 + m->ron * g, m->ron);
    add_line(l, fabs(own) <= amperes, g, 1.0);
    add_line(
        l, isfinite(m->vrev) && fabs(reverse) <= doubt.volts + m->rrev * amperes && own <= amperes,
        1.0 + m->rrev * g, m->rrev);
}

/* Its control and its own voltage and current have to agree. */
static void find_switch(struct response_lines *l, const struct dalcs_switch_model *m,
                        double control, double margin, const double own[2], struct doubt doubt) {
    const double c = (m->is_inverted ? -control : control) - m->vt;
    const double g = isfinite(m->roff) ? 1.0 / m->roff : 0.0;
    const double half_width = fabs(m->vh);
    const bool is_closed = fabs(own[0] - m->ron * own[1]) <= doubt.volts + m->ron * doubt.amperes;
    const bool is_open = fabs(own[1] - g * own[0]) <= doubt.amperes + g * doubt.volts;
    add_line(l, is_closed && c >= -half_width - margin, 1.0, m->ron);
    add_line(l, is_open && c <= half_width + margin, g, 1.0);
}

static void find_lines(const struct dalcs_response_audit *a, const struct dalcs_response_values *at,
                       int device, struct doubt doubt, struct response_lines *l) {
    const struct dalcs_circuit *c = a->circuit;
    const struct dalcs_device *d = &c->device[device];
    l->n = 0;
    const double a0 = creal(at->v[d->node[0]]), b0 = creal(at->v[d->node[1]]);
    const double own[2] = {a0 - b0, creal(at->i[device])};
    if (at->size[device] < 0.0) {
        return;
    }
    if (d->kind == DALCS_DIODE) {
        find_diode(l, &c->models.of_diode[d->model], own[0], own[1], doubt);
    } else if (d->kind == DALCS_SWITCH) {
        const struct dalcs_switch_model *m = &c->models.of_switch[d->model];
        const double control = d->control >= 0 ? creal(at->i[d->control])
                                               : creal(at->v[d->node[2]] - at->v[d->node[3]]);
        const double of_control = d->control >= 0 ? doubt.amperes : doubt.volts;
        const double margin = of_control + a->tolerance * fabs(m->vt);
        find_switch(l, m, control, a->of.are_restless[device] ? INFINITY : margin, own, doubt);
    }
}

bool response_is_two_sided(const struct dalcs_device *d) {
    return d->behaviour == NULL && (d->kind == DALCS_DIODE || d->kind == DALCS_SWITCH);
}

bool response_may_be_free(const struct dalcs_response_audit *a,
                          const struct dalcs_response_event *e, int device,
                          enum response_freedom freedom) {
    const struct doubt doubt = {a->tolerance * a->orbit.volts, a->tolerance * a->orbit.amperes};
    struct response_lines l;
    find_lines(a, e->at[1], device, doubt, &l);
    bool may = l.n == 0; /* nothing is known */
    for (int k = 0; k < l.n; k++) {
        may = may || (freedom == RESPONSE_WIRE ? l.line[k].q : l.line[k].p) == 0.0;
    }
    return may;
}

enum dalcs_status response_find_lines(struct dalcs_response_audit *a,
                                      const struct dalcs_response_values *at) {
    for (int d = 0; d < a->circuit->n_devices; d++) {
        if (!a->of.are_there[d]) {
            continue;
        }
        const struct doubt doubt = {a->rounding * a->volts,
                                    a->rounding * fmax(a->amperes, at->size[d])};
        find_lines(a, at, d, doubt, &a->lines[d]);
        DALCS_TRY(response_find_slopes(a, at, d));
    }
    return DALCS_OK;
}

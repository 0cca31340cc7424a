/* formula_value.c - what a formula puts out, worked out from nothing but the circuit's own voltages and currents: parts of it
 * from what they read, and each cell of pairs from its argument. What a part or a lambda of the run has is asked nowhere: where
 * a side is flat or leaves it out, nothing depends on it, however large it is.
 *
 * circuit/pairs.c makes of a kink 0 <= lambda _|_ lambda / g - a >= 0, and of a saturation or a jump two pairs,
 *     0 <= lambda _|_ nu + lambda / g - a >= 0    and    0 <= nu _|_ H - lambda >= 0.
 * An argument a has lambdas of earlier pairs only. */
#include "audit_currents.h"
#include "audit_formula.h"

struct reading {
    const struct dalcs_audit *audit;
    const struct audit_part *part;
    const struct dalcs_audit_state *s;
    const struct audit_read *moved; /* the one that is off; NULL: none */
    double by;
};

static struct audit_number device_value(const struct reading *r, int device);

/* One of the circuit's own. */
static struct audit_number own_value(const struct reading *r, enum dalcs_quantity_kind kind,
                                     int index) {
    const struct dalcs_audit *audit = r->audit;
    const bool is_moved = r->moved != NULL && r->moved->kind == kind && r->moved->index == index;
    const double by = is_moved ? r->by : 0.0;
    const double scale = audit_read_scale(audit, r->part, r->s, (struct audit_read){kind, index});
    switch (kind) {
    case DALCS_QUANTITY_VOLTAGE:
        return (struct audit_number){r->s->v[index] + by,
                                     AUDIT_ROUNDING * scale + audit->sums.volts};
    case DALCS_QUANTITY_CURRENT:
        return (struct audit_number){audit_current(audit, r->s, index) + by,
                                     AUDIT_ROUNDING * scale + audit->sums.amperes +
                                         audit_current_rounding(audit, r->s, index)};
    default:
        return (struct audit_number){
            dalcs_stimulus_value(&audit->circuit->stimulus[index], r->s->t, r->s->side) + by,
            AUDIT_ROUNDING * scale};
    }
}

static struct audit_number node_value(const struct reading *r, int node) {
    const int device = r->audit->net.part_of != NULL ? r->audit->net.part_of[node] : -1;
    return node == 0     ? (struct audit_number){0.0, 0.0}
           : device >= 0 ? device_value(r, device)
                         : own_value(r, DALCS_QUANTITY_VOLTAGE, node);
}

/* Without the lambdas from `first_left_out` on; lambda: of the pairs before. */
static struct audit_number affine_value(const struct reading *r, const struct dalcs_affine *a,
                                        const struct audit_number *lambda, int first_left_out) {
    struct audit_number sum = {a->constant, 0.0};
    double terms = fabs(a->constant);
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        struct audit_number of;
        if (term->kind == DALCS_QUANTITY_PAIR) {
            if (term->index >= first_left_out) {
                continue;
            }
            of = lambda[term->index];
        } else {
            of = term->kind == DALCS_QUANTITY_VOLTAGE ? node_value(r, term->index)
                                                      : own_value(r, term->kind, term->index);
        }
        sum.value += term->coefficient * of.value;
        sum.rounding += fabs(term->coefficient) * of.rounding;
        terms += fabs(term->coefficient * of.value);
    }
    sum.rounding += AUDIT_ROUNDING * terms;
    return sum;
}

/* 1/g is its resistance. */
static double lambda_at(double argument, double resistance, double height) {
    return resistance > 0.0 ? fmin(fmax(argument / resistance, 0.0), height)
                            : (argument > 0.0 ? height : 0.0);
}

static struct audit_number lambda_of(struct audit_number argument, double resistance,
                                     double height) {
    const double low = lambda_at(argument.value - argument.rounding, resistance, height);
    const double high = lambda_at(argument.value + argument.rounding, resistance, height);
    return (struct audit_number){lambda_at(argument.value, resistance, height), high - low};
}

/* On a vertical end the argument tells nothing of it. That it stands there is the law of its pair. */
static struct audit_number as_it_is(const struct reading *r, int device, int k) {
    return (struct audit_number){r->s->lambda[r->audit->net.first_lambda[device] + k], 0.0};
}

/* The pairs of a device, into the room that the audit has for them. */
static const struct audit_number *solve_cells(const struct reading *r, int device,
                                              const struct dalcs_behaviour *b) {
    struct audit_number *lambda = r->audit->net.reads.lambda + r->audit->net.first_lambda[device];
    for (int k = 0; k < b->n_pairs;) {
        struct audit_number argument = affine_value(r, &b->w[k], lambda, k);
        argument.value = -argument.value;
        const double resistance = dalcs_affine_of_pair(&b->w[k], k);
        const bool is_cell = k + 1 < b->n_pairs && dalcs_affine_of_pair(&b->w[k], k + 1) != 0.0;
        const double height = is_cell ? b->w[k + 1].constant : INFINITY;
        lambda[k] = is_cell || resistance > 0.0 ? lambda_of(argument, resistance, height)
                                                : as_it_is(r, device, k);
        if (is_cell) {
            argument.value -= height * resistance;
            lambda[k + 1] = lambda_of(argument, 1.0, INFINITY);
        }
        k += is_cell ? 2 : 1;
    }
    return lambda;
}

/* How far an argument may be beyond the end of a function's domain. At the start nothing has a scale of its own: a voltage is
 * known to the rounding of the largest one. */
static double slack_of(const struct reading *r, int node) {
    const int *part_of = r->audit->net.part_of;
    const double size = part_of != NULL && part_of[node] >= 0
                            ? audit_formula_size(r->audit, r->part, r->s, part_of[node])
                            : audit_read_scale(r->audit, r->part, r->s,
                                               (struct audit_read){DALCS_QUANTITY_VOLTAGE, node});
    return fmax(r->audit->options.failure * size, AUDIT_ROUNDING * r->part->floor.largest_volt);
}

static struct audit_number smooth_value(const struct reading *r,
                                        const struct dalcs_smooth *smooth) {
    double x[2] = {smooth->number[0], smooth->number[1]};
    double rounding[2] = {0.0, 0.0};
    for (int k = 0; k < smooth->n; k++) {
        if (smooth->node[k] >= 0) {
            const struct audit_number of = node_value(r, smooth->node[k]);
            x[k] = of.value;
            rounding[k] = of.rounding;
        }
    }
    if (!isfinite(dalcs_smooth_value(smooth->kind, x)) && smooth->node[0] >= 0) {
        x[0] = dalcs_smooth_held(smooth->kind, x, slack_of(r, smooth->node[0]));
    }
    struct audit_number f = {dalcs_smooth_value(smooth->kind, x), 0.0};
    f.rounding = AUDIT_ROUNDING * fabs(f.value);
    for (int k = 0; k < smooth->n; k++) {
        f.rounding += smooth->node[k] >= 0 && rounding[k] > 0.0
                          ? dalcs_smooth_variation(smooth->kind, x, k, rounding[k])
                          : 0.0;
    }
    return f;
}

/* What is 0 on one side of 0, whose pair is that of what reads it: 0 <= lambda _|_ lambda - a >= 0 is written of it. */
static struct audit_number held_value(const struct reading *r, const struct dalcs_behaviour *b) {
    struct audit_number argument = affine_value(r, &b->w[0], NULL, 0);
    argument.value = -argument.value;
    struct audit_number held = lambda_of(argument, 1.0, INFINITY);
    held.value *= b->output.term[0].coefficient;
    held.rounding *= fabs(b->output.term[0].coefficient);
    return held;
}

static struct audit_number device_value(const struct reading *r, int device) {
    const struct dalcs_behaviour *b = r->audit->circuit->device[device].behaviour;
    if (b->is_implicit) {
        return held_value(r, b->written);
    }
    if (b->smooth != NULL) {
        return smooth_value(r, b->smooth);
    }
    return affine_value(r, &b->output, solve_cells(r, device, b), b->n_pairs);
}

struct audit_number audit_formula_value(const struct dalcs_audit *audit,
                                        const struct audit_part *part,
                                        const struct dalcs_audit_state *s, int device) {
    const struct reading r = {audit, part, s, NULL, 0.0};
    return device_value(&r, device);
}

/* What a formula is held to: what it makes of the error of each voltage and current that it reads, where those are now, over
 * that error. It is no scale of other instants. */
double audit_formula_size(const struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *s, int device) {
    const struct audit_reads *reads = &audit->net.reads;
    const double failure = audit->options.failure;
    const double value = audit_formula_value(audit, part, s, device).value;
    double size = 0.0;
    for (int k = reads->first[device]; k < reads->first[device + 1]; k++) {
        double most = 0.0;
        for (int side = -1; side <= 1; side += 2) {
            const double by = side * failure * audit_read_scale(audit, part, s, reads->of[k]);
            const struct reading r = {audit, part, s, &reads->of[k], by};
            const double off = fabs(device_value(&r, device).value - value);
            most = isfinite(off) ? fmax(most, off) : most;
        }
        size += most / failure;
    }
    return size;
}

/* formulas.c - what B, and E and G with formulas, put out, and each of their pairs. */
#include "audit_internal.h"

static double part_value(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s, int device, double *size);

/* The voltage of a node in a formula: what a part of the formula puts out there is worked out from what that reads, down to
 * the circuit's own voltages and currents; as_is: or taken as it is. */
static double node_value(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s, int node, bool as_is, double *scale) {
    const int device = audit->net.part_of != NULL ? audit->net.part_of[node] : -1;
    if (device >= 0 && !as_is) {
        return part_value(audit, part, s, device, scale);
    }
    *scale = node > 0 ? audit_volts(audit, part, node, 0) : 0.0;
    return s->v[node];
}

/* *size: what the terms are held to, added up; *terms: what they are. */
static double affine_value(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *s, int device, bool as_is,
                           const struct dalcs_affine *a, double *size, double *terms) {
    double sum = a->constant;
    *size = *terms = fabs(a->constant);
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        double value;
        double scale;
        switch (term->kind) {
        case DALCS_QUANTITY_VOLTAGE:
            value = node_value(audit, part, s, term->index, as_is, &scale);
            break;
        case DALCS_QUANTITY_CURRENT:
            value = audit_current(audit, s, term->index);
            scale = audit_amperes(audit, part, term->index);
            break;
        case DALCS_QUANTITY_PAIR:
            value = s->lambda[audit->net.first_lambda[device] + term->index];
            scale = audit->scale.lambda[audit->net.first_lambda[device] + term->index];
            break;
        default:
            value = dalcs_stimulus_value(&audit->circuit->stimulus[term->index], s->t, s->side);
            scale = fabs(value);
            break;
        }
        sum += term->coefficient * value;
        *size += fabs(term->coefficient) * fmax(scale, fabs(value));
        *terms += fabs(term->coefficient * value);
    }
    return sum;
}

/* What an argument's scale makes of a smooth function, by its tangent, or by what the function itself changes over the error
 * that fails a run where that is less: a root near 0 is steep, and for no longer than it is near. That is no scale of other
 * instants. */
static double reach_of(const struct dalcs_audit *audit, const struct dalcs_smooth *smooth,
                       const double *x, int k, double slope, double scale) {
    const double failure = audit->options.failure;
    const double by_slope = slope * scale;
    const double value = fabs(dalcs_smooth_value(smooth->kind, x));
    if (by_slope <= value || audit->scale.is_lasting) {
        return fmin(by_slope, value);
    }
    return fmin(by_slope, dalcs_smooth_variation(smooth->kind, x, k, failure * scale) / failure);
}

/* Of a smooth function terms are what each argument makes of its own. */
static double smooth_value(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *s, const struct dalcs_smooth *smooth,
                           double *size) {
    double x[2] = {smooth->number[0], smooth->number[1]};
    double scale[2] = {0.0, 0.0};
    double gradient[2];
    for (int k = 0; k < smooth->n; k++) {
        if (smooth->node[k] >= 0) {
            x[k] = node_value(audit, part, s, smooth->node[k], false, &scale[k]);
        }
    }
    /* at the start nothing has a scale of its own: a voltage is known to the rounding of the largest one */
    const double rounding = AUDIT_ROUNDING * part->floor.largest_volt;
    const double slack = fmax(audit->options.failure * fmax(scale[0], fabs(x[0])),
                              smooth->node[0] >= 0 ? rounding : 0.0);
    x[0] = dalcs_smooth_held(smooth->kind, x, slack);
    const double value = dalcs_smooth_value(smooth->kind, x);
    dalcs_smooth_gradient(smooth->kind, x, gradient);
    *size = fabs(value);
    for (int k = 0; k < smooth->n; k++) {
        const double reach = fmax(scale[k], fabs(x[k]));
        *size += smooth->node[k] >= 0 && !isnan(gradient[k])
                     ? reach_of(audit, smooth, x, k, fabs(gradient[k]), reach)
                     : 0.0;
    }
    return value;
}

/* What is 0 on one side of 0, by what it reads and not by its pair: 0 <= lambda _|_ lambda - a >= 0 is written of it. */
static double held_value(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s, int device, double *size) {
    const struct dalcs_behaviour *b = audit->circuit->device[device].behaviour->written;
    struct dalcs_affine ahead = b->w[0];
    double terms;
    ahead.n--; /* less its lambda, the last term */
    const double a = -affine_value(audit, part, s, device, false, &ahead, size, &terms);
    return b->output.term[0].coefficient * fmax(a, 0.0);
}

static double part_value(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s, int device, double *size) {
    const struct dalcs_behaviour *b = audit->circuit->device[device].behaviour;
    double terms;
    if (b->is_implicit) {
        return held_value(audit, part, s, device, size);
    }
    return b->smooth != NULL
               ? smooth_value(audit, part, s, b->smooth, size)
               : affine_value(audit, part, s, device, false, &b->output, size, &terms);
}

static bool is_own(const struct dalcs_affine_term *term, int row) {
    return term->kind == DALCS_QUANTITY_PAIR && term->index >= row;
}

/* The lambdas of a row's own cell are held to the scale of the argument that they are added to: it has lambdas of earlier
 * pairs only. A number in it is exact and may be a limit that nothing comes near: it is no scale. The height that a lambda
 * jumps or saturates at is. */
static void raise_lambdas(struct dalcs_audit *audit, int device, int row,
                          const struct dalcs_affine *a, double size) {
    double *scale = audit->scale.lambda + audit->net.first_lambda[device];
    const bool is_room =
        a->n == 1 && a->term[0].kind == DALCS_QUANTITY_PAIR; /* H - lambda, of the pair before */
    if (is_room) {
        double *of = &scale[a->term[0].index];
        *of = fmax(*of, a->constant);
    }
    size -= fabs(a->constant);
    for (int k = 0; k < a->n; k++) {
        if (is_own(&a->term[k], row)) {
            size -= fabs(a->term[k].coefficient) * scale[a->term[k].index];
        }
    }
    for (int k = 0; k < a->n; k++) {
        if (is_own(&a->term[k], row)) {
            scale[a->term[k].index] =
                fmax(scale[a->term[k].index], size / fabs(a->term[k].coefficient));
        }
    }
}

/* What rounding of charges and fluxes makes of the currents and voltages that an affine function reads. */
static double rounding_read(const struct dalcs_audit *audit, const struct dalcs_affine *a) {
    double rounding = 0.0;
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        rounding +=
            term->kind == DALCS_QUANTITY_CURRENT   ? fabs(term->coefficient) * audit->sums.amperes
            : term->kind == DALCS_QUANTITY_VOLTAGE ? fabs(term->coefficient) * audit->sums.volts
                                                   : 0.0;
    }
    return rounding;
}

/* How far a pair is from complementarity, over its scales; what is more than rounding. */
static double pair_defect(struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *s, int device, int k) {
    const struct dalcs_affine *of = &audit->circuit->device[device].behaviour->w[k];
    const bool as_is = audit->net.is_inner != NULL && audit->net.is_inner[device];
    const int pair = audit->net.first_lambda[device] + k;
    double size;
    double terms;
    const double w = affine_value(audit, part, s, device, as_is, of, &size, &terms);
    raise_lambdas(audit, device, k, of, size);
    const double lambda = audit_ratio(s->lambda[pair], audit->scale.lambda[pair]);
    return fabs(fmin(lambda, audit_ratio(w, size))) - AUDIT_ROUNDING;
}

/* A pair may change sides a millionth of a step late: what is read goes on meanwhile by no more than that times its slope,
 * which for a polynomial is bounded (V. Markov). A microampere that a triac tells from nothing passes in picoseconds
 * where a gate closes it on amperes. */
static const double soon = 1e-6;

bool audit_behaviour_may_turn(const struct dalcs_audit *audit, const struct audit_part *part,
                              const struct dalcs_audit_state *s, int device) {
    const struct dalcs_behaviour *b = audit->circuit->device[device].behaviour;
    const bool as_is = audit->net.is_inner != NULL && audit->net.is_inner[device];
    bool may = false;
    for (int k = 0; k < b->n_pairs && !may; k++) {
        const int pair = audit->net.first_lambda[device] + k;
        double size;
        double terms;
        const double w = affine_value(audit, part, s, device, as_is, &b->w[k], &size, &terms);
        may = fabs(w) <= part->tolerance * size &&
              fabs(s->lambda[pair]) <= part->tolerance * audit->scale.lambda[pair];
    }
    return may;
}

double audit_jump_beside(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s, int device) {
    const struct dalcs_behaviour *b = audit->circuit->device[device].behaviour;
    const bool as_is = audit->net.is_inner != NULL && audit->net.is_inner[device];
    double least = INFINITY;
    for (int k = 0; k + 1 < b->n_pairs; k++) {
        double size;
        double terms;
        if (b->rest == NULL || isnan(b->rest[k])) {
            continue;
        }
        const double w = affine_value(audit, part, s, device, as_is, &b->w[k], &size, &terms);
        const double argument = s->lambda[audit->net.first_lambda[device] + k + 1] - w;
        least = fmin(least, fmax(audit_ratio(fabs(argument), size) - AUDIT_ROUNDING, 0.0));
    }
    return least;
}

double audit_formula_terms(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *s, int device) {
    const struct dalcs_behaviour *b = audit->circuit->device[device].behaviour;
    double most = 0.0;
    for (int k = -1; k < b->n_pairs; k++) {
        double size;
        double terms;
        (void)affine_value(audit, part, s, device, false, k < 0 ? &b->output : &b->w[k], &size,
                           &terms);
        most = fmax(most, size);
    }
    return most;
}

/* Signs and complementarity. In a part of a formula they are those of what the run has there: how near that is to what
 * the formula says is in the value of the whole. What that part is by what it reads has no pair of its own to hold. */
static void check_pairs(struct dalcs_audit *audit, struct audit_part *part,
                        const struct dalcs_audit_state *s, int device, double held) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const enum dalcs_audit_law law =
        d->kind == DALCS_VCVS ? DALCS_AUDIT_BRANCH : DALCS_AUDIT_CURRENT;
    for (int k = 0; k < d->behaviour->n_pairs && !d->behaviour->is_implicit; k++) {
        double over = pair_defect(audit, part, s, device, k);
        if (over > part->tolerance && part->at.lateness > 0.0) {
            audit->state.shifted.side = s->side;
            audit->state.shifted.t = s->t + fmax(part->at.lateness, soon * part->at.step);
            audit->reader.read(audit->reader.user, (int)(part - audit->part),
                               &audit->state.shifted);
            over = fmin(over, pair_defect(audit, part, &audit->state.shifted, device, k));
        }
        audit_find(audit, part, law, device, over * held, held, s->t);
    }
}

/* What terms are held to at other instants, too. */
static double lasting_size(struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *s, int device, double size) {
    const struct dalcs_behaviour *b = audit->circuit->device[device].behaviour;
    double terms;
    if (!part->has.smooth) {
        return size;
    }
    audit->scale.is_lasting = true;
    if (b->smooth != NULL) {
        (void)smooth_value(audit, part, s, b->smooth, &size);
    } else {
        (void)affine_value(audit, part, s, device, false, &b->output, &size, &terms);
    }
    audit->scale.is_lasting = false;
    return size;
}

/* A formula's output, less what the device puts out; each of its pairs. */
void audit_check_formula(struct dalcs_audit *audit, struct audit_part *part,
                         const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_smooth *smooth = d->behaviour->smooth;
    double size;
    double terms = 0.0;
    if (audit->net.is_inner != NULL && audit->net.is_inner[device]) {
        check_pairs(audit, part, s, device, 1.0); /* its output is in what reads it */
        return;
    }
    const double f = smooth != NULL ? smooth_value(audit, part, s, smooth, &size)
                                    : affine_value(audit, part, s, device, false,
                                                   &d->behaviour->output, &size, &terms);
    const bool is_voltage = d->kind == DALCS_VCVS;
    double *largest = &part->floor.formula[is_voltage ? 0 : 1];
    *largest = fmax(*largest, terms);
    const double is = is_voltage ? audit_voltage(s, d) : s->i[device];
    const double scale = is_voltage ? audit_volts(audit, part, d->node[0], d->node[1])
                                    : audit_amperes(audit, part, device);
    const double held = size + scale;
    const enum dalcs_audit_law law = is_voltage ? DALCS_AUDIT_BRANCH : DALCS_AUDIT_CURRENT;
    const double rounding = AUDIT_ROUNDING * size + rounding_read(audit, &d->behaviour->output);
    const double lasting = lasting_size(audit, part, s, device, size) + scale;
    const double share = held > lasting ? lasting / held : 1.0;
    audit_find(audit, part, law, device, (fabs(is - f) - rounding) * share,
               held > lasting ? lasting : held, s->t);
    check_pairs(audit, part, s, device, held);
}

void audit_check_formulas(struct dalcs_audit *audit, struct audit_part *part,
                          const struct dalcs_audit_state *s) {
    audit_round_storage(audit, part, s);
    for (int k = 0; k < part->n_devices; k++) {
        if (audit->circuit->device[part->device[k]].behaviour != NULL) {
            audit_check_formula(audit, part, s, part->device[k]);
        }
    }
}

/* formulas.c - what B, and E and G with formulas, put out, and each of their pairs. */
#include "audit_formula.h"

/* As the run has it, parts and lambdas too. *size: what the terms are held to, added up. */
static double affine_value(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *s, int device,
                           const struct dalcs_affine *a, double *size) {
    double sum = a->constant;
    *size = fabs(a->constant);
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        double value;
        double scale;
        switch (term->kind) {
        case DALCS_QUANTITY_VOLTAGE:
            value = s->v[term->index];
            scale = term->index > 0 ? audit_volts(audit, part, term->index, 0) : 0.0;
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
    }
    return sum;
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

/* How far a pair is from complementarity, over its scales; what is more than rounding. */
static double pair_defect(struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *s, int device, int k) {
    const struct dalcs_affine *of = &audit->circuit->device[device].behaviour->w[k];
    const int pair = audit->net.first_lambda[device] + k;
    double size;
    const double w = affine_value(audit, part, s, device, of, &size);
    raise_lambdas(audit, device, k, of, size);
    const double lambda = audit_ratio(s->lambda[pair], audit->scale.lambda[pair]);
    return fabs(fmin(lambda, audit_ratio(w, size))) - AUDIT_ROUNDING;
}

/* A pair may change sides a millionth of a step late: what is read goes on meanwhile by no more than that times its slope,
 * which for a polynomial is bounded (V. Markov). A microampere that a triac tells from nothing passes in picoseconds
 * where a gate closes it on amperes. */
static const double soon = 1e-6;

static void read_later(struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_state *s) {
    audit->state.shifted.side = s->side;
    audit->state.shifted.t = s->t + fmax(part->at.lateness, soon * part->at.step);
    audit->reader.read(audit->reader.user, (int)(part - audit->part), &audit->state.shifted);
}

bool audit_behaviour_may_turn(const struct dalcs_audit *audit, const struct audit_part *part,
                              const struct dalcs_audit_state *s, int device) {
    const struct dalcs_behaviour *b = audit->circuit->device[device].behaviour;
    bool may = false;
    for (int k = 0; k < b->n_pairs && !may; k++) {
        const int pair = audit->net.first_lambda[device] + k;
        double size;
        const double w = affine_value(audit, part, s, device, &b->w[k], &size);
        may = fabs(w) <= part->tolerance * size &&
              fabs(s->lambda[pair]) <= part->tolerance * audit->scale.lambda[pair];
    }
    return may;
}

double audit_jump_beside(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s, int device) {
    const struct dalcs_behaviour *b = audit->circuit->device[device].behaviour;
    double least = INFINITY;
    for (int k = 0; k + 1 < b->n_pairs; k++) {
        double size;
        if (b->rest == NULL || isnan(b->rest[k])) {
            continue;
        }
        const double w = affine_value(audit, part, s, device, &b->w[k], &size);
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
        (void)affine_value(audit, part, s, device, k < 0 ? &b->output : &b->w[k], &size);
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
            read_later(audit, part, s);
            over = fmin(over, pair_defect(audit, part, &audit->state.shifted, device, k));
        }
        audit_find(audit, part, law, device, over * held, held, s->t);
    }
}

/* A formula's output, less what the device puts out, over what the formula is held to where its arguments are now. What is
 * more than rounding. */
static double output_defect(const struct dalcs_audit *audit, const struct audit_part *part,
                            const struct dalcs_audit_state *s, int device, double scale) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct audit_number f = audit_formula_value(audit, part, s, device);
    const double is = d->kind == DALCS_VCVS ? audit_voltage(s, d) : s->i[device];
    const double off = fabs(is - f.value) - f.rounding;
    return off <= 0.0 ? 0.0 : audit_ratio(off, scale + audit_formula_size(audit, part, s, device));
}

/* The levels that a formula adds up, in the unit that it puts out: numbers, jumps and saturations. What cancels of them leaves
 * its rounding, and nothing near it is known better. */
double audit_formula_levels(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                            int device) {
    const struct dalcs_behaviour *b = audit->circuit->device[device].behaviour;
    double sum = fabs(b->output.constant);
    for (int k = 0; k < b->output.n; k++) {
        const struct dalcs_affine_term *term = &b->output.term[k];
        const bool is_bounded = term->kind == DALCS_QUANTITY_PAIR && term->index + 1 < b->n_pairs &&
                                dalcs_affine_of_pair(&b->w[term->index], term->index + 1) != 0.0;
        sum +=
            is_bounded
                ? fabs(term->coefficient * s->lambda[audit->net.first_lambda[device] + term->index])
                : 0.0;
    }
    return sum;
}

/* The terms that are parts of it, where smooth functions are. What cancels of them leaves their rounding as well: 200 A times
 * 1 - exp(-x). A kink without an end may leave out a part that is steep, and a flat side has nothing of that: none then. */
double audit_formula_rounding(const struct dalcs_audit *audit, const struct audit_part *part,
                              const struct dalcs_audit_state *s, int device) {
    const struct dalcs_behaviour *b = audit->circuit->device[device].behaviour;
    double sum = 0.0;
    for (int k = 0; k < b->output.n && b->n_pairs == 0; k++) {
        const struct dalcs_affine_term *term = &b->output.term[k];
        const int inner = term->kind == DALCS_QUANTITY_VOLTAGE && audit->net.part_of != NULL
                              ? audit->net.part_of[term->index]
                              : -1;
        if (inner >= 0 && audit->circuit->device[inner].behaviour->smooth != NULL) {
            sum += fabs(term->coefficient * audit_formula_value(audit, part, s, inner).value);
        }
    }
    return AUDIT_ROUNDING * sum;
}

/* A formula's output; each of its pairs. */
void audit_check_formula(struct dalcs_audit *audit, struct audit_part *part,
                         const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    if (audit->net.is_inner != NULL && audit->net.is_inner[device]) {
        check_pairs(audit, part, s, device, 1.0); /* its output is in what reads it */
        return;
    }
    const bool is_voltage = d->kind == DALCS_VCVS;
    const double scale = is_voltage ? audit_volts(audit, part, d->node[0], d->node[1])
                                    : audit_amperes(audit, part, device);
    const enum dalcs_audit_law law = is_voltage ? DALCS_AUDIT_BRANCH : DALCS_AUDIT_CURRENT;
    double over = output_defect(audit, part, s, device, scale);
    if (over > part->tolerance && part->at.lateness > 0.0) {
        read_later(audit, part, s);
        over = fmin(over, output_defect(audit, part, &audit->state.shifted, device, scale));
    }
    audit_find(audit, part, law, device, over * scale, scale, s->t);
    check_pairs(audit, part, s, device, scale);
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

void audit_look_at_formulas(struct dalcs_audit *audit, int index, double t, enum dalcs_side side) {
    struct audit_part *part = &audit->part[index];
    struct dalcs_audit_state *now = &audit->state.now;
    now->t = t;
    now->side = side;
    audit->reader.read(audit->reader.user, index, now);
    audit_note_scales(audit, part, now);
    audit_check_formulas(audit, part, now);
}

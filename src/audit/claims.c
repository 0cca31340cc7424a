/* claims.c - what is claimed of a function of time, against the auditor's own values of it. */
#include "audit_internal.h"

#include "claims.h"

/* A function that others take for smooth between two times may have kinks and jumps: halving down to a millionth of the
 * time leaves of a jump less than the smallest tolerance that is promised. More values than these are not taken. */
enum { MOST_HALVINGS = 20, MOST_VALUES = 4000 };

/* Of the tolerance that the last halving may change. */
static const double settled = 1e-3;

/* ---- Integrals ----------------------------------------------------------------------------------- */

struct quadrature {
    const struct dalcs_audit_function *f;
    int power;
    double tolerance;
    double largest; /* of the function so far */
    double doubt;
    int n_values;
    bool has_no_value;
};

static double gauss(struct quadrature *q, double from, double to) {
    double sum = 0.0;
    for (int k = 0; k < AUDIT_GAUSS; k++) {
        const double t = from + audit_gauss_node[k] * (to - from);
        double doubt;
        const double value = q->f->value(q->f->user, t, k == AUDIT_GAUSS / 2 ? &doubt : NULL);
        q->largest = fmax(q->largest, fabs(value));
        q->has_no_value = q->has_no_value || !isfinite(value);
        sum += audit_gauss_weight[k] * (q->power == 1 ? value : value * value);
        if (k == AUDIT_GAUSS / 2 && doubt > q->doubt) {
            q->doubt = doubt;
        }
    }
    q->n_values += AUDIT_GAUSS;
    return sum * (to - from);
}

/* *off: what the halving has changed. */
static double halve(struct quadrature *q, double from, double to, double whole, int depth,
                    double *off) {
    const double middle = 0.5 * (from + to);
    const double left = gauss(q, from, middle);
    const double right = gauss(q, middle, to);
    const double change = fabs(left + right - whole);
    const double unit = q->power == 1 ? q->largest : q->largest * q->largest;
    if (change <= settled * q->tolerance * unit * (to - from) || depth == MOST_HALVINGS ||
        q->n_values >= MOST_VALUES || q->has_no_value) {
        *off += change;
        return left + right;
    }
    return halve(q, from, middle, left, depth + 1, off) +
           halve(q, middle, to, right, depth + 1, off);
}

struct dalcs_audit_sum dalcs_audit_integral(const struct dalcs_audit *audit,
                                            const struct dalcs_audit_function *f, int power,
                                            double from, double to) {
    struct quadrature q = {.f = f, .power = power, .tolerance = audit->options.failure};
    double off = 0.0;
    const double sum = halve(&q, from, to, gauss(&q, from, to), 0, &off);
    /* of a square twice as much, at its largest value */
    const double rounding = power == 1 ? q.doubt : 2.0 * q.doubt * q.largest;
    const bool is_known = !q.has_no_value && q.n_values < MOST_VALUES;
    return (struct dalcs_audit_sum){sum, is_known ? off + rounding * (to - from) : INFINITY};
}

/* ---- Findings ------------------------------------------------------------------------------------ */

/* Numbers may be of several parts: they are held to what the least exact of these is. */
static struct audit_part *loosest(const struct dalcs_audit *audit) {
    int loosest = 0;
    for (int k = 1; k < audit->options.n_parts; k++) {
        loosest = audit->part[k].tolerance > audit->part[loosest].tolerance ? k : loosest;
    }
    return &audit->part[loosest];
}

void dalcs_audit_off(struct dalcs_audit *audit, const struct dalcs_audit_number *number, double off,
                     double t) {
    if (audit->options.n_parts == 0) {
        return;
    }
    struct audit_part *part = loosest(audit);
    part->at.is_coarse = false; /* a number is made of what is there, however near that is */
    audit_find(audit, part, number->law, number->index, off, number->scale, t);
}

void dalcs_audit_claim_integral(struct dalcs_audit *audit, const struct dalcs_audit_number *number,
                                const struct dalcs_audit_claim *claim,
                                const struct dalcs_audit_sum *own) {
    const double off = (fabs(claim->value - own->value) - own->doubt) / (claim->to - claim->from);
    /* a mean square is off by twice what a value of its largest is */
    const double unit = claim->power == 1 ? 1.0 : 2.0 * fmax(number->scale, 0x1p-511);
    if (isfinite(own->doubt)) {
        dalcs_audit_off(audit, number, off / unit, claim->to);
    }
}

void dalcs_audit_add_to(struct dalcs_audit *audit, enum dalcs_audit_law law, int index,
                        double defect, double t) {
    const struct dalcs_audit_number number = {law, index, 1.0};
    dalcs_audit_off(audit, &number, defect, t);
}

void dalcs_audit_claim_part(struct dalcs_audit *audit, const struct dalcs_audit_number *number,
                            const struct dalcs_audit_claim *claim,
                            const struct dalcs_audit_sum *own) {
    const double scale = number->scale;
    const double unit = claim->power == 1 ? scale : 2.0 * scale * scale;
    const double off = (fabs(claim->value - own->value) - own->doubt) / (claim->to - claim->from);
    if (isfinite(own->doubt) && off > 0.0) {
        dalcs_audit_add_to(audit, number->law, number->index, audit_ratio(off, unit), claim->to);
    }
}

/* Between times that nothing tells apart it may take any step: the nearest of three values counts. */
void dalcs_audit_claim_value(struct dalcs_audit *audit, const struct dalcs_audit_number *number,
                             const struct dalcs_audit_function *f, double t, double claimed) {
    double doubt;
    double off = fabs(claimed - f->value(f->user, t, &doubt));
    for (int side = -1; side <= 1 && off > doubt; side += 2) {
        const double near = t + side * 4.0 * audit->options.resolution;
        off = fmin(off, fabs(claimed - f->value(f->user, near, NULL)));
    }
    if (isfinite(off) && isfinite(doubt)) {
        dalcs_audit_off(audit, number, off - doubt, t);
    }
}

/* ---- Slopes -------------------------------------------------------------------------------------- */

/* Central differences of order 6, shifted where t is near an end: by the polynomial through seven values, so far apart.
 * *rounding: what the doubt of one of them makes of it. */
static double slope_by(const struct dalcs_audit_function *f, double t, double from, double to,
                       double h, double *rounding) {
    enum { N = 7 };

    double begin = fmin(fmax(t - 3.0 * h, from), to - 6.0 * h);
    double slope = 0.0;
    *rounding = 0.0;
    for (int j = 0; j < N; j++) {
        double doubt;
        const double at = begin + j * h;
        double weight = 0.0; /* of Lagrange's polynomial j, its derivative at t */
        for (int m = 0; m < N; m++) {
            double product = m == j ? 0.0 : 1.0 / ((j - m) * h);
            for (int k = 0; k < N && m != j; k++) {
                product *= k == j || k == m ? 1.0 : (t - begin - k * h) / ((j - k) * h);
            }
            weight += product;
        }
        const double value = f->value(f->user, at, &doubt);
        slope += weight * value;
        *rounding += fabs(weight) * doubt;
    }
    return slope;
}

void dalcs_audit_claim_slope(struct dalcs_audit *audit, const struct dalcs_audit_number *number,
                             const struct dalcs_audit_function *f, double t, double from, double to,
                             double claimed) {
    const double h = (to - from) / 16.0;
    double rounding[2];
    const double coarse = slope_by(f, t, from, to, h, &rounding[0]);
    const double fine = slope_by(f, t, from, to, 0.5 * h, &rounding[1]);
    const double off = fabs(claimed - fine) - fabs(fine - coarse) - rounding[0] - rounding[1];
    if (isfinite(off)) { /* over the time in which it would change a value by the scale */
        dalcs_audit_off(audit, number, off * (to - from), t);
    }
}

/* ---- Crossings ----------------------------------------------------------------------------------- */

void dalcs_audit_claim_crossing(struct dalcs_audit *audit, const struct dalcs_audit_number *number,
                                const struct dalcs_audit_function *f, double t, double from,
                                double to, int way) {
    double doubt;
    const double at = f->value(f->user, t, &doubt);
    const double near = 4.0 * audit->options.resolution;
    if (!isfinite(at) || !isfinite(doubt)) {
        return;
    }
    if (t <= from + near) { /* a jump: on its far side, or on the level */
        dalcs_audit_off(audit, number, way == 0 ? 0.0 : -way * at - doubt, t);
        return;
    }
    /* between two times that nothing tells apart it may take any step */
    const double before = f->value(f->user, fmax(t - near, from), NULL);
    const double after = f->value(f->user, fmin(t + near, to), NULL);
    const double least = fmin(before, fmin(at, after));
    const double most = fmax(before, fmax(at, after));
    dalcs_audit_off(audit, number, fmax(least, -most) - doubt, t);
}

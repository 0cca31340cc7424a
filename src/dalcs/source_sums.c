/* source_sums.c - sums of sources that must be 0 at all times. */
#include "source_sums.h"

#include "magnitudes.h"
#include "quantity.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

static bool same_points(const struct dalcs_stimulus *a, const struct dalcs_stimulus *b) {
    size_t n = (size_t)a->u.pwl.n;
    return a->u.pwl.n == b->u.pwl.n && a->u.pwl.repeats == b->u.pwl.repeats &&
           a->u.pwl.repeat_from == b->u.pwl.repeat_from &&
           memcmp(a->u.pwl.t, b->u.pwl.t, n * sizeof(double)) == 0 &&
           memcmp(a->u.pwl.v, b->u.pwl.v, n * sizeof(double)) == 0;
}

/* The same function of time, and the same operating value? */
static bool same(const struct dalcs_stimulus *a, const struct dalcs_stimulus *b) {
    if (a->kind != b->kind || a->has_dc != b->has_dc || (a->has_dc && a->dc != b->dc)) {
        return false;
    }
    switch (a->kind) {
    case DALCS_STIMULUS_SIN:
        return memcmp(&a->u.sine, &b->u.sine, sizeof(a->u.sine)) == 0;
    case DALCS_STIMULUS_PULSE:
        return memcmp(&a->u.pulse, &b->u.pulse, sizeof(a->u.pulse)) == 0;
    case DALCS_STIMULUS_PWL:
        return same_points(a, b);
    case DALCS_STIMULUS_EXP:
        return memcmp(&a->u.exponential, &b->u.exponential, sizeof(a->u.exponential)) == 0;
    case DALCS_STIMULUS_TONES:
        return a->u.tones.offset == b->u.tones.offset && a->u.tones.delay == b->u.tones.delay &&
               a->u.tones.n == b->u.tones.n &&
               memcmp(a->u.tones.tone, b->u.tones.tone,
                      (size_t)a->u.tones.n * sizeof(*a->u.tones.tone)) == 0;
    case DALCS_STIMULUS_DELAYED:
        return a->u.history == b->u.history;
    default:
        return a->dc == b->dc;
    }
}

static const struct dalcs_stimulus *stimulus_of(const struct dalcs_circuit *c, int device) {
    return &c->stimulus[c->device[device].stimulus];
}

enum dalcs_sum_verdict dalcs_source_sum_judge(const struct dalcs_circuit *c,
                                              const struct dalcs_source_sum *s, double *left) {
    bool gone[DALCS_MOST_SUMMANDS] = {false};
    double size = 0.0;
    *left = 0.0;
    if (s->n > DALCS_MOST_SUMMANDS) {
        return DALCS_SUM_UNKNOWN;
    }
    for (int i = 0; i < s->n; i++) {
        const struct dalcs_stimulus *a = stimulus_of(c, s->device[i]);
        for (int j = i + 1; j < s->n && a->kind != DALCS_STIMULUS_DC && !gone[i]; j++) {
            if (!gone[j] && s->sign[i] == -s->sign[j] && same(a, stimulus_of(c, s->device[j]))) {
                gone[i] = gone[j] = true;
            }
        }
        if (a->kind != DALCS_STIMULUS_DC && !gone[i]) {
            return DALCS_SUM_UNKNOWN;
        }
        if (a->kind == DALCS_STIMULUS_DC) {
            *left += s->sign[i] * a->dc;
            size += fabs(a->dc);
        }
    }
    return fabs(*left) > dalcs_alike * size      ? DALCS_SUM_CONTRADICTS
           : fabs(*left) <= dalcs_rounded * size ? DALCS_SUM_AGREES
                                                 : DALCS_SUM_UNKNOWN;
}

void dalcs_source_sum_add(struct dalcs_source_sum *s, int device, double sign) {
    if (s->n < DALCS_MOST_SUMMANDS) {
        s->device[s->n] = device;
        s->sign[s->n] = sign;
    }
    s->n++;
}

const char *dalcs_source_text(struct dalcs_arena *a, const struct dalcs_circuit *c, int device) {
    const struct dalcs_device *d = &c->device[device];
    if (d->stimulus < 0 || c->stimulus[d->stimulus].kind != DALCS_STIMULUS_DC) {
        return d->name;
    }
    char value[DALCS_QUANTITY_SIZE];
    (void)dalcs_quantity_write(value, c->stimulus[d->stimulus].dc,
                               d->kind == DALCS_VSOURCE ? "V" : "A", 6);
    const char *text = dalcs_arena_printf(a, "%s (%s)", d->name, value);
    return text == NULL ? d->name : text;
}

const char *dalcs_listed(struct dalcs_arena *a, const char *before, const char *after) {
    if (*before == '\0' || *after == '\0') {
        return *before == '\0' ? after : before;
    }
    const char *text = dalcs_arena_printf(a, "%s, %s", before, after);
    return text == NULL ? before : text;
}

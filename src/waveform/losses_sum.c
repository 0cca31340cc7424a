/* losses_sum.c - sums over stretches, and what switches by their tables. */
#include "losses_sum.h"
#include "pi.h"
#include "side_span.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { N = DALCS_STRETCH_NODES };

static double frequency_of(const struct dalcs_circuit *c, const struct dalcs_device *d) {
    const struct dalcs_stimulus *s = d->stimulus >= 0 ? &c->stimulus[d->stimulus] : NULL;
    if (s == NULL) {
        return 0.0;
    }
    if (s->kind == DALCS_STIMULUS_SIN) {
        return s->u.sine.frequency;
    }
    bool repeats = s->kind == DALCS_STIMULUS_PULSE && isfinite(s->u.pulse.period);
    return repeats && s->u.pulse.period > 0.0 ? 1.0 / s->u.pulse.period : 0.0;
}

enum dalcs_status dalcs_losses_sum_setup(struct dalcs_losses_sum *sum,
                                         const struct dalcs_circuit *circuit, double stop,
                                         double near) {
    const size_t n = (size_t)circuit->n_devices;
    *sum = (struct dalcs_losses_sum){.circuit = circuit,
                                     .from = circuit->results.losses->from,
                                     .to = fmin(circuit->results.losses->to, stop),
                                     .near = near};
    sum->device = dalcs_alloc(n, sizeof(*sum->device));
    if (sum->device == NULL) {
        dalcs_losses_sum_finish(sum);
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        sum->device[k].frequency = frequency_of(circuit, &circuit->device[k]);
        sum->device[k].first = NAN;
        sum->device[k].mean[0] = sum->device[k].mean[1] = sum->device[k].mean[2] = -1;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_losses_sum_ask_sides(struct dalcs_losses_sum *sum,
                                             struct dalcs_side_means *sides) {
    sum->sides = sides;
    for (int k = 0; k < sum->circuit->n_devices; k++) {
        const struct dalcs_loss_device *of = &sum->circuit->results.losses->device[k];
        const struct dalcs_side_mean product[3] = {{.signal = {of->voltage, of->voltage}},
                                                   {.signal = {of->current, of->current}},
                                                   {.signal = {of->voltage, of->current}}};
        for (int i = 0; i < 3 && of->voltage >= 0; i++) {
            DALCS_TRY(dalcs_side_means_add(sides, &product[i], &sum->device[k].mean[i]));
        }
    }
    return DALCS_OK;
}

bool dalcs_losses_sum_slides(const struct dalcs_losses_sum *sum, int device) {
    bool slides = false;
    for (int i = 0; i < 3 && sum->sides != NULL; i++) {
        slides = slides || dalcs_side_means_slides(sum->sides, sum->device[device].mean[i]);
    }
    return slides;
}

void dalcs_losses_sum_finish(struct dalcs_losses_sum *sum) {
    for (int k = 0; k < sum->jump_capacity; k++) {
        free(sum->jump[k].impulse);
    }
    free(sum->jump);
    free(sum->device);
    *sum = (struct dalcs_losses_sum){0};
}

void dalcs_losses_sum_before_start(struct dalcs_losses_sum *sum, const double *value) {
    for (int k = 0; k < sum->circuit->n_devices; k++) {
        const struct dalcs_loss_device *d = &sum->circuit->results.losses->device[k];
        if (d->voltage >= 0) {
            sum->device[k].last[0] = value[d->voltage];
            sum->device[k].last[1] = value[d->current];
        }
    }
    sum->has_last = true;
}

struct dalcs_loss_jump *dalcs_losses_sum_jump(struct dalcs_losses_sum *sum, double time, int n) {
    if (sum->n_jumps > 0 && !sum->is_euler && fabs(sum->jump[0].time - time) > sum->near) {
        sum->n_jumps = 0; /* no stretch has begun there */
    }
    if (sum->n_jumps == sum->jump_capacity) {
        int capacity = 2 * sum->jump_capacity + 4;
        struct dalcs_loss_jump *more =
            realloc(sum->jump, (size_t)capacity * sizeof(*more)); /* grows with parts, not time */
        if (more == NULL) {
            return NULL;
        }
        memset(more + sum->jump_capacity, 0,
               (size_t)(capacity - sum->jump_capacity) * sizeof(*more));
        sum->jump = more;
        sum->jump_capacity = capacity;
    }
    struct dalcs_loss_jump *jump = &sum->jump[sum->n_jumps];
    if (n > jump->capacity) {
        free(jump->impulse);
        jump->impulse = dalcs_alloc((size_t)n, sizeof(*jump->impulse));
        jump->capacity = jump->impulse != NULL ? n : 0;
    }
    jump->n = 0;
    jump->time = time;
    if (n > jump->capacity) {
        return NULL;
    }
    sum->n_jumps++;
    return jump;
}

/* ---- Instants ---------------------------------------------------------------------------------- */

static void switch_by_table(const struct dalcs_losses_sum *sum, int k, bool on) {
    const struct dalcs_losses_card *card = sum->circuit->results.losses;
    struct dalcs_loss *d = &sum->device[k];
    const int table = card->device[k].table[on ? 0 : 1];
    bool clamped = false;
    *(on ? &d->n_on : &d->n_off) += 1;
    if (table >= 0) {
        double volt = fabs(on ? d->last[0] : d->now[0]);
        double ampere = fabs(on ? d->now[1] : d->last[1]);
        d->switching += dalcs_loss_table_at(&card->table[table], volt, ampere, &clamped);
        d->n_clamped += clamped ? 1 : 0;
    }
}

static void add_areas(const struct dalcs_losses_sum *sum, double t) {
    const struct dalcs_circuit *c = sum->circuit;
    if (sum->impulses == NULL || !dalcs_impulses_at(sum->impulses, t)) {
        return;
    }
    for (int k = 0; k < c->n_devices; k++) {
        const struct dalcs_loss_device *of = &c->results.losses->device[k];
        const int measured[2] = {of->voltage, of->current};
        for (int i = 0; i < 2 && of->voltage >= 0; i++) {
            const int signal = c->results.measured[measured[i]];
            const double area = dalcs_impulses_of(sum->impulses, &c->results.signal[signal]);
            sum->device[k].area[i].n += area != 0.0 ? 1 : 0;
            sum->device[k].area[i].sum += sum->is_euler ? 0.0 : area; /* its steps hold it */
            sum->device[k].area[i].size += fabs(area);
        }
    }
}

/* Between the last stretch and the one from time t on. */
static void pass(struct dalcs_losses_sum *sum, double t, const bool *on) {
    bool is_inside = t >= sum->from - sum->near && t < sum->to - sum->near;
    for (int k = 0; k < sum->circuit->n_devices; k++) {
        if (is_inside && sum->knows_sides && on[k] != sum->device[k].is_on) {
            switch_by_table(sum, k, on[k]);
        }
        sum->device[k].is_on = on[k];
    }
    sum->knows_sides = true;
    /* those of times that were passed over are of no stretch; implicit Euler passes none over */
    const bool is_here =
        sum->n_jumps > 0 && (sum->is_euler || fabs(sum->jump[0].time - t) <= sum->near);
    if (is_inside && is_here) {
        add_areas(sum, sum->jump[0].time);
        dalcs_losses_sum_take_jumps(sum);
    }
    sum->n_jumps = 0;
}

/* Without an instant before the start: the stored energy has jumped, and the other entries are
 * unknown. */
static void take_first(struct dalcs_losses_sum *sum) {
    for (int k = 0; k < sum->circuit->n_devices; k++) {
        struct dalcs_loss *d = &sum->device[k];
        d->last[0] = d->now[0];
        d->last[1] = d->now[1];
        if (!isnan(d->first)) {
            d->last[sum->circuit->device[k].kind == DALCS_INDUCTOR ? 1 : 0] = d->first;
        }
    }
}

/* ---- Stretches --------------------------------------------------------------------------------- */

/* A part of a stretch: x from a to b, and its length in s. */
struct cut {
    double a, b, from, length;
};

static void add_fundamental(struct dalcs_loss *d, const struct cut *cut, double theta,
                            double weight, double volt, double ampere, double since) {
    double turn =
        dalcs_two_pi * fmod(d->frequency * (cut->from + theta * cut->length - since), 1.0);
    d->c[0] += weight * volt * cos(turn);
    d->s[0] += weight * volt * sin(turn);
    d->c[1] += weight * ampere * cos(turn);
    d->s[1] += weight * ampere * sin(turn);
}

/* Integrals of v^2, i^2, v i over the cut where the device slides: means over the sides, no products of means. The others, which
 * are products, are left. */
static void take_sides(const struct dalcs_losses_sum *sum, const struct dalcs_stretch_rule *rule,
                       int k, const struct cut *cut, double *product) {
    for (int i = 0; i < 3; i++) {
        const int mean = sum->device[k].mean[i];
        if (dalcs_side_means_slides(sum->sides, mean)) {
            struct dalcs_span span;
            dalcs_side_means_span(sum->sides, mean, rule, cut->from, cut->from + cut->length,
                                  &span);
            product[i] = cut->length * span.coefficient[0];
        }
    }
}

static void add_cut(const struct dalcs_losses_sum *sum, const struct dalcs_stretch *stretch, int k,
                    const struct cut *cut) {
    const struct dalcs_loss_device *of = &sum->circuit->results.losses->device[k];
    const double *v = stretch->coefficient[of->voltage];
    const double *i = stretch->coefficient[of->current];
    bool is_whole = cut->a == -1.0 && cut->b == 1.0;
    struct dalcs_loss *d = &sum->device[k];
    double product[3] = {0.0, 0.0, 0.0}; /* v^2, i^2, v i */
    for (int node = 0; node < N; node++) {
        double theta = 0.5 * (1.0 + stretch->rule->node[node]);
        double x = cut->a + theta * (cut->b - cut->a);
        double volt = is_whole ? stretch->value[of->voltage][node] : dalcs_stretch_at(v, x);
        double ampere = is_whole ? stretch->value[of->current][node] : dalcs_stretch_at(i, x);
        double weight = cut->length * stretch->rule->weight[node];
        d->v += weight * volt;
        product[0] += weight * volt * volt;
        d->i += weight * ampere;
        product[1] += weight * ampere * ampere;
        product[2] += weight * volt * ampere;
        if (d->frequency > 0.0) {
            add_fundamental(d, cut, theta, weight, volt, ampere, sum->from);
        }
    }
    if (sum->sides != NULL) {
        take_sides(sum, stretch->rule, k, cut, product);
    }
    d->v_square += product[0];
    d->i_square += product[1];
    d->energy += product[2];
    d->end[0] = dalcs_stretch_at(v, cut->b);
    d->end[1] = dalcs_stretch_at(i, cut->b);
}

/* Both sides of the instant at which the stretch begins. */
static void enter(struct dalcs_losses_sum *sum, const struct dalcs_stretch *stretch) {
    for (int k = 0; k < sum->circuit->n_devices; k++) {
        const struct dalcs_loss_device *of = &sum->circuit->results.losses->device[k];
        if (of->voltage >= 0) {
            sum->device[k].now[0] = dalcs_stretch_at(stretch->coefficient[of->voltage], -1.0);
            sum->device[k].now[1] = dalcs_stretch_at(stretch->coefficient[of->current], -1.0);
        }
    }
    if (!sum->has_last) {
        take_first(sum);
    }
}

/* The window begins in this stretch: just before what happens where it begins, which counts. */
static void begin(struct dalcs_losses_sum *sum, const struct dalcs_stretch *stretch, double x) {
    const bool is_at_start = stretch->from >= sum->from - sum->near;
    for (int k = 0; k < sum->circuit->n_devices; k++) {
        const struct dalcs_loss_device *of = &sum->circuit->results.losses->device[k];
        struct dalcs_loss *d = &sum->device[k];
        if (of->voltage >= 0) {
            d->begin[0] =
                is_at_start ? d->last[0] : dalcs_stretch_at(stretch->coefficient[of->voltage], x);
            d->begin[1] =
                is_at_start ? d->last[1] : dalcs_stretch_at(stretch->coefficient[of->current], x);
        }
    }
    sum->has_begun = true;
}

void dalcs_losses_sum_stretch(struct dalcs_losses_sum *sum, const struct dalcs_stretch *stretch,
                              const bool *on) {
    const double length = stretch->to - stretch->from;
    const double from = fmax(stretch->from, sum->from);
    const double to = fmin(stretch->to, sum->to);
    const struct cut cut = {
        from > stretch->from ? 2.0 * ((from - stretch->from) / length) - 1.0 : -1.0,
        to < stretch->to ? 2.0 * ((to - stretch->from) / length) - 1.0 : 1.0, from, to - from};
    enter(sum, stretch);
    if (!sum->has_begun && from < to) {
        begin(sum, stretch, cut.a);
    }
    pass(sum, stretch->from, on);
    for (int k = 0; k < sum->circuit->n_devices; k++) {
        const struct dalcs_loss_device *of = &sum->circuit->results.losses->device[k];
        struct dalcs_loss *d = &sum->device[k];
        if (of->voltage < 0) {
            continue;
        }
        if (from < to) {
            add_cut(sum, stretch, k, &cut);
        }
        d->last[0] = dalcs_stretch_at(stretch->coefficient[of->voltage], 1.0);
        d->last[1] = dalcs_stretch_at(stretch->coefficient[of->current], 1.0);
    }
    sum->has_last = true;
}

/* audit_losses.c - sums of losses, checked at times of the auditor's own: of one device in a stretch, its integrals of
 * voltage, current, their squares and their product. The first stretches of the window take one device after the other. */
#include "audit_losses.h"
#include "magnitudes.h"
#include "rounding.h"

#include "audit_reader.h"
#include "claims.h"

#include <float.h>

/* Instructions, about: of a device in a stretch; of a check. */
static const double device_work = 1500.0, check_work = 150000.0;

/* What checks may cost of that. */
static const double share = 0.03;

/* What is asked of a device. */
struct asked {
    const struct dalcs_audit_losses *a;
    const struct dalcs_stretch *stretch;
    int signal[2]; /* measured: voltage, current */
    bool reads[2];
    int which; /* 0 voltage, 1 current, 2 power */
};

static double signal_of(const struct asked *q, int which, double t, double *doubt) {
    const struct dalcs_stretch *s = q->stretch;
    const struct dalcs_circuit *c = &q->a->run->run->s->circuit;
    if (q->reads[which]) {
        return dalcs_audit_signal(q->a->run->audit, c->results.measured[q->signal[which]], t,
                                  t > s->from ? DALCS_LEFT : DALCS_RIGHT, doubt);
    }
    const double *coefficient = s->coefficient[q->signal[which]];
    *doubt = 16.0 * DALCS_STRETCH_NODES * DBL_EPSILON *
             (fabs(coefficient[0]) + dalcs_stretch_spread(coefficient));
    return dalcs_stretch_at(coefficient, 2.0 * ((t - s->from) / (s->to - s->from)) - 1.0);
}

static double value_of(void *user, double t, double *doubt) {
    const struct asked *q = user;
    double off[2];
    if (q->which < 2) {
        const double value = signal_of(q, q->which, t, &off[0]);
        if (doubt != NULL) {
            *doubt = off[0];
        }
        return value;
    }
    const double v = signal_of(q, 0, t, &off[0]);
    const double i = signal_of(q, 1, t, &off[1]);
    if (doubt != NULL) {
        *doubt = fabs(v) * off[1] + fabs(i) * off[0];
    }
    return v * i;
}

static bool can_read(const struct dalcs_audit_losses *a, const struct dalcs_stretch *s,
                     int signal) {
    const struct dalcs_audit_run *run = a->run;
    const int part = dalcs_audit_part_of(run->audit, run->run->s->circuit.results.measured[signal]);
    return part >= 0 && run->radau->part[part].kind == DALCS_PART_STEPPED &&
           (s->to - s->from) * dalcs_audit_most_allowed(run) > 4.0 * DBL_EPSILON * s->to;
}

static int next_device(const struct dalcs_losses_sum *sum, int from) {
    const struct dalcs_circuit *c = sum->circuit;
    int k = from;
    while (k < c->n_devices && c->results.losses->device[k].voltage < 0) {
        k++;
    }
    return k;
}

void dalcs_audit_losses_begin(struct dalcs_audit_losses *a, const struct dalcs_losses_sum *sum,
                              const struct dalcs_stretch *stretch) {
    a->device = -1;
    if (a->run == NULL || !(fmax(stretch->from, sum->from) < fmin(stretch->to, sum->to))) {
        return;
    }
    const int n = sum->circuit->n_devices;
    const bool is_full = a->run->run->options->audit == DALCS_AUDIT_FULL;
    a->n_looked = next_device(sum, a->n_looked);
    a->credit += share * device_work * n;
    if (a->n_looked < n) {
        a->device = a->n_looked++;
    } else if (is_full || a->credit >= a->threshold) {
        const int k = next_device(sum, (int)(dalcs_audit_run_chance(a->run) * n));
        a->device = k < n ? k : -1;
        a->threshold = 2.0 * check_work * dalcs_audit_run_chance(a->run);
    }
    if (a->device >= 0) {
        a->before = sum->device[a->device];
        a->credit -= check_work;
        dalcs_audit_forget_asked(a->run->audit);
    }
}

/* The scale of a signal: its largest value so far, if the auditor has it, else in the stretch. */
static double scale_of(const struct dalcs_audit_losses *a, const struct dalcs_stretch *s,
                       int signal) {
    const double *coefficient = s->coefficient[signal];
    const double largest = fabs(coefficient[0]) + dalcs_stretch_spread(coefficient);
    const int index = a->run->run->s->circuit.results.measured[signal];
    return fmax(largest, dalcs_audit_signal_scale(a->run->audit, index));
}

/* J that a device takes by its own law, where that tells it from the other integrals; NAN: it does not. On each side of a slide a
 * switch obeys (v - ron i)(v - roff i) = 0, so that the means of v^2, v i and i^2 do. */
static double energy_by_law(const struct dalcs_circuit *c, int k, const struct dalcs_loss *added) {
    const struct dalcs_device *d = &c->device[k];
    if (d->kind == DALCS_RESISTOR) {
        return d->value * added->i_square;
    }
    if (d->kind == DALCS_SWITCH && d->model >= 0) {
        const struct dalcs_switch_model *m = &c->models.of_switch[d->model];
        return isinf(m->roff)
                   ? m->ron * added->i_square
                   : (added->v_square + m->ron * m->roff * added->i_square) / (m->ron + m->roff);
    }
    if (d->kind == DALCS_DIODE) {
        const struct dalcs_diode_model *m = &c->models.of_diode[d->model];
        const bool is_plain = isinf(m->roff) && isinf(m->vrev) && m->exponential.voltage == 0.0;
        return is_plain ? m->vfwd * added->i + m->ron * added->i_square : (double)NAN;
    }
    return NAN;
}

/* In a slide the auditor knows means of signals alone, of which no power is made: the integrals are held to each other. */
static void check_sides(const struct dalcs_audit_losses *a, const struct dalcs_losses_sum *sum,
                        double from, double to) {
    const struct dalcs_loss *now = &sum->device[a->device], *then = &a->before;
    const struct dalcs_loss added = {.v_square = now->v_square - then->v_square,
                                     .i = now->i - then->i,
                                     .i_square = now->i_square - then->i_square,
                                     .energy = now->energy - then->energy};
    const struct dalcs_audit_sum own = {
        energy_by_law(sum->circuit, a->device, &added),
        4.0 * DBL_EPSILON * (fabs(now->energy) + sqrt(now->v_square) * sqrt(now->i_square))};
    const double scale =
        sqrt(fmax(added.v_square, 0.0)) * sqrt(fmax(added.i_square, 0.0)) / (to - from);
    const struct dalcs_audit_number number = {DALCS_AUDIT_LOSSES, a->device, scale};
    const struct dalcs_audit_claim told = {1, from, to, added.energy};
    if (!isnan(own.value)) {
        dalcs_audit_claim_part(a->run->audit, &number, &told, &own);
    }
}

void dalcs_audit_losses_end(struct dalcs_audit_losses *a, const struct dalcs_losses_sum *sum,
                            const struct dalcs_stretch *stretch) {
    if (a->device < 0) {
        return;
    }
    const struct dalcs_loss_device *of = &sum->circuit->results.losses->device[a->device];
    const struct dalcs_loss *now = &sum->device[a->device], *then = &a->before;
    const double from = fmax(stretch->from, sum->from);
    const double to = fmin(stretch->to, sum->to);
    const double volt = scale_of(a, stretch, of->voltage);
    const double ampere = scale_of(a, stretch, of->current);

    const struct {
        int which, power;
        double now, then, scale;
    } claim[] = {{0, 1, now->v, then->v, volt},
                 {0, 2, now->v_square, then->v_square, volt},
                 {1, 1, now->i, then->i, ampere},
                 {1, 2, now->i_square, then->i_square, ampere},
                 {2, 1, now->energy, then->energy, volt * ampere}};

    const bool slides = dalcs_losses_sum_slides(sum, a->device);
    if (slides) {
        check_sides(a, sum, from, to);
    }
    for (size_t k = 0; k < sizeof claim / sizeof claim[0]; k++) {
        if (slides && (claim[k].which == 2 || claim[k].power == 2)) {
            continue;
        }
        struct asked q = {a,
                          stretch,
                          {of->voltage, of->current},
                          {can_read(a, stretch, of->voltage), can_read(a, stretch, of->current)},
                          claim[k].which};
        const struct dalcs_audit_function f = {&q, value_of};
        struct dalcs_audit_sum own =
            dalcs_audit_integral(a->run->audit, &f, claim[k].power, from, to);
        own.doubt += 4.0 * DBL_EPSILON * (fabs(claim[k].now) + fabs(claim[k].then));
        const struct dalcs_audit_number number = {DALCS_AUDIT_LOSSES, a->device, claim[k].scale};
        const struct dalcs_audit_claim told = {claim[k].power, from, to,
                                               claim[k].now - claim[k].then};
        dalcs_audit_claim_part(a->run->audit, &number, &told, &own);
    }
}

/* ---- What is told ---------------------------------------------------------------------------------- */

/* So much is told, and is so much, of a number of this size. */
static double part_off(double told, double is, double size) {
    const double off = fabs(told - is) - dalcs_sum_rounded * (fabs(told) + fabs(is) + size);
    return off > 0.0 ? off / fmax(fmax(fabs(is), size), 0x1p-1022) : 0.0;
}

/* J in a capacitor of its own. */
static double stored(const struct dalcs_device *d, const double *own) {
    return 0.5 * d->value * own[0] * own[0];
}

void dalcs_audit_losses_told(const struct dalcs_audit_losses *a, const struct dalcs_losses_sum *sum,
                             int k, const struct dalcs_element_losses *told) {
    if (a->run == NULL) {
        return;
    }
    const struct dalcs_circuit *c = sum->circuit;
    const struct dalcs_device *d = &c->device[k];
    const struct dalcs_loss *l = &sum->device[k];
    const double length =
        fmin(c->results.losses->to, a->run->radau->options.stop) - c->results.losses->from;
    double worst = part_off(told->v_average * length, l->v + l->area[0].sum, 0.0);
    worst = fmax(worst, part_off(told->v_rms * told->v_rms * length, l->v_square, 0.0));
    worst = fmax(worst, part_off(told->i_average * length, l->i + l->area[1].sum, 0.0));
    worst = fmax(worst, part_off(told->i_rms * told->i_rms * length, l->i_square, 0.0));
    if (d->kind == DALCS_CAPACITOR) {
        const double change = stored(d, l->end) - stored(d, l->begin);
        const double size = stored(d, l->end) + stored(d, l->begin);
        worst = fmax(worst, part_off(told->power * length, change, size));
    } else if (d->kind != DALCS_INDUCTOR && !d->is_storage && !d->is_transformer) {
        worst = fmax(worst, part_off(told->power * length, l->energy + l->jump,
                                     sqrt(l->v_square) * sqrt(l->i_square)));
    }
    dalcs_audit_add_to(a->run->audit, DALCS_AUDIT_LOSSES, k, worst, sum->to);
}

/* ---- Laws of means -------------------------------------------------------------------------------- */

/* What is told of a run, with the largest V and A of means: what is rounding of them is no defect. */
struct means {
    const struct dalcs_audit_losses *a;
    const struct dalcs_losses_sum *sum;
    const struct dalcs_element_losses *told; /* of the next device that is told of */
    double length, largest[2];
};

static double scale_of_probe(const struct means *m, const struct dalcs_probe *probe) {
    double scale = 0.0;
    for (int i = 0; probe->system >= 0 && i < probe->n_terms; i++) {
        const struct dalcs_radau_part *part = &m->a->run->radau->part[probe->system];
        const double largest =
            part->kind == DALCS_PART_STEPPED ? part->scales.column[probe->term[i].index] : 0.0;
        scale += fabs(probe->term[i].coefficient) * largest;
    }
    return scale;
}

static double scale_in_run(const struct means *m, int signal) {
    const struct dalcs_output *out =
        &m->a->run->run->s->network.output[m->sum->circuit->results.measured[signal]];
    return scale_of_probe(m, &out->plus) + scale_of_probe(m, &out->minus);
}

static double off_mean(const struct means *m, int unit, double told, double is, double size) {
    const bool is_rounding =
        fabs(told - is) <= dalcs_beyond * dalcs_answer_rounded * m->largest[unit];
    return is_rounding ? 0.0 : part_off(told, is, size);
}

/* Over any window the charge of a capacitor changes by the integral of its current, and the flux of a coil on its own by
 * that of its voltage: impulses included. */
static double off_storage(const struct means *m, int k, const struct dalcs_element_losses *told) {
    const struct dalcs_device *d = &m->sum->circuit->device[k];
    const struct dalcs_loss *l = &m->sum->device[k];
    const struct dalcs_loss_device *of = &m->sum->circuit->results.losses->device[k];
    const int own = d->kind == DALCS_CAPACITOR ? 0 : 1;
    const double square = own == 0 ? l->i_square : l->v_square;
    const double is = d->value * (l->end[own] - l->begin[own]) / m->length;
    const int state = own == 0 ? of->voltage : of->current;
    const int driven = own == 0 ? of->current : of->voltage;
    const double size = d->value * scale_in_run(m, state) / m->length + sqrt(square / m->length) +
                        l->area[1 - own].size / m->length + scale_in_run(m, driven);
    return off_mean(m, 1 - own, own == 0 ? told->i_average : told->v_average, is, size);
}

static bool is_coupled(const struct dalcs_circuit *c, int k) {
    bool is = false;
    for (int j = 0; j < c->n_couplings && !is; j++) {
        is = c->coupling[j].inductor[0] == k || c->coupling[j].inductor[1] == k;
    }
    return is;
}

/* Of rms values, and of the means that all charge of a capacitor, all flux of a coil makes. */
static void raise_largest(struct means *m, int k) {
    const struct dalcs_device *d = &m->sum->circuit->device[k];
    const struct dalcs_loss_device *of = &m->sum->circuit->results.losses->device[k];
    const struct dalcs_loss *l = &m->sum->device[k];
    m->largest[0] = fmax(m->largest[0], sqrt(l->v_square / m->length));
    m->largest[1] = fmax(m->largest[1], sqrt(l->i_square / m->length));
    if (of->voltage >= 0 && d->kind == DALCS_CAPACITOR) {
        m->largest[1] = fmax(m->largest[1], d->value * scale_in_run(m, of->voltage) / m->length);
    } else if (of->voltage >= 0 && d->kind == DALCS_INDUCTOR) {
        m->largest[0] = fmax(m->largest[0], d->value * scale_in_run(m, of->current) / m->length);
    }
}

static void add_means(const struct dalcs_audit_losses *a, struct means *m, double *leaves,
                      double *size, int k) {
    const struct dalcs_circuit *c = m->sum->circuit;
    const struct dalcs_device *d = &c->device[k];
    const bool is_told = c->results.losses->device[k].voltage >= 0;
    const bool stores =
        d->kind == DALCS_CAPACITOR || (d->kind == DALCS_INDUCTOR && !is_coupled(c, k));
    const double i = is_told ? m->told->i_average : (double)NAN;
    const double i_size = is_told ? m->sum->device[k].area[1].size / m->length +
                                        sqrt(m->sum->device[k].i_square / m->length) +
                                        scale_in_run(m, c->results.losses->device[k].current)
                                  : 0.0;
    if (is_told && stores) {
        dalcs_audit_add_to(a->run->audit, DALCS_AUDIT_LOSSES, k, off_storage(m, k, m->told),
                           m->sum->to);
    }
    for (int side = 0; side < 2; side++) {
        leaves[d->node[side]] += side == 0 ? i : -i;
        size[d->node[side]] += i_size;
    }
    m->told += is_told ? 1 : 0;
}

/* By Kirchhoff's law the mean currents that leave a node add up to 0, where all its elements are told of. */
void dalcs_audit_losses_laws(const struct dalcs_audit_losses *a, const struct dalcs_losses_sum *sum,
                             const struct dalcs_element_losses *told, double *work) {
    const struct dalcs_circuit *c = sum->circuit;
    double *leaves = work, *size = work + c->n_nodes;
    struct means m = {.a = a, .sum = sum, .told = told, .length = sum->to - sum->from};
    if (a->run == NULL) {
        return;
    }
    for (int k = 0; k < c->n_devices; k++) {
        raise_largest(&m, k);
    }
    for (int k = 0; k < c->n_devices; k++) {
        add_means(a, &m, leaves, size, k);
    }
    for (int n = 0; n < c->n_nodes; n++) {
        if (!isnan(leaves[n])) {
            dalcs_audit_add_to(a->run->audit, DALCS_AUDIT_LOSSES, 0,
                               off_mean(&m, 1, leaves[n], 0.0, size[n]), sum->to);
        }
    }
}

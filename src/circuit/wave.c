/* wave.c - functions of time alone: damped sinusoids, straight lines and steps become stimuli. */
#include "behaviour.h"
#include "pi.h"

#include <math.h>

/* A time that no run reaches: where a straight line that never ends is said to. */
static const double never = 0x1p40;

static bool is_noise(const struct dalcs_wave *wave) {
    return wave->shape == DALCS_HELD_NOISE || wave->shape == DALCS_LINEAR_NOISE;
}

static int add_wave(struct dalcs_compiler *c, struct dalcs_wave wave) {
    wave.phase -= is_noise(&wave) ? 0 : floor(wave.phase);
    for (size_t k = 0; k < c->n_waves; k++) {
        const struct dalcs_wave *known = &c->wave[k];
        if (known->shape == wave.shape && known->decay == wave.decay &&
            known->frequency == wave.frequency && known->phase == wave.phase &&
            known->delay == wave.delay) {
            return (int)k;
        }
    }
    if (c->failed ||
        dalcs_grow(&c->wave, &c->wave_capacity, c->n_waves + 1, sizeof *c->wave) != DALCS_OK) {
        c->builder->out_of_memory = c->builder->out_of_memory || !c->failed;
        c->failed = true;
        return -1;
    }
    c->wave[c->n_waves] = wave;
    return (int)c->n_waves++;
}

static double sin_of_cycles(double x) {
    const double r = x - floor(x);
    const double quarters[] = {0, 1, 0, -1};
    return r * 4 == floor(r * 4) ? quarters[(int)(r * 4)] : sin(2 * dalcs_pi * r);
}

const struct dalcs_form *dalcs_wave_value(struct dalcs_compiler *c, const struct dalcs_wave *wave) {
    struct dalcs_wave w = *wave;
    double sign = 1;
    if (w.shape == DALCS_SINE && w.frequency < 0) { /* sin(-x) = -sin(x) */
        w.frequency = -w.frequency;
        w.phase = -w.phase;
        sign = -1;
    }
    if (w.shape == DALCS_SINE && w.frequency == 0) {
        sign *= sin_of_cycles(w.phase);
        w.phase = 0.25;
    }
    if (w.frequency == 0 && w.decay == 0 && w.delay == 0 && !is_noise(&w)) {
        return dalcs_form_number(c, sign);
    }
    const int index = add_wave(c, w);
    const struct dalcs_affine of = dalcs_affine_of(c, DALCS_QUANTITY_WAVE, index);
    return dalcs_form_scale(c, sign, dalcs_form_affine(c, &of));
}

/* 2 sin(x) sin(y) = cos(x - y) - cos(x + y), in cycles. */
bool dalcs_wave_multiply(struct dalcs_compiler *c, int a, int b,
                         const struct dalcs_form **product) {
    const struct dalcs_wave x = c->wave[a];
    const struct dalcs_wave y = c->wave[b];
    const struct dalcs_wave difference = {.decay = x.decay + y.decay,
                                          .frequency = x.frequency - y.frequency,
                                          .phase = x.phase - y.phase + 0.25};
    const struct dalcs_wave sum = {.decay = x.decay + y.decay,
                                   .frequency = x.frequency + y.frequency,
                                   .phase = x.phase + y.phase + 0.25};
    if (x.shape != DALCS_SINE || y.shape != DALCS_SINE || x.delay != 0 || y.delay != 0) {
        return false;
    }
    *product = dalcs_form_scale(c, 0.5, dalcs_wave_value(c, &difference));
    *product = dalcs_form_add(c, *product, -0.5, dalcs_wave_value(c, &sum));
    return true;
}

int dalcs_wave_delayed(struct dalcs_compiler *c, int wave, double delay) {
    struct dalcs_wave later = c->wave[wave];
    if (later.decay != 0 || later.shape != DALCS_SINE) {
        return -1;
    }
    later.delay = fmax(later.delay, delay);
    return add_wave(c, later);
}

int dalcs_compiler_add_stimulus(struct dalcs_compiler *c, const struct dalcs_stimulus *stimulus) {
    if (c->failed || dalcs_grow(&c->stimulus, &c->stimulus_capacity, c->n_stimuli + 1,
                                sizeof *c->stimulus) != DALCS_OK) {
        c->builder->out_of_memory = c->builder->out_of_memory || !c->failed;
        c->failed = true;
        return -1;
    }
    c->stimulus[c->n_stimuli] = *stimulus;
    return c->builder->circuit->n_stimuli + (int)c->n_stimuli++;
}

int dalcs_wave_stimulus(struct dalcs_compiler *c, int wave) {
    const struct dalcs_wave *w = &c->wave[wave];
    if (is_noise(w)) {
        return dalcs_noise_stimulus(c, w);
    }
    struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_SIN};
    if (w->shape != DALCS_SINE) {
        const double period = 1 / w->frequency;
        const double rise = w->shape == DALCS_SAWTOOTH ? period : period / 2;
        s = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_PULSE,
                                    .u.pulse = {.high = 1,
                                                .delay = -w->phase * period,
                                                .rise = rise,
                                                .fall = period - rise,
                                                .period = period}};
    } else if (w->decay == 0) {
        struct dalcs_tone *tone = dalcs_arena_alloc(&c->builder->circuit->arena, 1, sizeof *tone);
        if (tone == NULL) {
            c->builder->out_of_memory = true;
            c->failed = true;
            return -1;
        }
        const double phase = w->phase + w->frequency * w->delay;
        *tone = (struct dalcs_tone){1, w->frequency, phase - floor(phase)};
        s = (struct dalcs_stimulus){
            .kind = DALCS_STIMULUS_TONES,
            .u.tones = {.delay = w->delay, .n = 1, .tone = tone},
        };
    } else {
        s.u.sine.amplitude = 1;
        s.u.sine.frequency = w->frequency;
        s.u.sine.damping = w->decay;
        s.u.sine.phase = 360 * w->phase;
    }
    return dalcs_compiler_add_stimulus(c, &s);
}

int dalcs_time_stimulus(struct dalcs_compiler *c, const struct dalcs_piecewise *f) {
    struct dalcs_arena *arena = &c->builder->circuit->arena;
    const size_t n = 2 * (size_t)f->n + 2;
    double *t = dalcs_arena_alloc(arena, n, sizeof *t);
    double *v = dalcs_arena_alloc(arena, n, sizeof *v);
    if (t == NULL || v == NULL) {
        c->builder->out_of_memory = true;
        c->failed = true;
        return -1;
    }
    int used = 0;
    v[used++] = dalcs_piecewise_at(f, 0, 1);
    for (int k = 0; k < f->n; k++) {
        const struct dalcs_knot *knot = &f->knot[k];
        for (int side = 0; side < 2 && knot->at > 0; side++) {
            if (side == 0 || knot->right != knot->left) {
                t[used] = knot->at;
                v[used++] = side == 0 ? knot->left : knot->right;
            }
        }
    }
    if (f->after != 0) {
        t[used] = never;
        v[used] = dalcs_piecewise_at(f, never, 1);
        used++;
    }
    const struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_PWL,
                                     .u.pwl = {.n = used, .t = t, .v = v}};
    return dalcs_compiler_add_stimulus(c, &s);
}

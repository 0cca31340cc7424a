/* source_products.c - pieces of sources as sums of exponentials with complex rates. */
#include "source_products.h"

#include <complex.h>
#include <math.h>

enum { SERIES = 24 };

/* A term as Re(amplitude exp(-rate tau)). */
struct wave {
    double complex amplitude, rate;
};

static struct wave wave_of(const struct dalcs_stimulus_term *term) {
    return (struct wave){.amplitude = term->cosine + I * term->sine,
                         .rate = term->decay + I * term->omega};
}

/* Integral of exp(-rate tau) over 0..T, without loss where the exponent is small. */
static double complex integral_of_exp(double complex rate, double T) {
    double a = creal(rate) * T;
    double b = cimag(rate) * T;
    if (a == 0.0 && b == 0.0) {
        return T;
    }
    double half = sin(0.5 * b);
    double re = -expm1(-a) + exp(-a) * 2.0 * half * half;
    double im = exp(-a) * sin(b);
    return (re + I * im) / rate;
}

/* Integral of tau exp(-rate tau) over 0..T. A series is exact up to an exponent of 1: its last term is 1/25!. */
static double complex integral_of_ramp(double complex rate, double T) {
    double complex w = rate * T;
    if (cabs(w) >= 1.0) {
        return (integral_of_exp(rate, T) - T * cexp(-w)) / rate;
    }
    double complex power = 1.0;
    double complex sum = 0.0;
    for (int k = 0; k < SERIES; k++) {
        sum += power / (k + 2);
        power *= -w / (k + 1);
    }
    return T * T * sum;
}

static double lines_with_waves(const struct dalcs_stimulus_piece *line,
                               const struct dalcs_stimulus_piece *waves, double T) {
    double sum = 0.0;
    for (int k = 0; k < waves->n_terms; k++) {
        struct wave w = wave_of(&waves->term[k]);
        sum += w.amplitude == 0.0 || (line->level == 0.0 && line->slope == 0.0)
                   ? 0.0
                   : creal(w.amplitude * (line->level * integral_of_exp(w.rate, T) +
                                          line->slope * integral_of_ramp(w.rate, T)));
    }
    return sum;
}

static double waves_with_waves(const struct dalcs_stimulus_piece *a,
                               const struct dalcs_stimulus_piece *b, double T) {
    double sum = 0.0;
    for (int i = 0; i < a->n_terms; i++) {
        for (int k = 0; k < b->n_terms; k++) {
            struct wave v = wave_of(&a->term[i]);
            struct wave w = wave_of(&b->term[k]);
            if (v.amplitude == 0.0 || w.amplitude == 0.0) {
                continue;
            }
            double complex with = v.amplitude * w.amplitude * integral_of_exp(v.rate + w.rate, T);
            double complex against =
                v.amplitude * conj(w.amplitude) * integral_of_exp(v.rate + conj(w.rate), T);
            sum += 0.5 * creal(with + against);
        }
    }
    return sum;
}

static double integral_of_product(const struct dalcs_stimulus_piece *a,
                                  const struct dalcs_stimulus_piece *b, double T) {
    double lines =
        T * (a->level * b->level +
             T * (0.5 * (a->level * b->slope + a->slope * b->level) + T * a->slope * b->slope / 3));
    return lines + lines_with_waves(a, b, T) + lines_with_waves(b, a, T) +
           waves_with_waves(a, b, T);
}

void dalcs_source_products(int n, const struct dalcs_stimulus *const *stimulus, double stop,
                           struct dalcs_stimulus_piece *piece, double *integral) {
    for (int i = 0; i < n * n; i++) {
        integral[i] = 0.0;
    }
    for (double t = 0.0; t < stop;) {
        double next = stop;
        for (int i = 0; i < n; i++) {
            dalcs_stimulus_piece_at(stimulus[i], t, &piece[i]);
            next = fmin(next, piece[i].to);
        }
        for (int i = 0; i < n; i++) {
            for (int j = 0; j <= i; j++) {
                integral[i * n + j] += integral_of_product(&piece[i], &piece[j], next - t);
            }
        }
        t = next;
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < i; j++) {
            integral[j * n + i] = integral[i * n + j];
        }
    }
}

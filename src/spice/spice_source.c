/* spice_source.c - functions of time in ngspice's words.
 *
 * ngspice has no edge without width: given a rise time of 0 it takes tstep. A short ramp centred on the
 * edge stands for it; where that would begin before time 0 it begins there. */
#include "rounding.h"
#include "spice.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

void dalcs_spice_write_number(FILE *stream, double value) {
    char text[32];
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) {
            break;
        }
    }
    fputs(text, stream);
}

static void write_numbers(FILE *stream, const char *name, int n, const double *value) {
    fputs(name, stream);
    for (int i = 0; i < n; i++) {
        fputc(i == 0 ? '(' : ' ', stream);
        dalcs_spice_write_number(stream, value[i]);
    }
    fputc(')', stream);
}

struct pulse {
    double low, high, delay, rise, fall, width, period;
};

static void widen_edges(struct pulse *p, double edge) {
    double rest = p->period - p->rise - p->width - p->fall;
    edge = fmin(edge, 0.1 * fmin(p->width, rest > 0.0 ? rest : p->width));
    double rise = p->rise > 0.0 ? 0.0 : edge;
    double fall = p->fall > 0.0 ? 0.0 : edge;
    double early = p->delay < 0.0 ? 0.5 * rise : fmin(0.5 * rise, p->delay); /* begun before 0 */
    p->delay -= early;
    p->width -= (rise - early) + 0.5 * fall;
    p->rise += rise;
    p->fall += fall;
}

static const char *write_pulse(FILE *stream, const struct dalcs_stimulus *s, double edge,
                               double stop) {
    struct pulse p = {s->u.pulse.low,  s->u.pulse.high,  s->u.pulse.delay, s->u.pulse.rise,
                      s->u.pulse.fall, s->u.pulse.width, s->u.pulse.period};
    if (p.rise + p.width + p.fall > p.period * (1.0 + dalcs_rounded)) {
        return "PULSE longer than its period";
    }
    widen_edges(&p, edge);
    if (!(p.rise > 0.0 && p.fall > 0.0)) {
        return "PULSE without width";
    }
    double for_ever = 4.0 * (stop + p.delay + p.rise + p.fall);
    p.width = isinf(p.width) ? for_ever : p.width;
    p.period = isinf(p.period) ? p.width + 2.0 * for_ever : p.period;
    const double value[] = {p.low,  p.high,  p.delay,  p.rise,
                            p.fall, p.width, p.period, s->u.pulse.n_periods};
    write_numbers(stream, "PULSE", s->u.pulse.n_periods > 0.0 ? 8 : 7, value);
    return NULL;
}

/* A jump's points lie on either side of it; but where the repeated part begins with it, its second
 * point stays, so that the period is exact. */
static void write_points(FILE *stream, const struct dalcs_stimulus *s, double edge) {
    int n = s->u.pwl.n;
    const double *t = s->u.pwl.t, *v = s->u.pwl.v;
    for (int i = 0; i < n; i++) {
        bool jumps_next = i + 1 < n && t[i + 1] == t[i], jumped = i > 0 && t[i - 1] == t[i];
        double before = i > 0 ? t[i] - t[i - 1] : t[i];
        double after = i + 1 < n ? t[i + 1] - t[i] : INFINITY;
        double half = fmin(0.5 * edge, 0.1 * (jumps_next ? before : after));
        bool stays = s->u.pwl.repeats && t[i] == s->u.pwl.repeat_from;
        double time = jumps_next ? t[i] - (stays ? 2.0 * half : half)
                                 : t[i] + (jumped && !stays ? half : 0.0);
        fputs(i == 0 ? "(" : i % 8 == 0 ? "\n+ " : " ", stream);
        dalcs_spice_write_number(stream, time);
        fputc(' ', stream);
        dalcs_spice_write_number(stream, v[i]);
    }
    fputc(')', stream);
}

static const char *write_pwl(FILE *stream, const struct dalcs_stimulus *s, double edge) {
    int n = s->u.pwl.n;
    if (n > 1 && s->u.pwl.repeats && s->u.pwl.t[1] == 0.0 && s->u.pwl.repeat_from == 0.0) {
        return "PWL that jumps at time 0 and repeats from there";
    }
    for (int i = 2; i < n; i++) {
        if (s->u.pwl.t[i] == s->u.pwl.t[i - 2]) {
            return "PWL with three points at one time";
        }
    }
    fputs("PWL", stream);
    write_points(stream, s, edge);
    if (s->u.pwl.repeats) {
        fputs(" r=", stream);
        dalcs_spice_write_number(stream, s->u.pwl.repeat_from);
    }
    return NULL;
}

bool dalcs_spice_needs_expression(const struct dalcs_stimulus *s) {
    return s->kind == DALCS_STIMULUS_TONES ||
           (s->kind == DALCS_STIMULUS_SIN && s->u.sine.n_cycles > 0.0);
}

const char *dalcs_spice_write_source(FILE *stream, const struct dalcs_stimulus *s, double edge,
                                     double stop) {
    switch (s->kind) {
    case DALCS_STIMULUS_DC:
        dalcs_spice_write_number(stream, s->dc);
        return NULL;
    case DALCS_STIMULUS_PULSE:
        return write_pulse(stream, s, edge, stop);
    case DALCS_STIMULUS_PWL:
        return write_pwl(stream, s, edge);
    case DALCS_STIMULUS_SIN: {
        const double value[] = {s->u.sine.offset, s->u.sine.amplitude, s->u.sine.frequency,
                                s->u.sine.delay,  s->u.sine.damping,   s->u.sine.phase};
        write_numbers(stream, "SIN", 6, value);
        return NULL;
    }
    case DALCS_STIMULUS_EXP: {
        double never = s->u.exponential.rise_delay + 4.0 * stop;
        const double value[] = {s->u.exponential.low,
                                s->u.exponential.high,
                                s->u.exponential.rise_delay,
                                fmax(s->u.exponential.rise_tau, 0.1 * edge),
                                fmin(s->u.exponential.fall_delay, never),
                                fmax(s->u.exponential.fall_tau, 0.1 * edge)};
        write_numbers(stream, "EXP", 6, value);
        return NULL;
    }
    case DALCS_STIMULUS_TONES:
    case DALCS_STIMULUS_FORMULA:
    case DALCS_STIMULUS_DELAYED:
        break; /* an expression */
    }
    return NULL;
}

static void write_sine(FILE *stream, const struct dalcs_stimulus *s) {
    dalcs_spice_write_number(stream, s->u.sine.offset);

    const struct {
        const char *before;
        double value;
    } part[] = {{"+(", s->u.sine.amplitude},
                {")*exp(-(", s->u.sine.damping},
                {")*min(max(time-(", s->u.sine.delay},
                {"),0),", s->u.sine.n_cycles / s->u.sine.frequency},
                {"))*sin(2*pi*", s->u.sine.frequency},
                {"*min(max(time-(", s->u.sine.delay},
                {"),0),", s->u.sine.n_cycles / s->u.sine.frequency},
                {")+(", s->u.sine.phase},
                {")*pi/", 180.0}};

    for (size_t i = 0; i < sizeof part / sizeof part[0]; i++) {
        fputs(part[i].before, stream);
        dalcs_spice_write_number(stream, part[i].value);
    }
    fputc(')', stream);
}

static void write_tones(FILE *stream, const struct dalcs_stimulus *s) {
    fputs("time<", stream);
    dalcs_spice_write_number(stream, s->u.tones.delay);
    fputs(" ? 0 : ", stream);
    dalcs_spice_write_number(stream, s->u.tones.offset);
    for (int i = 0; i < s->u.tones.n; i++) {
        const struct dalcs_tone *tone = &s->u.tones.tone[i];
        fputs("\n+ +(", stream);
        dalcs_spice_write_number(stream, tone->amplitude);
        fputs(")*sin(2*pi*((", stream);
        dalcs_spice_write_number(stream, tone->frequency);
        fputs(")*(time-(", stream);
        dalcs_spice_write_number(stream, s->u.tones.delay);
        fputs("))+(", stream);
        dalcs_spice_write_number(stream, tone->phase);
        fputs(")))", stream);
    }
}

void dalcs_spice_write_expression(FILE *stream, const struct dalcs_stimulus *s) {
    if (s->kind == DALCS_STIMULUS_TONES) {
        write_tones(stream, s);
    } else {
        write_sine(stream, s);
    }
}

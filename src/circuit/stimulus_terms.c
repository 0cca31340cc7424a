/* stimulus_terms.c - a stimulus between two edges as a sum of terms in time. */
#include "stimulus_kinds.h"

#include "formula_stimulus.h"
#include "history.h"
#include "pi.h"

#include <math.h>

static void sine_term(const struct dalcs_stimulus *s, double since,
                      struct dalcs_stimulus_term *term) {
    const double cycles = dalcs_sine_cycles(s, since);
    double amplitude = s->u.sine.amplitude;
    amplitude *= s->u.sine.damping != 0 ? exp(-s->u.sine.damping * since) : 1;
    *term = (struct dalcs_stimulus_term){.decay = s->u.sine.damping,
                                         .omega = 2 * dalcs_pi * s->u.sine.frequency,
                                         .cosine = amplitude * dalcs_sine_of_cycles(cycles),
                                         .sine = amplitude * dalcs_sine_of_cycles(cycles + 0.25)};
}

static bool sine_is_over(const struct dalcs_stimulus *s, double t) {
    return t - s->u.sine.delay >= dalcs_sine_length(s) - dalcs_stimulus_tolerance(t, 0);
}

static void sine_piece(const struct dalcs_stimulus *s, double t,
                       struct dalcs_stimulus_piece *piece) {
    if (piece->to == s->u.sine.delay || sine_is_over(s, t)) {
        piece->level = dalcs_sine_value(s, t);
        *piece->term = (struct dalcs_stimulus_term){.decay = s->u.sine.damping,
                                                    .omega = 2 * dalcs_pi * s->u.sine.frequency};
        return;
    }
    piece->level = s->u.sine.offset;
    sine_term(s, t - s->u.sine.delay, piece->term);
}

static void exponential_piece(const struct dalcs_stimulus *s, double t,
                              struct dalcs_stimulus_piece *piece) {
    const double delay[2] = {s->u.exponential.rise_delay, s->u.exponential.fall_delay};
    const double tau[2] = {s->u.exponential.rise_tau, s->u.exponential.fall_tau};
    piece->level = s->u.exponential.low;
    for (int k = 0; k < 2; k++) {
        const double near = dalcs_stimulus_tolerance(t, 0);
        double height = s->u.exponential.high - s->u.exponential.low;
        height = k == 0 ? height : -height;
        const bool is_jump = tau[k] <= near;
        piece->term[k] = (struct dalcs_stimulus_term){.decay = is_jump ? 0 : 1 / tau[k]};
        if (t >= delay[k] - near) {
            piece->level += height;
            piece->term[k].cosine = is_jump ? 0 : -height * exp(-fmax(t - delay[k], 0) / tau[k]);
        }
    }
}

static void tones_piece(const struct dalcs_stimulus *s, double t,
                        struct dalcs_stimulus_piece *piece) {
    const bool have_begun = dalcs_tones_have_begun(s, t, DALCS_RIGHT);
    piece->level = have_begun ? s->u.tones.offset : 0;
    for (int k = 0; k < s->u.tones.n; k++) {
        const struct dalcs_tone *tone = &s->u.tones.tone[k];
        const double amplitude = have_begun ? tone->amplitude : 0;
        const double cycles =
            dalcs_sine_cycles_at(tone->frequency, t - s->u.tones.delay, tone->phase);
        piece->term[k] = (struct dalcs_stimulus_term){
            .omega = 2 * dalcs_pi * tone->frequency,
            .cosine = amplitude * dalcs_sine_of_cycles(cycles),
            .sine = amplitude * dalcs_sine_of_cycles(cycles + 0.25),
        };
    }
}

int dalcs_stimulus_n_terms(const struct dalcs_stimulus *s) {
    switch (s->kind) {
    case DALCS_STIMULUS_SIN:
        return 1;
    case DALCS_STIMULUS_EXP:
        return 2;
    case DALCS_STIMULUS_TONES:
        return s->u.tones.n;
    case DALCS_STIMULUS_FORMULA:
        return dalcs_formula_stimulus_n_terms(s);
    case DALCS_STIMULUS_DC:
    case DALCS_STIMULUS_PULSE:
    case DALCS_STIMULUS_PWL:
    case DALCS_STIMULUS_DELAYED:
        return 0;
    }
    return 0;
}

/* Of a straight line from t to `last` at its end. */
static void set_slope(struct dalcs_stimulus_piece *piece, double t, double last) {
    const double rise = last - piece->level;
    piece->slope = rise == 0 ? 0 : rise / (piece->to - t);
}

void dalcs_stimulus_piece_at(const struct dalcs_stimulus *s, double t,
                             struct dalcs_stimulus_piece *piece) {
    const bool is_pulse = s->kind == DALCS_STIMULUS_PULSE; /* which says it with its values */
    double last;
    *piece = (struct dalcs_stimulus_piece){.to = is_pulse ? 0.0 : dalcs_stimulus_next_edge(s, t),
                                           .n_terms = dalcs_stimulus_n_terms(s),
                                           .term = piece->term};
    switch (s->kind) {
    case DALCS_STIMULUS_SIN:
        sine_piece(s, t, piece);
        return;
    case DALCS_STIMULUS_EXP:
        exponential_piece(s, t, piece);
        return;
    case DALCS_STIMULUS_TONES:
        tones_piece(s, t, piece);
        return;
    case DALCS_STIMULUS_FORMULA:
        dalcs_formula_stimulus_piece(s, t, piece);
        return;
    case DALCS_STIMULUS_DELAYED: /* a polynomial, of which this is where it begins */
        piece->level = dalcs_history_value(s->u.history, t, DALCS_RIGHT);
        return;
    case DALCS_STIMULUS_PULSE:
        piece->to = dalcs_pulse_line(s, t, &piece->level, &last);
        set_slope(piece, t, last);
        return;
    case DALCS_STIMULUS_DC:
    case DALCS_STIMULUS_PWL:
        piece->level = dalcs_stimulus_value(s, t, DALCS_RIGHT);
        if (isfinite(piece->to)) {
            set_slope(piece, t, dalcs_stimulus_value(s, piece->to, DALCS_LEFT));
        }
        return;
    }
}

void dalcs_stimulus_course_at(const struct dalcs_stimulus *s, double t,
                              struct dalcs_stimulus_piece *piece) {
    if (s->kind != DALCS_STIMULUS_FORMULA) {
        dalcs_stimulus_piece_at(s, t, piece);
        return;
    }
    piece->n_terms = dalcs_stimulus_n_terms(s);
    dalcs_formula_stimulus_piece(s, t, piece);
}

void dalcs_stimulus_terms_at(const struct dalcs_stimulus *s, double t,
                             struct dalcs_stimulus_term *term) {
    if (s->kind == DALCS_STIMULUS_SIN && s->u.sine.n_cycles == 0) {
        sine_term(s, t - s->u.sine.delay, term);
        return;
    }
    struct dalcs_stimulus_piece piece = {.term = term};
    dalcs_stimulus_piece_at(s, t, &piece);
}

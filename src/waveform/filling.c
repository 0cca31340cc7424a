/* filling.c - which times between the rows that are due get one, too. */
#include "filling.h"

#include "extremes.h"

#include <math.h>

/* Gaps on each side of what happens. */
enum { BESIDE = 2 };

/* Of the stop time: shorter gaps between rows are not examined. */
static const double least_gap = 0x1p-33;

/* What rounding makes of equal gaps. */
static const double rounding = 1e-9;

/* Where steps meet their polynomials may differ by what is allowed, which a cubic through rows on both sides makes as
 * much larger as its gaps differ: behind them a gap is at most so many times the one before. */
static const double growth = 4.0;

enum dalcs_status dalcs_filling_setup(struct dalcs_filling *f, const struct dalcs_recorder *r,
                                      struct dalcs_rows *rows, double bound, bool by_lines,
                                      const struct dalcs_filling_limit *limit) {
    const struct dalcs_schedule *s = &r->schedule;
    *f = (struct dalcs_filling){.is_on = s->kind == DALCS_ON_GRID && isfinite(bound),
                                .by_lines = by_lines,
                                .start = s->start,
                                .stop = s->stop,
                                .least = least_gap * s->stop,
                                .step = s->step,
                                .last = s->start,
                                .before = s->start,
                                .beside = BESIDE,
                                .n_left = limit->most,
                                .n_for_each = limit->for_each,
                                .ended = INFINITY};
    return f->is_on ? dalcs_row_gaps_setup(&f->gaps, rows, r->n_shown, bound) : DALCS_OK;
}

void dalcs_filling_finish(struct dalcs_filling *f) {
    dalcs_row_gaps_finish(&f->gaps);
    *f = (struct dalcs_filling){0};
}

bool dalcs_filling_is_on(const struct dalcs_filling *f, double t) {
    return f->is_on && f->n_left > 0 && t >= f->start;
}

enum dalcs_status dalcs_filling_enter(struct dalcs_filling *f, double from, double until,
                                      bool ends) {
    f->begin = dalcs_larger(from, f->start);
    f->until = until;
    f->is_closed = !dalcs_filling_is_on(f, f->begin) || until - f->begin <= f->least;
    if (f->is_closed) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_row_gaps_look(&f->gaps, f->begin, until));
    f->line = dalcs_larger(f->gaps.line, f->least);
    f->cubic = f->by_lines ? f->line : dalcs_larger(f->gaps.cubic, f->least);
    f->ends = ends && f->step > f->line;
    f->until_plain = f->step > f->cubic ? -INFINITY
                     : f->ends          ? until - (BESIDE + 1) * f->line
                                        : until;
    return DALCS_OK;
}

/* The first of the gaps up to the end that must be lines: not more of them than it takes, and none much shorter than
 * others. */
static double next_before_end(const struct dalcs_filling *f) {
    double rest = f->until - f->last;
    if (rest > (BESIDE + 1) * f->line) {
        return dalcs_larger(f->until - BESIDE * f->line, f->begin);
    }
    bool is_line = f->beside == BESIDE || f->last - f->before <= f->line;
    double n = dalcs_larger(ceil(rest / f->line - rounding), is_line ? 1.0 : BESIDE);
    return n > 1.0 ? dalcs_larger(f->last + rest / n, f->begin) : f->until;
}

/* Do steps meet in the gap before the last row, or behind that row? */
static bool has_just_begun(const struct dalcs_filling *f) {
    return f->beside < BESIDE && f->before < f->begin && f->before < f->last;
}

/* The time of the next row, where one is due later or the stretch ends. */
static double next(const struct dalcs_filling *f, double due) {
    double t = f->ends ? dalcs_smaller(due, next_before_end(f)) : due;
    if (f->beside > 0) {
        t = dalcs_smaller(t, dalcs_larger(f->last + f->line, f->begin));
    }
    if (has_just_begun(f)) {
        double most = dalcs_larger(growth * (f->last - f->before), f->least);
        t = dalcs_smaller(t, dalcs_larger(f->last + most, f->begin));
    }
    double n = ceil((t - f->last) / f->cubic - rounding);
    return n > 1.0 ? dalcs_larger(f->last + (t - f->last) / n, f->begin) : t;
}

static void pass(struct dalcs_filling *f, double t) {
    if (t > f->last) {
        f->beside -= f->beside > 0 ? 1 : 0;
        f->before = f->last;
        f->last = t;
    }
}

/* After so many rows that are there anyway. */
static void allow(struct dalcs_filling *f, size_t n) {
    f->n_left += f->n_left > 0 ? n * f->n_for_each : 0;
}

/* One that is added. */
static void count(struct dalcs_filling *f, double t) {
    f->n_left--;
    if (f->n_left == 0) {
        f->ended = t;
        f->is_closed = true;
    }
}

/* Passes on rows that are due and need no rows between. */
static int list_plain(struct dalcs_filling *f, const struct dalcs_recorder *r, int after,
                      double near, double *time, int most) {
    bool needs_a_look =
        f->beside > 0 || (has_just_begun(f) && f->step > growth * (f->last - f->before));
    if (!f->is_closed && needs_a_look) {
        return 0;
    }
    double until = f->is_closed ? f->until : f->until_plain;
    int n = dalcs_recorder_list_due(r, after, until, near, time, most);
    for (int k = n > BESIDE ? n - BESIDE : 0; k < n; k++) {
        pass(f, time[k]);
    }
    allow(f, (size_t)n);
    return n;
}

/* The next one with what has to come before it; false: the stretch ends. */
static bool list_next(struct dalcs_filling *f, const struct dalcs_recorder *r, int after,
                      double near, double *time, bool *is_due) {
    double due;
    bool comes = dalcs_recorder_list_due(r, after, f->until, near, &due, 1) > 0;
    double t = next(f, comes ? due : f->until);
    *is_due = comes && t + near >= due;
    *time = *is_due ? due : t;
    if (!(*time + near < f->until)) {
        return false;
    }
    if (*is_due) {
        allow(f, 1);
    } else {
        count(f, t);
    }
    pass(f, *time);
    return true;
}

int dalcs_filling_list(struct dalcs_filling *f, const struct dalcs_recorder *r, double near,
                       double *time, int most, int *n_due) {
    int n = 0;
    *n_due = 0;
    while (n < most) {
        int plain = list_plain(f, r, *n_due, near, time + n, most - n);
        *n_due += plain;
        n += plain;
        bool is_due = false;
        if (n == most || f->is_closed || !list_next(f, r, *n_due, near, &time[n], &is_due)) {
            break;
        }
        *n_due += is_due ? 1 : 0;
        n++;
    }
    return n;
}

void dalcs_filling_row(struct dalcs_filling *f, double t, bool happens) {
    dalcs_row_gaps_note(&f->gaps);
    pass(f, t);
    allow(f, 1);
    f->beside = happens ? BESIDE : f->beside;
}

/* history.c - polynomials of steps, kept for as long as a source puts them out. */
#include "history.h"

#include "memory.h"
#include "rounding.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void dalcs_history_start(struct dalcs_history *history, double before) {
    history->before = before;
    history->known = 0.0;
    history->largest = fabs(before);
    history->first = history->n = 0;
}

void dalcs_history_finish(struct dalcs_history *history) {
    free(history->piece);
    history->piece = NULL;
    history->first = history->n = history->capacity = 0;
}

/* By the barycentric formula of the second kind (Berrut and Trefethen, SIAM Review 46, 2004). */
static double value_in(const struct dalcs_history *history, const struct dalcs_history_piece *piece,
                       double theta) {
    double over = 0.0;
    double under = 0.0;
    for (int k = 0; k <= history->degree; k++) {
        const double distance = theta - history->node[k];
        if (distance == 0.0) {
            return piece->value[k];
        }
        const double part = history->weight[k] / distance;
        over += part * piece->value[k];
        under += part;
    }
    return over / under;
}

/* A time that is this near an edge is the edge (stimulus.h). */
static double nearness(const struct dalcs_history *history, double t) {
    return dalcs_rounded * fmax(fabs(t), history->delay);
}

/* The last piece that begins before `at`, or with or_at no later than that; `first` - 1: none does. */
static size_t find(const struct dalcs_history *history, double at) {
    size_t low = history->first;
    size_t high = history->n;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (history->piece[middle].t > at) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low - 1;
}

double dalcs_history_value(const struct dalcs_history *history, double t, enum dalcs_side side) {
    const double near = nearness(history, t);
    const double at = t - history->delay;
    const size_t k = find(history, side == DALCS_RIGHT ? at + near : at - near);
    if (k == history->first - 1) {
        return history->first == 0 ? history->before : history->piece[history->first].value[0];
    }
    const struct dalcs_history_piece *piece = &history->piece[k];
    const bool is_last = k + 1 == history->n;
    double theta = fmax(0.0, (at - piece->t) / piece->h);
    if (!is_last) {
        theta = fmin(theta, (piece->end - piece->t) / piece->h);
    }
    return value_in(history, piece, theta);
}

double dalcs_history_next_edge(const struct dalcs_history *history, double t) {
    const double near = nearness(history, t);
    for (size_t k = find(history, t - history->delay + near) + 1; k < history->n; k++) {
        if (history->piece[k].bends && history->piece[k].t + history->delay > t + near) {
            return history->piece[k].t + history->delay;
        }
    }
    const double end = history->known + history->delay;
    return end > t + near ? end : t + history->delay;
}

double dalcs_history_missed(const struct dalcs_history *history, double t, double h,
                            const double *value) {
    struct dalcs_history_piece step = {
        .t = t - history->delay, .h = h, .end = t - history->delay + h};
    const double near = nearness(history, t + h);
    double most = 0.0;
    memcpy(step.value, value, (size_t)(history->degree + 1) * sizeof(*value));
    const size_t before = find(history, step.t);
    for (size_t k = before == history->first - 1 ? history->first : before;
         k < history->n && history->piece[k].t < step.end - near; k++) {
        const struct dalcs_history_piece *piece = &history->piece[k];
        const double until = fmin(piece->end, step.end) - near;
        for (int i = 0; i <= history->degree; i++) {
            const double at = piece->t + piece->h * history->node[i];
            if (at > step.t + near && at < until) {
                const double missed = piece->value[i] - value_in(history, &step, (at - step.t) / h);
                most = fabs(missed) > fabs(most) ? missed : most;
            }
        }
    }
    return fabs(most) > history->tolerance * history->largest ? most : 0.0;
}

bool dalcs_history_jumps_at(const struct dalcs_history *history, double t) {
    const double near = nearness(history, t);
    const size_t k = find(history, t - history->delay + near);
    return k != history->first - 1 && history->piece[k].jumps &&
           fabs(history->piece[k].t + history->delay - t) <= near;
}

/* The steps before have no place in any time that is asked for: rows and checks look back over one step, which is no
 * longer than the delay. */
static void forget(struct dalcs_history *history) {
    const double oldest = history->known - 3.0 * history->delay;
    while (history->first + 1 < history->n && history->piece[history->first].end < oldest) {
        history->first++;
    }
    if (2 * history->first > history->capacity) {
        memmove(history->piece, history->piece + history->first,
                (history->n - history->first) * sizeof(*history->piece));
        history->n -= history->first;
        history->first = 0;
    }
}

/* How far from `theta` on it goes in a step's part `share` (steps), along a straight line. */
static double rise(const struct dalcs_history *history, const struct dalcs_history_piece *piece,
                   double theta, double share) {
    return value_in(history, piece, theta + share) - value_in(history, piece, theta);
}

/* Is what comes no continuation? A difference in the slope counts as what it makes in the shorter one of both steps; with
 * that of higher derivatives the error of steps deals. */
static void look_at_seam(const struct dalcs_history *history, struct dalcs_history_piece *piece) {
    enum { PARTS = 64 };

    const double allowed = history->tolerance * history->largest;
    double last = history->before;
    double slope = 0.0; /* V in the shorter step */
    double shorter = piece->h;
    if (history->n > history->first) {
        const struct dalcs_history_piece *before = &history->piece[history->n - 1];
        const double theta = (before->end - before->t) / before->h;
        shorter = fmin(before->h, piece->h);
        last = value_in(history, before, theta);
        slope = PARTS * rise(history, before, theta, shorter / before->h / PARTS);
    }
    const double next = PARTS * rise(history, piece, 0.0, shorter / piece->h / PARTS);
    piece->jumps = fabs(piece->value[0] - last) > allowed;
    piece->bends = piece->jumps || fabs(next - slope) > allowed;
}

enum dalcs_status dalcs_history_add(struct dalcs_history *history,
                                    const struct dalcs_history_piece *piece, bool is_smooth) {
    struct dalcs_history_piece next = *piece;
    for (int k = 0; k <= history->degree; k++) {
        history->largest = fmax(history->largest, fabs(next.value[k]));
    }
    next.bends = next.jumps = false;
    if (!is_smooth) {
        look_at_seam(history, &next);
    }
    DALCS_TRY(
        dalcs_grow(&history->piece, &history->capacity, history->n + 1, sizeof(*history->piece)));
    history->piece[history->n++] = next;
    history->known = next.end;
    forget(history);
    return DALCS_OK;
}

/* positions.c - where switches stand whose control reads the circuit, at one instant. */
#include "positions.h"

#include "sliding.h"

#include <stdlib.h>
#include <string.h>

/* Positions that are tried one switch at a time: all of eight switches. */
enum { MOST_TRIED = 256 };

bool dalcs_positions_moves_from(const struct dalcs_positions *p, int i, const uint64_t *memory,
                                const double *y) {
    const struct dalcs_system *s = p->osnsp->system;
    const struct dalcs_pair *pair = &s->pair[p->pair[i]];
    const bool remembers = dalcs_pair_remembers(pair);
    if (remembers && p->keeps) {
        return false;
    }
    double control = dalcs_csr_row_dot(&s->control, p->pair[i], y);
    bool is_on = dalcs_osnsp_is_on(p->osnsp, p->pair[i]);
    bool was_on = remembers ? dalcs_mode_has(memory, p->pair[i]) : is_on;
    return dalcs_switch_closes(s, p->osnsp->mode, p->pair[i], was_on, control, p->slack[i]) !=
           is_on;
}

bool dalcs_positions_moves(const struct dalcs_positions *p, int i, const double *y) {
    return dalcs_positions_moves_from(p, i, p->osnsp->mode, y);
}

static void flip(struct dalcs_positions *p, int i) {
    dalcs_osnsp_command(p->osnsp, p->pair[i], !dalcs_osnsp_is_on(p->osnsp, p->pair[i]));
}

bool dalcs_positions_move_all_once(struct dalcs_positions *p, const double *y) {
    bool any = false;
    for (int i = 0; i < p->n; i++) {
        if (dalcs_positions_moves(p, i, y)) {
            flip(p, i);
            any = true;
        }
    }
    p->moved = p->moved || any;
    return any;
}

static void keep(const struct dalcs_positions *p, uint64_t *mode) {
    memcpy(mode, p->osnsp->mode, (size_t)p->osnsp->n_words * sizeof(uint64_t));
}

static void go_back(const struct dalcs_positions *p, const uint64_t *mode) {
    memcpy(p->osnsp->mode, mode, (size_t)p->osnsp->n_words * sizeof(uint64_t));
}

/* Whatever the diodes do. */
static bool are_same(const struct dalcs_positions *p, const uint64_t *a, const uint64_t *b) {
    uint64_t different = 0;
    for (int k = 0; k < p->osnsp->n_words; k++) {
        different |= (a[k] ^ b[k]) & p->mask[k];
    }
    return different == 0;
}

/* Do positions a and b differ in one switch? Then there are no others between them. */
static bool differ_in_one(const struct dalcs_positions *p, const uint64_t *a, const uint64_t *b) {
    int n = 0;
    for (int k = 0; k < p->osnsp->n_words; k++) {
        n += __builtin_popcountll((a[k] ^ b[k]) & p->mask[k]);
    }
    return n == 1;
}

/* The present positions with their answer are the others from now on. */
static void keep_other(struct dalcs_positions *p, const double *y) {
    const struct dalcs_system *s = p->osnsp->system;
    memcpy(p->other, p->present, (size_t)p->osnsp->n_words * sizeof(uint64_t));
    memcpy(p->other_y, y, (size_t)dalcs_system_n_columns(s) * sizeof(double));
    memcpy(p->other_w, p->osnsp->w, (size_t)s->n_pairs * sizeof(double));
}

/* y is the answer where the switches stand. All that want to move do, again and again: a chain in which each moves the
 * next takes as many rounds as it has links. Brent's way finds what comes round: positions are compared with one of
 * them, which is a later one each time that their number has doubled. */
static enum dalcs_status move_all(struct dalcs_positions *p, double sigma, const double *u,
                                  double *y) {
    keep(p, p->mark);
    for (int round = 1; round <= 2 * (p->n + 1); round++) {
        keep(p, p->present);
        p->settled = !dalcs_positions_move_all_once(p, y);
        if (p->settled) {
            return DALCS_OK;
        }
        p->alternates = round > 1 && are_same(p, p->osnsp->mode, p->other);
        if (p->alternates || (round > 1 && are_same(p, p->osnsp->mode, p->mark))) {
            go_back(p, p->present);
            return DALCS_OK;
        }
        if ((round & (round - 1)) == 0) {
            keep(p, p->mark);
        }
        for (int k = 0; k < p->osnsp->n_words; k++) {
            p->turned[k] |= (p->osnsp->mode[k] ^ p->present[k]) & p->mask[k];
        }
        if (p->goes_on && round == 1 && are_same(p, p->osnsp->mode, p->other)) {
            go_back(p, p->other); /* diodes and formulas, too: the step before has ended there */
        }
        keep_other(p, y);
        DALCS_TRY(dalcs_osnsp_solve(p->osnsp, sigma, u, y));
    }
    return DALCS_OK;
}

/* Puts the present positions, but for the i-th switch, behind those to be tried. */
static void queue_flipped(struct dalcs_positions *p, int i) {
    struct dalcs_tried_positions *t = &p->tried;
    size_t n_words = (size_t)p->osnsp->n_words;
    uint64_t *next = t->mode + (size_t)t->n * n_words;
    flip(p, i);
    bool is_new = t->n < MOST_TRIED;
    for (int k = 0; k < t->n && is_new; k++) {
        is_new = !are_same(p, p->osnsp->mode, t->mode + (size_t)k * n_words);
    }
    if (is_new) {
        keep(p, next);
        t->n++;
    }
    flip(p, i);
}

/* Positions without an answer have no controls: any switch may be the one to move, but one that remembers. */
static void queue_next(struct dalcs_positions *p, bool fails, const double *y) {
    for (int i = 0; i < p->n; i++) {
        bool remembers = dalcs_pair_remembers(&p->osnsp->system->pair[p->pair[i]]);
        if (fails ? !remembers : dalcs_positions_moves(p, i, y)) {
            queue_flipped(p, i);
        }
    }
}

/* All around what has been tried: where some positions have no answer, moves alone may not come to those that agree. */
static void queue_neighbours(struct dalcs_positions *p) {
    int n = p->tried.n;
    for (int k = 0; k < n; k++) {
        go_back(p, p->tried.mode + (size_t)k * (size_t)p->osnsp->n_words);
        for (int i = 0; i < p->n; i++) {
            if (!(p->keeps && dalcs_pair_remembers(&p->osnsp->system->pair[p->pair[i]]))) {
                queue_flipped(p, i);
            }
        }
    }
}

static enum dalcs_status allocate_tried(struct dalcs_positions *p) {
    struct dalcs_tried_positions *t = &p->tried;
    if (t->mode == NULL) {
        t->mode = dalcs_alloc((size_t)MOST_TRIED * (size_t)p->osnsp->n_words, sizeof(uint64_t));
    }
    return t->mode != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* The answer in the k-th positions of those tried, of which the first are known to have none if first_fails. */
static enum dalcs_status try_positions(struct dalcs_positions *p, int k, bool first_fails,
                                       double sigma, const double *u, double *y) {
    go_back(p, p->tried.mode + (size_t)k * (size_t)p->osnsp->n_words);
    return k == 0 && first_fails ? DALCS_INFEASIBLE : dalcs_osnsp_solve(p->osnsp, sigma, u, y);
}

/* Breadth first: positions that agree with their answer, as few moves of one switch away as may be. *failing: the first
 * of those tried that have no answer, -1: all have one. */
static enum dalcs_status move_one(struct dalcs_positions *p, bool first_fails, double sigma,
                                  const double *u, double *y, int *failing) {
    struct dalcs_tried_positions *t = &p->tried;
    *failing = -1;
    t->n = 1;
    memcpy(t->mode, p->first, (size_t)p->osnsp->n_words * sizeof(uint64_t));
    for (int k = 0; k < t->n; k++) {
        enum dalcs_status status = try_positions(p, k, first_fails, sigma, u, y);
        if (status < DALCS_OK) {
            return status;
        }
        bool fails = status != DALCS_OK;
        *failing = *failing < 0 && fails ? k : *failing;
        keep(p, p->present);
        p->settled = !fails && !dalcs_positions_move_all_once(p, y);
        if (p->settled) {
            return DALCS_OK;
        }
        go_back(p, p->present);
        queue_next(p, fails, y);
        if (k + 1 == t->n && *failing >= 0) {
            queue_neighbours(p);
        }
    }
    return DALCS_OK;
}

/* One at a time, from where they stood first. Where that finds none, and all that want to move have come to positions
 * without an answer (is_stuck), that is how the problem ends. If not, it is the one on a side of those that they go to
 * and fro between, else where they stood first. */
static enum dalcs_status search(struct dalcs_positions *p, bool first_fails, bool is_stuck,
                                double sigma, const double *u, double *y) {
    int failing;
    DALCS_TRY(allocate_tried(p));
    keep(p, p->mark);
    DALCS_TRY(move_one(p, first_fails, sigma, u, y, &failing));
    if (p->settled) {
        p->moved = p->moved || !are_same(p, p->osnsp->mode, p->first);
        p->alternates = false;
        return DALCS_OK;
    }
    go_back(p, is_stuck && failing >= 0
                   ? p->tried.mode + (size_t)failing * (size_t)p->osnsp->n_words
               : p->alternates ? p->mark
                               : p->first);
    return dalcs_osnsp_solve(p->osnsp, sigma, u, y);
}

/* Where more than two positions recur, y is the answer in some of them: the others are those in which all that have turned
 * stand on their other side. What slides between both is for the mean to find (several_slides.c). A switch with hysteresis
 * has no place between its positions. */
static enum dalcs_status find_other(struct dalcs_positions *p, double sigma, const double *u,
                                    double *y) {
    for (int i = 0; i < p->n; i++) {
        if (dalcs_mode_has(p->turned, p->pair[i]) &&
            dalcs_pair_remembers(&p->osnsp->system->pair[p->pair[i]])) {
            return DALCS_OK;
        }
    }
    keep(p, p->mark);
    for (int i = 0; i < p->n; i++) {
        if (dalcs_mode_has(p->turned, p->pair[i])) {
            flip(p, i);
        }
    }
    enum dalcs_status status = dalcs_osnsp_solve(p->osnsp, sigma, u, p->other_y);
    if (status < DALCS_OK) {
        return status;
    }
    p->alternates = status == DALCS_OK;
    keep(p, p->other);
    memcpy(p->other_w, p->osnsp->w, (size_t)p->osnsp->system->n_pairs * sizeof(double));
    go_back(p, p->mark);
    return dalcs_osnsp_solve(p->osnsp, sigma, u, y);
}

enum dalcs_status dalcs_positions_solve(struct dalcs_positions *p, double sigma, const double *u,
                                        double *y) {
    p->moved = p->alternates = p->are_led = false;
    p->settled = true;
    p->has_first = false;
    if (p->n == 0) {
        return dalcs_osnsp_solve(p->osnsp, sigma, u, y);
    }
    keep(p, p->first);
    memset(p->turned, 0, (size_t)p->osnsp->n_words * sizeof(*p->turned));
    enum dalcs_status first = dalcs_osnsp_solve(p->osnsp, sigma, u, y);
    p->has_first = first == DALCS_OK;
    enum dalcs_status status = first == DALCS_OK ? move_all(p, sigma, u, y) : first;
    bool has_all = p->alternates &&
                   (differ_in_one(p, p->osnsp->mode, p->other) || dalcs_sliding_follows_one(p));
    if (status < DALCS_OK || (status == DALCS_OK && p->settled) || has_all) {
        return status;
    }
    const bool has_all_answers = status == DALCS_OK;
    DALCS_TRY(search(p, !p->has_first, !has_all_answers, sigma, u, y));
    return p->settled || p->alternates || !has_all_answers ? DALCS_OK : find_other(p, sigma, u, y);
}

enum dalcs_status dalcs_positions_solve_at_rest(struct dalcs_positions *p, const double *u,
                                                double *y) {
    enum dalcs_status status = dalcs_positions_solve(p, 0.0, u, y);
    if (status != DALCS_OK || p->settled || !p->has_first) {
        return status;
    }
    go_back(p, p->first); /* no operating point: what oscillates begins where it stood */
    return dalcs_osnsp_solve(p->osnsp, 0.0, u, y);
}

const char *dalcs_positions_restless(const struct dalcs_positions *p, const double *y) {
    for (int i = 0; i < p->n; i++) {
        if (dalcs_positions_moves(p, i, y)) {
            return p->osnsp->system->pair[p->pair[i]].element;
        }
    }
    return NULL;
}

/* latches.c - jumps of formulas that hold each other on their sides keep them, as latches do.
 *
 * `v={v(q) > 0.5 ? 1 : 0}` at q has three answers: both sides, and 0.5 V between them. Pivoting comes to any. What outputs that
 * follow with a small delay, or with a small capacitor, do not stay at is no answer of the circuit: it is between, and latch_loops.c
 * says so. Then these jumps stand where they stood, as switches are commanded, and the rest is solved for. What its own argument
 * contradicts there goes to its other side, all at once as after one delay, and where that comes round, one by one.
 *
 * A jump that has turned, or has come between its sides, may still have another answer: one in which a latch holds it, or one that
 * it turns on its way. So first all that stood on a side are commanded, and where that comes to rest it is the answer.
 *
 * Where every block of a system is monotone, none holds itself: no principal minor is below 0. */
#include "latches.h"

#include <math.h>
#include <string.h>

enum dalcs_status dalcs_latches_setup(struct dalcs_osnsp *p) {
    const struct dalcs_system *s = p->system;
    struct dalcs_osnsp_latches *l = &p->latches;
    const size_t n_pairs = (size_t)s->n_pairs;
    const size_t words = (size_t)p->n_words;
    for (int d = 0; d < s->n_pairs && !dalcs_osnsp_is_monotone(p); d++) {
        l->n += s->pair[d].is_jump ? 1 : 0;
    }
    if (l->n == 0) {
        return DALCS_OK;
    }
    l->jump = dalcs_arena_alloc(&p->arena, (size_t)l->n, sizeof(int));
    l->before = dalcs_arena_alloc(&p->arena, words, sizeof(uint64_t));
    l->mode = dalcs_arena_alloc(&p->arena, words, sizeof(uint64_t));
    l->rests = dalcs_arena_alloc(&p->arena, words, sizeof(uint64_t));
    l->last = dalcs_arena_alloc(&p->arena, words, sizeof(uint64_t));
    l->met = dalcs_arena_alloc(&p->arena, words, sizeof(uint64_t));
    l->kept_y = dalcs_arena_alloc(&p->arena, (size_t)dalcs_system_n_columns(s), sizeof(double));
    l->y = dalcs_arena_alloc(&p->arena, (size_t)dalcs_system_n_columns(s), sizeof(double));
    l->w = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(double));
    l->tied = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(bool));
    l->role = dalcs_arena_alloc(&p->arena, (size_t)l->n, sizeof(*l->role));
    if (l->jump == NULL || l->before == NULL || l->mode == NULL || l->rests == NULL ||
        l->last == NULL || l->met == NULL || l->kept_y == NULL || l->y == NULL || l->w == NULL ||
        l->tied == NULL || l->role == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int d = 0, k = 0; d < s->n_pairs; d++) {
        if (s->pair[d].is_jump) {
            l->jump[k++] = d;
        }
    }
    return DALCS_OK;
}

static size_t mode_bytes(const struct dalcs_osnsp *p) {
    return (size_t)p->n_words * sizeof(*p->mode);
}

static bool is_between(const uint64_t *mode, int d) {
    return dalcs_mode_has(mode, d) && !dalcs_mode_has(mode, d + 1);
}

/* Those between their sides that none holds: n of them, or one more than may be. */
static void list_between(const struct dalcs_osnsp *p, struct dalcs_latch_loops *of) {
    of->n = 0;
    for (int k = 0; k < p->latches.n && of->n <= DALCS_MOST_LATCHES; k++) {
        const int d = p->latches.jump[k];
        if (p->lists.is_diode[d] && is_between(p->mode, d)) {
            if (of->n < DALCS_MOST_LATCHES) {
                of->of[of->n] = d;
            }
            of->n++;
        }
    }
}

/* What an answer has beside y. */
struct kept_answer {
    struct dalcs_certificate certificate;
    struct dalcs_osnsp_signs signs;
    bool least_norm;
};

static void keep_answer(struct dalcs_osnsp *p, struct kept_answer *kept) {
    const size_t n_pairs = (size_t)p->system->n_pairs;
    *kept = (struct kept_answer){p->certificate, p->signs, p->least_norm};
    memcpy(p->latches.mode, p->mode, mode_bytes(p));
    memcpy(p->latches.w, p->w, n_pairs * sizeof(*p->w));
    memcpy(p->latches.tied, p->signs.tied, n_pairs * sizeof(*p->signs.tied));
}

static void put_answer_back(struct dalcs_osnsp *p, const struct kept_answer *kept) {
    const size_t n_pairs = (size_t)p->system->n_pairs;
    p->certificate = kept->certificate;
    p->signs = kept->signs;
    p->least_norm = kept->least_norm;
    memcpy(p->mode, p->latches.mode, mode_bytes(p));
    memcpy(p->w, p->latches.w, n_pairs * sizeof(*p->w));
    memcpy(p->signs.tied, p->latches.tied, n_pairs * sizeof(*p->signs.tied));
}

/* Into p->lists.is_diode: jumps that hold themselves are commanded, to where they stood. *any: there are new ones. */
static enum dalcs_status hold(struct dalcs_osnsp *p, double sigma, const double *u, bool *any) {
    struct dalcs_latch_loops of;
    uint32_t holding = 0;
    struct kept_answer kept;
    *any = false;
    list_between(p, &of);
    const bool is_mode_known =
        p->latches.is_known && memcmp(p->latches.rests, p->mode, mode_bytes(p)) == 0;
    if (of.n == 0 || of.n > DALCS_MOST_LATCHES || (is_mode_known && p->latches.sigma == sigma)) {
        return DALCS_OK;
    }
    keep_answer(p, &kept);
    enum dalcs_status status = dalcs_latch_loops_find(p, sigma, u, &of, &holding);
    if (status == DALCS_OK && holding == 0 &&
        !(is_mode_known && p->latches.sigma > 0.0)) { /* at rest there are no steps */
        status = dalcs_latch_led_find(p, sigma, u, &of);
    }
    put_answer_back(p, &kept);
    for (int k = 0; k < of.n && status == DALCS_OK; k++) {
        if ((holding >> k & 1) != 0) {
            p->lists.is_diode[of.of[k]] = p->lists.is_diode[of.of[k] + 1] = false;
            dalcs_latch_put(p, of.of[k], dalcs_mode_has(p->latches.before, of.of[k]));
            *any = true;
        }
    }
    if (status >= DALCS_OK && !*any) { /* the mode of a step is looked at once */
        p->latches.is_known = true;
        p->latches.sigma = sigma;
        memcpy(p->latches.rests, p->mode, mode_bytes(p));
    }
    return status < DALCS_OK ? status : DALCS_OK;
}

/* Those that are commanded and that the answer y contradicts go to their other side, or the first alone. Returns whether there
 * are any. */
static bool turn(struct dalcs_osnsp *p, const double *y, bool all) {
    bool any = false;
    for (int k = 0; k < p->latches.n && (all || !any); k++) {
        const int d = p->latches.jump[k];
        const double argument = dalcs_latch_argument(p, y, d);
        const bool is_above = dalcs_osnsp_is_on(p, d);
        const double against = is_above ? -argument : argument;
        if (!p->lists.is_diode[d] && against > dalcs_latch_noise(p)) {
            dalcs_latch_put(p, d, !is_above);
            any = true;
        }
    }
    return any;
}

/* *found: an answer in which none of those that hold themselves is between its sides. */
static enum dalcs_status settle(struct dalcs_osnsp *p, double sigma, const double *u, double *y,
                                bool *found) {
    *found = false;
    for (int round = 0; round < 4 * (p->latches.n + 1) && !*found; round++) {
        enum dalcs_status status = dalcs_osnsp_solve_given(p, sigma, u, y);
        if (status != DALCS_OK) {
            return status < DALCS_OK ? status : DALCS_OK;
        }
        bool any;
        DALCS_TRY(hold(p, sigma, u, &any));
        *found = !any && !turn(p, y, round <= 2 * p->latches.n);
    }
    return DALCS_OK;
}

static void let_go(struct dalcs_osnsp *p) {
    for (int k = 0; k < p->latches.n; k++) {
        const int d = p->latches.jump[k];
        p->lists.is_diode[d] = p->lists.is_diode[d + 1] = true;
    }
}

/* Does one stand otherwise than before? */
static bool has_turned(const struct dalcs_osnsp *p) {
    bool has = false;
    for (int k = 0; k < p->latches.n && !has; k++) {
        const int d = p->latches.jump[k];
        has = !is_between(p->latches.before, d) &&
              (dalcs_mode_has(p->latches.before, d) != dalcs_osnsp_is_on(p, d) ||
               is_between(p->mode, d));
    }
    return has;
}

/* Those that stand otherwise than in the answer kept: is each beyond rounding on its side? Where an argument is 0 what is written
 * for that decides, not where it stood. */
static bool are_on_sides(const struct dalcs_osnsp *p, const double *y) {
    bool are = true;
    for (int k = 0; k < p->latches.n && are; k++) {
        const int d = p->latches.jump[k];
        const bool is_as_kept = dalcs_mode_has(p->latches.mode, d) == dalcs_osnsp_is_on(p, d) &&
                                is_between(p->latches.mode, d) == is_between(p->mode, d);
        are = is_as_kept || fabs(dalcs_latch_argument(p, y, d)) > dalcs_latch_noise(p);
    }
    return are;
}

/* Do those that are commanded stand as in this mode? */
static bool stand_as_in(const struct dalcs_osnsp *p, const uint64_t *mode) {
    bool are = true;
    for (int k = 0; k < p->latches.n && are; k++) {
        const int d = p->latches.jump[k];
        are = p->lists.is_diode[d] ||
              (dalcs_mode_has(mode, d) == dalcs_osnsp_is_on(p, d) && !is_between(mode, d));
    }
    return are;
}

/* All that stood on a side go where the answers have them, as after one delay each time, until none does, until they stand as in
 * the answer kept, or until they come round (Brent). *found: they come to rest in another one. */
static enum dalcs_status go_by_delays(struct dalcs_osnsp *p, double sigma, const double *u,
                                      double *y, bool *found) {
    *found = false;
    memcpy(p->mode, p->latches.before, mode_bytes(p));
    for (int k = 0; k < p->latches.n; k++) {
        const int d = p->latches.jump[k];
        p->lists.is_diode[d] = p->lists.is_diode[d + 1] = is_between(p->mode, d);
    }
    memcpy(p->latches.met, p->mode, mode_bytes(p));
    for (int round = 1; round <= 2 * (p->latches.n + 1); round++) {
        enum dalcs_status status = dalcs_osnsp_solve_given(p, sigma, u, y);
        if (status != DALCS_OK) {
            return status < DALCS_OK ? status : DALCS_OK;
        }
        if (!turn(p, y, true)) {
            *found = are_on_sides(p, y);
            return DALCS_OK;
        }
        if (stand_as_in(p, p->latches.met) || stand_as_in(p, p->latches.mode)) {
            return DALCS_OK;
        }
        if (round > 1 && (round & (round - 1)) == 0) {
            memcpy(p->latches.met, p->mode, mode_bytes(p));
        }
    }
    return DALCS_OK;
}

/* A way to another answer, in which some are commanded. *found: there is one. */
typedef enum dalcs_status way(struct dalcs_osnsp *p, double sigma, const double *u, double *y,
                              bool *found);

/* Goes it. Behind it none is commanded. */
static enum dalcs_status go(struct dalcs_osnsp *p, way *how, double sigma, const double *u,
                            double *y, bool *found) {
    const int n_blocks = p->partition.n_blocks;
    p->partition.n_blocks = 1; /* blocks would not command them */
    const enum dalcs_status status = how(p, sigma, u, y, found);
    let_go(p);
    p->partition.n_blocks = n_blocks;
    return status;
}

/* y: an answer in which some have come between their sides. It stays where delays do not come to rest in another one. */
static enum dalcs_status try_delays(struct dalcs_osnsp *p, double sigma, const double *u, double *y,
                                    bool *found) {
    const size_t bytes = (size_t)dalcs_system_n_columns(p->system) * sizeof(*y);
    struct kept_answer kept;
    keep_answer(p, &kept);
    memcpy(p->latches.kept_y, y, bytes);
    const enum dalcs_status status = go(p, go_by_delays, sigma, u, y, found);
    if (status == DALCS_OK && !*found) {
        put_answer_back(p, &kept);
        memcpy(y, p->latches.kept_y, bytes);
    }
    return status;
}

/* Where a step finds that an argument has crossed, the jump is between its sides as the problem begins: it stood where the last
 * answer had it. */
static void find_before(struct dalcs_osnsp *p) {
    struct dalcs_osnsp_latches *l = &p->latches;
    memcpy(l->before, p->mode, mode_bytes(p));
    for (int k = 0; k < l->n; k++) {
        const int d = l->jump[k];
        if (is_between(p->mode, d) && !is_between(l->last, d)) {
            const uint64_t pair = (uint64_t)1 << (d % 64);
            const uint64_t next = (uint64_t)1 << ((d + 1) % 64);
            const bool is_above = dalcs_mode_has(l->last, d);
            l->before[d / 64] = is_above ? l->before[d / 64] | pair : l->before[d / 64] & ~pair;
            l->before[(d + 1) / 64] =
                is_above ? l->before[(d + 1) / 64] | next : l->before[(d + 1) / 64] & ~next;
        }
    }
}

/* y: an answer in which some that hold themselves are between their sides. It stays where no other one is found. */
static enum dalcs_status settle_from(struct dalcs_osnsp *p, double sigma, const double *u,
                                     double *y) {
    bool found;
    enum dalcs_status status = go(p, settle, sigma, u, y, &found);
    if (status == DALCS_OK && !found) {
        memcpy(p->mode, p->latches.before, mode_bytes(p));
        status = dalcs_osnsp_solve_given(p, sigma, u, y);
    }
    return status;
}

enum dalcs_status dalcs_latches_solve(struct dalcs_osnsp *p, double sigma, const double *u,
                                      double *y) {
    if (p->latches.n == 0) {
        return dalcs_osnsp_solve_given(p, sigma, u, y);
    }
    find_before(p);
    enum dalcs_status status = dalcs_osnsp_solve_given(p, sigma, u, y);
    bool any = false;
    bool found = false;
    if (status == DALCS_OK && has_turned(p)) {
        status = try_delays(p, sigma, u, y, &found);
    }
    if (status == DALCS_OK && !found) {
        status = hold(p, sigma, u, &any);
    }
    if (status == DALCS_OK && any) {
        status = settle_from(p, sigma, u, y);
    }
    if (status == DALCS_OK) {
        memcpy(p->latches.last, p->mode, mode_bytes(p));
    }
    return status;
}

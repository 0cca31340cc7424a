/* latch_led.c - comparators that read what another one puts out, while that is between its sides.
 *
 * A jump between its sides stands at its threshold by what its output adds to its own argument, at once or by way of a state. One
 * whose output adds nothing at once, and whose argument the output of another one moves at once, is at its threshold by that
 * output alone. With a small delay or hysteresis the other one goes from side to side, and takes this one with it, for the same
 * parts of the time: a mean of both sides (sliding.h), in which no argument but that of the other one is 0. So the one leads, and
 * this one is led. What adds to its own argument at once, as an amplifier with feedback does, goes with what it reads, and is
 * neither. */
#include "latches.h"

#include "power_of_step.h"

#include <string.h>

/* In a step, and in one half as long. */
struct additions {
    struct dalcs_latch_loops whole, half;
};

/* In the mode of the answer kept. */
static enum dalcs_status find_additions(struct dalcs_osnsp *p, double sigma, const double *u,
                                        struct dalcs_latch_loops *of) {
    memcpy(p->mode, p->latches.mode, (size_t)p->n_words * sizeof(*p->mode));
    return dalcs_latch_find_additions(p, sigma, u, of);
}

/* What goes by way of a state vanishes with the step. */
static bool adds_at_once(const struct additions *of, int i, int k) {
    return dalcs_power_of_step(of->whole.adds[i][k], of->half.adds[i][k]) <= 0.0;
}

/* Those that go with what they read stay between their sides. Returns whether there are any. */
static bool leave_out(struct additions *of) {
    int n = 0;
    for (int k = 0; k < of->whole.n; k++) {
        if (!adds_at_once(of, k, k)) {
            of->whole.of[n] = of->half.of[n] = of->whole.of[k];
            n++;
        }
    }
    const bool any = n < of->whole.n;
    of->whole.n = of->half.n = n;
    return any;
}

static enum dalcs_latch_role *role_of(struct dalcs_osnsp *p, int pair) {
    int k = 0;
    while (p->latches.jump[k] != pair) {
        k++;
    }
    return &p->latches.role[k];
}

/* Is it at its threshold by what outputs do to it by way of states, and not at once? */
static bool leads(const struct additions *of, int i) {
    bool is_moved = false;
    bool is_moved_at_once = false;
    for (int k = 0; k < of->whole.n; k++) {
        is_moved = is_moved || of->whole.adds[i][k] != 0.0;
        is_moved_at_once = is_moved_at_once || adds_at_once(of, i, k);
    }
    return is_moved && !is_moved_at_once;
}

/* Its output does nothing to its own argument, so it is at its threshold since another one is that reads the same: does it stand
 * below where that one stands above? */
static bool leads_against(const struct additions *of, int i) {
    bool is_against = false;
    for (int k = 0; k < of->whole.n && of->whole.adds[i][i] == 0.0; k++) {
        is_against = is_against || of->whole.adds[i][k] * of->whole.adds[k][k] < 0.0;
    }
    return is_against;
}

/* What one that leads moves at once is led, and so is what that moves. */
static void note_roles(struct dalcs_osnsp *p, const struct additions *of) {
    enum dalcs_latch_role role[DALCS_MOST_LATCHES] = {DALCS_LATCH_FREE};

    for (int i = 0; i < of->whole.n; i++) {
        role[i] = !leads(of, i)          ? DALCS_LATCH_FREE
                  : leads_against(of, i) ? DALCS_LATCH_LEADS_AGAINST
                                         : DALCS_LATCH_LEADS;
        p->latches.are_read =
            p->latches.are_read || (role[i] != DALCS_LATCH_FREE && of->whole.adds[i][i] == 0.0);
    }
    for (int round = 0; round < of->whole.n; round++) {
        for (int i = 0; i < of->whole.n; i++) {
            for (int k = 0; k < of->whole.n; k++) {
                role[i] = adds_at_once(of, i, k) && role[k] != DALCS_LATCH_FREE ? DALCS_LATCH_LED
                                                                                : role[i];
            }
        }
    }
    for (int i = 0; i < of->whole.n; i++) {
        *role_of(p, of->whole.of[i]) = role[i];
        p->latches.n_led += role[i] == DALCS_LATCH_LED ? 1 : 0;
        p->latches.n_leading += dalcs_latch_leads(role[i]) ? 1 : 0;
    }
}

/* Is there nothing in the circuit beside these jumps that could stand on sides? */
static bool are_alone(const struct dalcs_osnsp *p, const struct dalcs_latch_loops *of) {
    return of->n < 2 && p->system->n_pairs == 2 * of->n && p->smooth.newton == NULL;
}

enum dalcs_status dalcs_latch_led_find(struct dalcs_osnsp *p, double sigma, const double *u,
                                       const struct dalcs_latch_loops *of) {
    struct additions both = {.whole = *of, .half = *of};
    memset(p->latches.role, 0, (size_t)p->latches.n * sizeof(*p->latches.role));
    p->latches.n_led = p->latches.n_leading = 0;
    p->latches.are_read = p->latches.are_compared = false;
    if (are_alone(p, of) || !(sigma > 0.0)) {
        return DALCS_OK;
    }
    DALCS_TRY(find_additions(p, 2.0 * sigma, u, &both.half));
    if (leave_out(&both)) {
        DALCS_TRY(find_additions(p, 2.0 * sigma, u, &both.half));
        DALCS_TRY(find_additions(p, sigma, u, &both.whole));
    } else { /* the step's own problem is the last one */
        DALCS_TRY(dalcs_osnsp_answer_given(p, sigma, u, p->latches.y));
    }
    note_roles(p, &both);
    return DALCS_OK;
}

/* Is what is known of latches of this mode? */
static bool is_of_mode(const struct dalcs_osnsp *p) {
    const struct dalcs_osnsp_latches *l = &p->latches;
    return l->is_known && memcmp(l->rests, p->mode, (size_t)p->n_words * sizeof(*p->mode)) == 0;
}

bool dalcs_osnsp_has_leading(const struct dalcs_osnsp *p) {
    return p->latches.n_leading > 0 && is_of_mode(p);
}

bool dalcs_osnsp_has_led(const struct dalcs_osnsp *p) {
    return (p->latches.n_led > 0 || p->latches.are_read) && is_of_mode(p);
}

static void command(struct dalcs_osnsp *p, bool is_free) {
    for (int k = 0; k < p->latches.n; k++) {
        const int d = p->latches.jump[k];
        p->lists.is_diode[d] = p->lists.is_diode[d + 1] =
            is_free || p->latches.role[k] == DALCS_LATCH_FREE;
    }
}

/* Those that are led go to the side of their argument in y. Returns whether one has changed. */
static bool turn_led(struct dalcs_osnsp *p, const double *y) {
    bool any = false;
    for (int k = 0; k < p->latches.n; k++) {
        const int d = p->latches.jump[k];
        const bool is_above = dalcs_latch_argument(p, y, d) > 0.0;
        if (p->latches.role[k] == DALCS_LATCH_LED && is_above != dalcs_osnsp_is_on(p, d)) {
            dalcs_latch_put(p, d, is_above);
            any = true;
        }
    }
    return any;
}

/* One that is between its sides goes to one of them: the answer tells to which. */
static void put_led(struct dalcs_osnsp *p) {
    for (int k = 0; k < p->latches.n; k++) {
        const int d = p->latches.jump[k];
        if (p->latches.role[k] == DALCS_LATCH_LED) {
            dalcs_latch_put(p, d, dalcs_osnsp_is_on(p, d));
        }
    }
}

enum dalcs_status dalcs_osnsp_answer_led(struct dalcs_osnsp *p, double sigma, const double *u,
                                         double *y, bool *found) {
    const int n_blocks = p->partition.n_blocks;
    enum dalcs_status status = DALCS_OK;
    *found = false;
    p->partition.n_blocks = 1; /* blocks would not command them */
    command(p, false);
    put_led(p);
    for (int round = 0; round <= p->latches.n_led && status == DALCS_OK && !*found; round++) {
        status = p->smooth.newton == NULL
                     ? dalcs_osnsp_solve_given(p, sigma, u, y)
                     : dalcs_osnsp_solve_smooth(p, sigma, u, y, dalcs_osnsp_solve_given);
        *found = status == DALCS_OK && !turn_led(p, y);
    }
    command(p, true);
    p->partition.n_blocks = n_blocks;
    return status < DALCS_OK ? status : DALCS_OK;
}

/* steady_failure.c - why there is no steady state, in words. */
#include "steady.h"

#include "quantity.h"

#include <math.h>

/* That a message names. */
enum { MOST_STATES = 8 };

enum dalcs_status dalcs_steady_refuse(struct dalcs_run *r, const char *hint, const char *text) {
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL, hint, "%s", text);
    return DALCS_E_OPTION;
}

static const char *unit_of(const struct dalcs_steady *st, int state) {
    int k = 0;
    int gate;
    if (state >= st->layout.n_states) {
        return dalcs_logic_number_kind(&st->layout.memory, state - st->layout.n_states, &gate) <
                       DALCS_NUMBER_PULSE
                   ? "V"
                   : "s";
    }
    while (state >= st->layout.first[k + 1]) {
        k++;
    }
    return st->run->s->network.system[k].column_is_current[state - st->layout.first[k]] ? "A" : "V";
}

/* "v(c2) rises by 3.33 mV and v(c1) falls by 3.33 mV": the states that move most, of the last pass. */
static const char *moves_text(struct dalcs_steady *st) {
    struct dalcs_arena *arena = &st->run->s->arena;
    const char *text = "";
    double most = INFINITY;
    for (int told = 0; told < 2 && text != NULL; told++) {
        int state = -1;
        double next = 0.0;
        for (int x = 0; x < st->layout.n_x; x++) {
            double moves = fabs(st->step[x]) / (st->scale[x] > 0.0 ? st->scale[x] : 1.0);
            bool is_next = moves > next && (moves < most || (moves == most && told > 0));
            state = is_next ? x : state;
            next = is_next ? moves : next;
        }
        if (state < 0 || (told > 0 && next < 1e-3 * most)) {
            break;
        }
        char by[DALCS_QUANTITY_SIZE];
        text = dalcs_arena_printf(
            arena, "%s%s%s %s by %s", text, told > 0 ? " and " : "", dalcs_steady_name(st, state),
            st->step[state] > 0.0 ? "rises" : "falls",
            dalcs_quantity_write(by, fabs(st->step[state]), unit_of(st, state), 6));
        st->step[state] = 0.0;
        most = told == 0 ? next : most;
    }
    return text == NULL ? "" : text;
}

/* That what a run comes to is no orbit, or not soon. */
static const char *is_none_text(struct dalcs_steady *st, const struct dalcs_steady_attractor *a) {
    struct dalcs_arena *arena = &st->run->s->arena;
    switch (a->kind) {
    case DALCS_STEADY_CHAOS:
        return dalcs_arena_printf(arena,
                                  ": a run is chaotic, what two of them differ by grows by %.4g "
                                  "each period, on average",
                                  a->growth);
    case DALCS_STEADY_TORUS:
        return ": a run is quasi-periodic, it has an oscillation that has no common period with "
               "the sources";
    case DALCS_STEADY_SETTLING:
        return dalcs_arena_printf(arena,
                                  ": what two runs differ by fades by %.9g each period, so that "
                                  "there may be an orbit of many periods",
                                  a->growth);
    default:
        return "";
    }
}

enum dalcs_status dalcs_steady_tell_failure(struct dalcs_steady *st, bool endless,
                                            const struct dalcs_steady_attractor *a) {
    struct dalcs_session *s = st->run->s;
    for (int x = 0; x < st->layout.n_x; x++) {
        st->step[x] = st->then.x[x] - st->at.x[x];
    }
    if (endless) {
        for (int x = 0; x < st->layout.n_x; x++) {
            st->step[x] = st->kept.drift[x];
        }
        dalcs_diag_add(
            &s->diag, DALCS_ERROR, NULL,
            "a source charges a state that nothing discharges: give it a way out, or "
            "limit what commands it; a control that stays at its limit may have another "
            "state, which is found from IC= near it, with uic",
            "there is no periodic steady state from this start: without end, each period %s",
            moves_text(st));
        return DALCS_NOT_CONVERGED;
    }
    const char *none = is_none_text(st, a);
    const char *moves = moves_text(st);
    const char *gates = "the states come back, but not what gates and switches remember";
    const bool do_ = moves[0] != '\0';
    dalcs_diag_add(&s->diag, DALCS_ERROR, NULL,
                   "look at it with .tran; a switch that follows the circuit may have a clock of "
                   "its own",
                   "no periodic steady state was found in %ld periods%s; %s%s", st->n.periods,
                   none == NULL ? "" : none, do_ ? "in the last one " : "", do_ ? moves : gates);
    return DALCS_NOT_CONVERGED;
}

static const char *states_text(struct dalcs_steady *st) {
    struct dalcs_arena *arena = &st->run->s->arena;
    const char *text = "";
    for (int x = 0; x < st->layout.n_states && text != NULL; x++) {
        char value[DALCS_QUANTITY_SIZE];
        if (x == MOST_STATES) {
            return dalcs_arena_printf(arena, "%s, ...", text);
        }
        text = dalcs_arena_printf(arena, "%s%s%s = %s", text, x > 0 ? ", " : "",
                                  dalcs_steady_name(st, x),
                                  dalcs_quantity_write(value, st->at.x[x], unit_of(st, x), 9));
    }
    return text == NULL ? "" : text;
}

enum dalcs_status dalcs_steady_find_oscillation(struct dalcs_steady *st, double guess) {
    struct dalcs_session *s = st->run->s;
    bool found;
    bool rests;
    DALCS_TRY(dalcs_steady_oscillation(st, guess, &found, &rests));
    if (rests && st->layout.n_x == 0) {
        return dalcs_steady_refuse(st->run, ".op computes its operating point",
                                   "no source repeats, and nothing in the circuit has a memory");
    }
    if (rests) {
        dalcs_diag_add(
            &s->diag, DALCS_ERROR, NULL,
            st->run->options->bode
                ? "a run with .ac dec 20 1 1meg has the response around that state; if the circuit "
                  "is to oscillate, start it with IC= and uic"
                : ".op computes that state; if the circuit is to oscillate, start it with IC= and "
                  "uic",
            "there is no oscillation: no source repeats, and the circuit comes to rest, "
            "at %s",
            states_text(st));
        return DALCS_NOT_CONVERGED;
    }
    if (!found && st->own.is_free_of_events) {
        dalcs_diag_add(
            &s->diag, DALCS_ERROR, NULL,
            "a linear circuit oscillates at any amplitude, or drifts; look at it with "
            ".tran",
            "there is no oscillation of its own: no source repeats, and nothing switches "
            "again and again");
        return DALCS_NOT_CONVERGED;
    }
    if (!found) {
        dalcs_diag_add(&s->diag, DALCS_ERROR, NULL,
                       "look at it with .tran; a guess of the period, .pss 10u, may help",
                       "no source repeats, and no oscillation was found");
        return DALCS_NOT_CONVERGED;
    }
    return DALCS_OK;
}

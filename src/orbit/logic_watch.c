/* logic_watch.c - one record for each instant at which gates decide. */
#include "logic_watch.h"

#include "orbit_rates.h"

#include <stdlib.h>
#include <string.h>

static void note_due(void *user, long since) {
    struct dalcs_logic_watch *w = user;
    if (since == w->logic->instant || since == 0) {
        return; /* of this instant itself, or of what was there at the start */
    }
    if (dalcs_grow(&w->cause, &w->cause_capacity, w->n_causes + 1, sizeof *w->cause) != DALCS_OK) {
        w->out_of_memory = true;
        return;
    }
    w->cause[w->n_causes++] = since;
}

static void note_taken(void *user, int gate) {
    struct dalcs_logic_watch *w = user;
    w->takes[gate] = true;
}

static void note_pulse(void *user, int gate, long number) {
    struct dalcs_logic_watch *w = user;
    if (dalcs_grow(&w->pulse, &w->pulse_capacity, w->n_pulses + 1, sizeof *w->pulse) != DALCS_OK) {
        w->out_of_memory = true;
        return;
    }
    w->pulse[w->n_pulses++] = (struct dalcs_logic_pulse_begun){gate, number};
}

static void find_pins(struct dalcs_logic_watch *w, double t) {
    const struct dalcs_logic_memory *m = w->memory;
    for (int k = 0; k < m->n_pins; k++) {
        const struct dalcs_logic_pin *pin = &m->pin[k];
        const struct dalcs_stimulus *s = &m->circuit->stimulus[pin->stimulus];
        struct dalcs_pin_change *change = &w->pin[k];
        change->leap =
            dalcs_stimulus_value(s, t, DALCS_RIGHT) - dalcs_stimulus_value(s, t, DALCS_LEFT);
        change->takes = pin->holds && w->takes[pin->gate];
        change->jumps = !pin->holds && change->leap != 0.0;
        change->left = dalcs_slope_before(s, t, NULL);
        change->right = dalcs_slope_behind(s, t, NULL);
    }
}

static enum dalcs_status decided(void *user, double t, long number) {
    struct dalcs_logic_watch *w = user;
    if (w->out_of_memory) {
        return DALCS_E_NOMEM;
    }
    find_pins(w, t);
    const struct dalcs_logic_instant instant = {.t = t,
                                                .number = number,
                                                .n_causes = w->n_causes,
                                                .cause = w->cause,
                                                .pin = w->pin,
                                                .n_pulses = w->n_pulses,
                                                .pulse = w->pulse};
    const enum dalcs_status status = w->seen(w->user, &instant);
    w->n_causes = w->n_pulses = 0;
    memset(w->takes, 0, (size_t)w->memory->circuit->control.n_gates * sizeof *w->takes);
    return status;
}

enum dalcs_status dalcs_logic_watch_start(
    struct dalcs_logic_watch *w, struct dalcs_logic_run *logic,
    const struct dalcs_logic_memory *memory, void *user,
    enum dalcs_status (*seen)(void *user, const struct dalcs_logic_instant *instant)) {
    *w = (struct dalcs_logic_watch){.memory = memory, .logic = logic, .user = user, .seen = seen};
    w->pin = dalcs_alloc((size_t)memory->n_pins + 1, sizeof *w->pin);
    w->takes = dalcs_alloc((size_t)memory->circuit->control.n_gates + 1, sizeof *w->takes);
    if (w->pin == NULL || w->takes == NULL) {
        dalcs_logic_watch_finish(w);
        return DALCS_E_NOMEM;
    }
    w->observer = (struct dalcs_logic_observer){
        .user = w, .due = note_due, .took = note_taken, .pulse = note_pulse, .decided = decided};
    logic->observer = &w->observer;
    return DALCS_OK;
}

void dalcs_logic_watch_finish(struct dalcs_logic_watch *w) {
    free(w->cause);
    free(w->pin);
    free(w->takes);
    free(w->pulse);
    *w = (struct dalcs_logic_watch){0};
}

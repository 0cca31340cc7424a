/* check.c - the session's circuit under the theorems, part by part; equal parts once. */
#include "session_internal.h"

#include "commands.h"
#include "part.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Equal parts ----------------------------------------------------------------------------- */

static bool same_rows(const struct dalcs_csr *a, const struct dalcs_csr *b) {
    if (a->n_rows != b->n_rows || a->n_columns != b->n_columns) {
        return false;
    }
    size_t rows = (size_t)a->n_rows + 1;
    if (a->n_rows > 0 && memcmp(a->p, b->p, rows * sizeof(*a->p)) != 0) {
        return false;
    }
    size_t n = a->n_rows > 0 ? (size_t)a->p[a->n_rows] : 0;
    return n == 0 || (memcmp(a->j, b->j, n * sizeof(*a->j)) == 0 &&
                      memcmp(a->x, b->x, n * sizeof(*a->x)) == 0);
}

/* The same equations, whatever their names; sources may be other functions of time. */
static bool are_equal(const struct dalcs_system *a, const struct dalcs_system *b) {
    bool equal = a->n_x == b->n_x && a->n_z == b->n_z && a->n_pairs == b->n_pairs &&
                 a->n_inputs == b->n_inputs && a->monotone == b->monotone &&
                 same_rows(&a->P, &b->P) && same_rows(&a->A, &b->A) && same_rows(&a->E, &b->E) &&
                 same_rows(&a->C, &b->C) && same_rows(&a->F, &b->F) &&
                 same_rows(&a->storage, &b->storage);
    for (int i = 0; equal && i < a->n_pairs; i++) {
        equal = a->pair[i].kind == b->pair[i].kind &&
                a->pair[i].initially_on == b->pair[i].initially_on &&
                a->pair[i].is_direct == b->pair[i].is_direct;
    }
    return equal;
}

/* ---- Sources that jump ----------------------------------------------------------------------- */

enum { MOST_EDGES = 1000 };

/* Does it jump after the start of the run? Before `stop` and among its first edges: then all kinds
 * have shown what they do. */
static bool ever_jumps(const struct dalcs_stimulus *s, double stop) {
    double t = 0.0;
    for (int k = 0; k < MOST_EDGES; k++) {
        t = dalcs_stimulus_next_edge(s, t);
        if (!(t <= stop)) {
            return false;
        }
        if (dalcs_stimulus_jumps_at(s, t)) {
            return true;
        }
    }
    return false;
}

static enum dalcs_status find_jumps(const struct dalcs_session *s,
                                    const struct dalcs_system *system, const bool *jumps_of,
                                    bool **jumps) {
    *jumps = dalcs_alloc((size_t)system->n_inputs + 1, sizeof(**jumps));
    if (*jumps == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int j = 0; j < system->n_inputs; j++) {
        int stimulus = system->stimulus[j];
        (*jumps)[j] = stimulus >= 0 && stimulus < s->circuit.n_stimuli && jumps_of[stimulus];
    }
    return DALCS_OK;
}

/* ---- The check ------------------------------------------------------------------------------- */

static double choose_step(const struct dalcs_session *s, double given) {
    const struct dalcs_transient *t = &s->circuit.analyses.transient;
    return given > 0.0                     ? given
           : s->circuit.options.step > 0.0 ? s->circuit.options.step
           : t->max_step > 0.0             ? t->max_step
           : t->step > 0.0                 ? t->step
                                           : 1e-6;
}

/* *system becomes `from` with the switches that sources command where these have them at the start. That it is passive is
 * no proof where a file of matrices says so. */
static enum dalcs_status find_start(struct dalcs_session *s, const struct dalcs_system *from,
                                    struct dalcs_system *system) {
    size_t n_pairs = (size_t)from->n_pairs;
    struct dalcs_commands commands;
    *system = *from;
    system->monotone = from->monotone && s->circuit.n_devices > 0;
    system->pair = dalcs_arena_alloc(&s->checked, n_pairs, sizeof(*system->pair));
    if (system->pair == NULL) {
        return DALCS_E_NOMEM;
    }
    if (n_pairs > 0) {
        memcpy(system->pair, from->pair, n_pairs * sizeof(*system->pair));
    }
    DALCS_TRY(dalcs_commands_setup(&commands, &s->circuit, from));
    dalcs_commands_start(&commands);
    for (int k = 0; k < commands.n; k++) {
        system->pair[commands.command[k].pair].initially_on = commands.command[k].is_on;
    }
    dalcs_commands_finish(&commands);
    return DALCS_OK;
}

static enum dalcs_status check_parts(struct dalcs_session *s, struct dalcs_check *check,
                                     struct dalcs_checked_part *part, struct dalcs_system *of,
                                     const bool *jumps_of) {
    const struct dalcs_network *n = &s->network;
    for (int k = 0; k < n->n_systems; k++) {
        struct dalcs_system *system = &of[check->n_parts];
        size_t like = 0;
        DALCS_TRY(find_start(s, &n->system[k], system));
        while (like < check->n_parts && !are_equal(system, &of[like])) {
            like++;
        }
        if (like < check->n_parts) {
            part[like].n_equal++;
            continue;
        }
        bool *jumps;
        DALCS_TRY(find_jumps(s, system, jumps_of, &jumps));
        /* a file of matrices has no devices that could give power */
        const struct dalcs_power *power = n->power != NULL ? &n->power[k] : NULL;
        enum dalcs_status status =
            dalcs_part_check(&part[like], &s->checked, system, power, jumps, check->step);
        free(jumps);
        DALCS_TRY(status);
        check->n_parts++;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_session_check(struct dalcs_session *s, double step,
                                      const struct dalcs_check **result) {
    *result = NULL;
    DALCS_TRY(dalcs_session_apply_values(s));
    if (!(step >= 0.0) || !isfinite(step)) {
        dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, NULL, "the step must be positive");
        return DALCS_E_OPTION;
    }
    dalcs_arena_finish(&s->checked);
    size_t n = (size_t)s->network.n_systems + 1;
    struct dalcs_check *check = dalcs_arena_alloc(&s->checked, 1, sizeof(*check));
    struct dalcs_checked_part *part = dalcs_arena_alloc(&s->checked, n, sizeof(*part));
    struct dalcs_system *of = dalcs_arena_alloc(&s->checked, n, sizeof(*of));
    bool *jumps_of =
        dalcs_arena_alloc(&s->checked, (size_t)s->circuit.n_stimuli + 1, sizeof(*jumps_of));
    if (check == NULL || part == NULL || of == NULL || jumps_of == NULL) {
        return DALCS_E_NOMEM;
    }
    const struct dalcs_transient *t = &s->circuit.analyses.transient;
    for (int i = 0; i < s->circuit.n_stimuli; i++) {
        jumps_of[i] = ever_jumps(&s->circuit.stimulus[i], t->present ? t->stop : INFINITY);
    }
    *check = (struct dalcs_check){
        .netlist = s->name, .title = s->circuit.title, .step = choose_step(s, step), .part = part};
    DALCS_TRY(check_parts(s, check, part, of, jumps_of));
    *result = check;
    return DALCS_OK;
}

/* stroboscope.c - where a run is at the multiples of its period, once it has settled.
 *
 * The run with one value of .step goes on from where that with the value before has come to, so it stays on its
 * attractor as long as that exists. The orbit of one period is followed by Newton's method through the values where it
 * is unstable and no run goes to it. */
#include "stroboscope.h"
#include "steady_step.h"

#include <math.h>
#include <string.h>

struct rows {
    struct dalcs_steady *st;
    size_t n;          /* signals */
    const char **name; /* [n] */
    enum dalcs_unit *unit;
    double *value; /* [n] */
};

static enum dalcs_status make_rows(struct rows *rows, struct dalcs_steady *st) {
    struct dalcs_session *s = st->run->s;
    const int n_x = st->layout.n_x;
    *rows = (struct rows){.st = st, .n = 2 * (size_t)n_x + 1};
    rows->name = dalcs_arena_alloc(&s->arena, rows->n, sizeof *rows->name);
    rows->unit = dalcs_arena_alloc(&s->arena, rows->n, sizeof *rows->unit);
    rows->value = dalcs_arena_alloc(&s->arena, rows->n, sizeof(double));
    if (rows->name == NULL || rows->unit == NULL || rows->value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < st->layout.n_systems; k++) {
        for (int x = st->layout.first[k]; x < st->layout.first[k + 1]; x++) {
            const struct dalcs_system *system = &s->network.system[k];
            const int column = x - st->layout.first[k];
            const bool is_current = column < system->n_x && system->column_is_current[column];
            const char *name = dalcs_steady_name(st, x);
            rows->name[x] = name != NULL ? dalcs_arena_copy(&s->arena, name, strlen(name)) : NULL;
            rows->name[n_x + x] =
                name != NULL ? dalcs_arena_printf(&s->arena, "orbit(%s)", name) : NULL;
            rows->unit[x] = rows->unit[n_x + x] = is_current ? DALCS_AMPERE : DALCS_VOLT;
            if (rows->name[x] == NULL || rows->name[n_x + x] == NULL) {
                return DALCS_E_NOMEM;
            }
        }
    }
    rows->name[2 * n_x] = "multiplier";
    rows->unit[2 * n_x] = DALCS_UNIT_NONE;
    return DALCS_OK;
}

/* Points of the size that this circuit has. */
static enum dalcs_status make_room(struct dalcs_stroboscope *b, const struct dalcs_steady *st) {
    if (b->run.x != NULL && b->n_x == st->layout.n_x && b->n_pairs == st->layout.n_pairs) {
        return DALCS_OK;
    }
    struct dalcs_orbit_point *const point[2] = {&b->run, &b->orbit};
    b->n_x = st->layout.n_x;
    b->n_pairs = st->layout.n_pairs;
    b->has_run = b->has_orbit = false;
    for (int k = 0; k < 2; k++) {
        point[k]->x = dalcs_arena_alloc(&b->arena, (size_t)b->n_x + 1, sizeof(double));
        point[k]->closed = dalcs_arena_alloc(&b->arena, (size_t)b->n_pairs + 1, sizeof(bool));
        if (point[k]->x == NULL || point[k]->closed == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    return DALCS_OK;
}

/* From the orbit of the value before, else from where the run is: into the values of the rows. */
static enum dalcs_status find_orbit(struct dalcs_stroboscope *b, struct rows *rows) {
    struct dalcs_steady *st = rows->st;
    const int n_x = st->layout.n_x;
    bool found = false;
    if (b->has_orbit) {
        dalcs_steady_copy_point(st, &st->at, &b->orbit);
        DALCS_TRY(dalcs_steady_burst(st, &found));
    }
    if (!found) {
        dalcs_steady_copy_point(st, &st->at, &b->run);
        DALCS_TRY(dalcs_steady_burst(st, &found));
    }
    for (int x = 0; x < n_x; x++) {
        rows->value[n_x + x] = found ? st->at.x[x] : (double)NAN;
    }
    rows->value[2 * n_x] = found ? dalcs_steady_largest_multiplier(st) : (double)NAN;
    b->has_orbit = found || b->has_orbit;
    if (found) {
        dalcs_steady_copy_point(st, &b->orbit, &st->at);
    }
    return DALCS_OK;
}

static enum dalcs_status write_rows(struct rows *rows) {
    struct dalcs_steady *st = rows->st;
    struct dalcs_run *r = st->run;
    DALCS_TRY(dalcs_run_announce(r, &(struct dalcs_plot){.analysis = DALCS_PERIODIC,
                                                         .scale = "period",
                                                         .scale_unit = DALCS_UNIT_NONE,
                                                         .n_signals = rows->n,
                                                         .name = rows->name,
                                                         .unit = rows->unit}));
    for (int k = 0; k < r->options->samples; k++) {
        memcpy(rows->value, st->at.x, (size_t)st->layout.n_x * sizeof(double));
        DALCS_TRY(r->sink->row(r->sink->user, k, rows->value));
        DALCS_TRY(dalcs_steady_pass(st, 1, DALCS_STEADY_PLAIN));
        dalcs_steady_take(st);
    }
    return r->sink->end(r->sink->user);
}

static enum dalcs_status look(struct dalcs_steady *st) {
    struct dalcs_stroboscope *b = st->run->s->steady.stroboscope;
    const long settle = st->run->options->settle > 0 ? st->run->options->settle : 1;
    struct rows rows;
    DALCS_TRY(make_rows(&rows, st));
    DALCS_TRY(make_room(b, st));
    if (b->has_run) {
        dalcs_steady_copy_point(st, &st->at, &b->run);
        st->has_point = true;
    }
    DALCS_TRY(dalcs_steady_pass(st, settle, DALCS_STEADY_PLAIN));
    dalcs_steady_take(st);
    dalcs_steady_copy_point(st, &b->run, &st->at);
    b->has_run = true;
    DALCS_TRY(find_orbit(b, &rows));
    dalcs_steady_copy_point(st, &st->at, &b->run);
    DALCS_TRY(write_rows(&rows));
    dalcs_steady_copy_point(st, &b->run, &st->at);
    return DALCS_OK;
}

enum dalcs_status dalcs_stroboscope_run(struct dalcs_run *r) {
    return dalcs_steady_look(r, look);
}

void dalcs_stroboscope_finish(struct dalcs_stroboscope *b) {
    dalcs_arena_finish(&b->arena);
    *b = (struct dalcs_stroboscope){0};
}

/* refusal_loop.c - a loop that is driven, as a sentence: what drives, which way, against what. */
#include "refusal_words.h"

#include <math.h>

struct loop_words {
    struct dalcs_refusal_list drivers, opposers, forward, broken, path, closed, coils;
    double net, size; /* V, of what is shown */
};

static double shown_gain(const struct dalcs_refusal *r, const struct dalcs_loop_arc *a) {
    const struct dalcs_device *d = a->device < 0 ? NULL : &r->circuit->device[a->device];
    if (d == NULL || d->kind != DALCS_VSOURCE) {
        return a->gain;
    }
    return a->to == d->node[0] ? r->shown[d->stimulus] : -r->shown[d->stimulus];
}

static const char *held_text(const struct dalcs_refusal *r, int k, bool with_value) {
    const struct dalcs_initial_condition *ic = &r->circuit->initial_condition[k];
    const char *const *node = r->circuit->node_name;
    struct dalcs_arena *arena = &r->s->arena;
    const char *name = ic->node[1] == 0 ? dalcs_arena_printf(arena, ".ic v(%s)", node[ic->node[0]])
                                        : dalcs_arena_printf(arena, ".ic v(%s,%s)",
                                                             node[ic->node[0]], node[ic->node[1]]);
    return name != NULL && with_value
               ? dalcs_arena_printf(arena, "%s (%s)", name,
                                    dalcs_refusal_quantity(r->s, ic->value, "V"))
               : name;
}

static void add_diode(const struct dalcs_refusal *r, struct loop_words *w,
                      const struct dalcs_loop_arc *a) {
    const struct dalcs_device *d = &r->circuit->device[a->device];
    bool is_forward = a->from == d->node[0];
    dalcs_refusal_put(is_forward ? &w->forward : &w->broken, d->name);
    if (a->gain != 0.0) {
        dalcs_refusal_put(&w->opposers,
                          dalcs_arena_printf(&r->s->arena, "%s of %s (%s)",
                                             is_forward ? "vfwd" : "vrev", d->name,
                                             dalcs_refusal_quantity(r->s, -a->gain, "V")));
    }
}

static void add_part(const struct dalcs_refusal *r, struct loop_words *w,
                     const struct dalcs_loop_arc *a, bool is_turning) {
    const struct dalcs_device *d = a->device < 0 ? NULL : &r->circuit->device[a->device];
    dalcs_refusal_put(&w->path, d != NULL ? d->name : held_text(r, ~a->device, false));
    if (d == NULL) {
        dalcs_refusal_put(a->gain > 0.0 ? &w->drivers : &w->opposers,
                          held_text(r, ~a->device, true));
    } else if (d->kind == DALCS_VSOURCE && a->gain != 0.0) {
        dalcs_refusal_put(a->gain > 0.0 ? &w->drivers : &w->opposers,
                          dalcs_refusal_source(r, a->device, is_turning));
    } else if (d->kind == DALCS_DIODE) {
        add_diode(r, w, a);
    } else if (d->kind == DALCS_SWITCH) {
        dalcs_refusal_put(&w->closed, d->name);
    } else if (d->kind == DALCS_INDUCTOR) {
        dalcs_refusal_put(&w->coils, d->name);
    }
}

static const char *loop_sentence(struct dalcs_session *s, const struct loop_words *w,
                                 bool is_turning) {
    struct dalcs_refusal_list effect = {.s = s};
    if (w->forward.n > 0) {
        dalcs_refusal_put(&effect, dalcs_arena_printf(&s->arena, "%s forward",
                                                      dalcs_refusal_joined(&w->forward, false)));
    }
    if (w->broken.n > 0) {
        dalcs_refusal_put(&effect, dalcs_arena_printf(&s->arena, "%s into breakdown",
                                                      dalcs_refusal_joined(&w->broken, false)));
    }
    if (effect.n == 0) {
        dalcs_refusal_put(&effect, "current");
    }
    const char *against = w->opposers.n > 0
                              ? dalcs_arena_printf(&s->arena, " against %s",
                                                   dalcs_refusal_joined(&w->opposers, false))
                              : "";
    const char *net =
        w->drivers.n + w->opposers.n > 1 && !is_turning
            ? dalcs_arena_printf(&s->arena, " (net %s)", dalcs_refusal_quantity(s, w->net, "V"))
            : "";
    const char *closed = w->closed.n > 0
                             ? dalcs_arena_printf(&s->arena, "; %s %s closed",
                                                  dalcs_refusal_joined(&w->closed, false),
                                                  dalcs_refusal_plural(&w->closed, "is", "are"))
                             : "";
    const char *coils =
        w->coils.n > 0
            ? dalcs_arena_printf(&s->arena, "; at the operating point %s %s",
                                 dalcs_refusal_joined(&w->coils, false),
                                 dalcs_refusal_plural(&w->coils, "is a short", "are shorts"))
            : "";
    return dalcs_arena_printf(
        &s->arena, "%s %s %s%s around the loop %s%s with nothing to limit the current%s%s",
        dalcs_refusal_joined(&w->drivers, false),
        dalcs_refusal_plural(&w->drivers, "drives", "drive"), dalcs_refusal_joined(&effect, false),
        against == NULL ? "" : against, dalcs_refusal_joined(&w->path, true),
        net == NULL ? "" : net, closed == NULL ? "" : closed, coils == NULL ? "" : coils);
}

const char *dalcs_refusal_of_loop(const struct dalcs_refusal *r, const struct dalcs_loop_arc *arc,
                                  int n_arcs) {
    struct dalcs_session *s = r->s;
    struct loop_words w = {.drivers = {.s = s},
                           .opposers = {.s = s},
                           .forward = {.s = s},
                           .broken = {.s = s},
                           .path = {.s = s},
                           .closed = {.s = s},
                           .coils = {.s = s}};
    for (int k = 0; k < n_arcs; k++) {
        w.net += shown_gain(r, &arc[k]);
        w.size += fabs(shown_gain(r, &arc[k]));
    }
    bool is_turning = r->is_from && !(w.net > DALCS_TURNING_PART * w.size);
    for (int k = 0; k < n_arcs; k++) {
        add_part(r, &w, &arc[k], is_turning);
    }
    return loop_sentence(s, &w, is_turning);
}

const char *dalcs_refusal_of_coupled(const struct dalcs_refusal *r) {
    struct dalcs_session *s = r->s;
    const struct dalcs_circuit *c = r->circuit;
    struct dalcs_refusal_list driver = {.s = s};
    struct dalcs_refusal_list path = {.s = s};
    struct dalcs_refusal_list coils = {.s = s};
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (r->is_named[i]) {
            dalcs_refusal_put(&path, d->name);
        }
        if (r->is_named[i] && d->kind == DALCS_VSOURCE && r->value[d->stimulus] != 0.0) {
            dalcs_refusal_put(
                &driver, dalcs_refusal_source(r, i, r->is_from && r->shown[d->stimulus] == 0.0));
        }
    }
    for (int k = 0; k < c->n_couplings; k++) {
        const int *coil = c->coupling[k].inductor;
        if (fabs(c->coupling[k].k) == 1.0 && r->is_named[coil[0]] && r->is_named[coil[1]]) {
            dalcs_refusal_put(&coils, c->coupling[k].name);
        }
    }
    const char *coupled = coils.n > 0 ? dalcs_arena_printf(&s->arena,
                                                           "; the coils of %s are an ideal "
                                                           "transformer",
                                                           dalcs_refusal_joined(&coils, false))
                                      : "";
    return dalcs_arena_printf(&s->arena, "%s %s current through %s with nothing to limit it%s",
                              driver.n > 0 ? dalcs_refusal_joined(&driver, false) : "the sources",
                              driver.n == 1 ? "drives" : "drive", dalcs_refusal_joined(&path, true),
                              coupled == NULL ? "" : coupled);
}
